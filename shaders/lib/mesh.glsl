// SPDX-License-Identifier: Apache-2.0
// Vertex inputs of every mesh pass: a VertexRecord and the InstanceRecord that places it.
layout(location = kAttributePosition) in vec3 aPosition;
layout(location = kAttributePatch) in uint aPatch;
layout(location = kAttributeNormal) in uint aNormal;
layout(location = kAttributeRow0) in vec4 aRow0;
layout(location = kAttributeRow1) in vec4 aRow1;
layout(location = kAttributeRow2) in vec4 aRow2;
layout(location = kAttributeInstancePatch) in uint aInstancePatch;

vec3 worldPosition()
{
    const vec4 p = vec4(aPosition, 1.0);
    return vec3(dot(aRow0, p), dot(aRow1, p), dot(aRow2, p));
}

// A2B10G10R10_SNORM: x in the low ten bits.
vec3 localNormal()
{
    const ivec3 parts = ivec3(bitfieldExtract(int(aNormal), 0, 10), bitfieldExtract(int(aNormal), 10, 10),
                              bitfieldExtract(int(aNormal), 20, 10));
    return max(vec3(parts) / 511.0, vec3(-1.0));
}

// Normals go by the cofactors of the transform, so that mirrored and stretched instances keep theirs. Not unit.
vec3 worldNormal()
{
    const vec3 n = localNormal();
    const vec3 x = vec3(aRow0.x, aRow1.x, aRow2.x), y = vec3(aRow0.y, aRow1.y, aRow2.y), z = vec3(aRow0.z, aRow1.z, aRow2.z);
    const vec3 yz = cross(y, z);
    const vec3 scaled = n.x * yz + n.y * cross(z, x) + n.z * cross(x, y);
    return dot(x, yz) < 0.0 ? -scaled : scaled;
}

uint patchOfVertex() { return aPatch + aInstancePatch; }
