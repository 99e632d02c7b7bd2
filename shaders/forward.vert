// SPDX-License-Identifier: Apache-2.0
// Stage 4: places the meshes in the picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/sun.h"
#include "shaders/shared/view.h"
#include "shaders/lib/mesh.glsl"

layout(constant_id = 1) const bool kInterpolate = false; // of the static mesh alone
layout(push_constant, scalar) uniform Params { ForwardParams params; };
layout(location = kAttributeNormal) in uint aNormal;
layout(location = kAttributeAlbedo) in uint aAlbedo;
layout(set = 0, binding = kForwardCorners, scalar) readonly buffer Corners { uint corners[]; };
layout(set = 0, binding = kForwardSmooth, scalar) readonly buffer Smooth { vec4 corner[]; };
layout(location = 0) out vec3 vPosition;
layout(location = 1) out vec3 vNormal;
layout(location = 2) out vec3 vAlbedo;
layout(location = 3) out vec3 vSky;
layout(location = 4) out vec3 vIndirect;
layout(location = 5) flat out uint vPatch;

// A2B10G10R10_SNORM: x in the low ten bits.
vec3 unpackNormal(uint bits)
{
    const ivec3 parts = ivec3(bitfieldExtract(int(bits), 0, 10), bitfieldExtract(int(bits), 10, 10),
                              bitfieldExtract(int(bits), 20, 10));
    return max(vec3(parts) / 511.0, vec3(-1.0));
}

// Normals go by the cofactors of the transform, so that mirrored and stretched instances keep theirs.
vec3 worldNormal(vec3 n)
{
    const vec3 x = vec3(aRow0.x, aRow1.x, aRow2.x), y = vec3(aRow0.y, aRow1.y, aRow2.y), z = vec3(aRow0.z, aRow1.z, aRow2.z);
    const float orientation = dot(cross(x, y), z) < 0.0 ? -1.0 : 1.0;
    return orientation * normalize(n.x * cross(y, z) + n.y * cross(z, x) + n.z * cross(x, y));
}

void main()
{
    vPosition = worldPosition();
    vNormal = worldNormal(unpackNormal(aNormal));
    vAlbedo = unpackUnorm4x8(aAlbedo).rgb;
    vPatch = patchOfVertex();
    vSky = vec3(0.0);
    vIndirect = vec3(0.0);
    if (kInterpolate) {
        const uint k = corners[gl_VertexIndex];
        vSky = corner[2u * k].rgb;
        vIndirect = corner[2u * k + 1u].rgb;
    }
    gl_Position = params.clipFromWorld * vec4(vPosition, 1.0);
}
