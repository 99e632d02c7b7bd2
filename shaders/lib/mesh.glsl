// SPDX-License-Identifier: Apache-2.0
// Vertex inputs of every mesh pass: a VertexRecord and the InstanceRecord that places it.
layout(location = kAttributePosition) in vec3 aPosition;
layout(location = kAttributePatch) in uint aPatch;
layout(location = kAttributeRow0) in vec4 aRow0;
layout(location = kAttributeRow1) in vec4 aRow1;
layout(location = kAttributeRow2) in vec4 aRow2;
layout(location = kAttributeInstancePatch) in uint aInstancePatch;

vec3 worldPosition()
{
    const vec4 p = vec4(aPosition, 1.0);
    return vec3(dot(aRow0, p), dot(aRow1, p), dot(aRow2, p));
}

uint patchOfVertex() { return aPatch + aInstancePatch; }
