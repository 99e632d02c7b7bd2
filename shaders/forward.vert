// SPDX-License-Identifier: Apache-2.0
// Stage 4: places the meshes in the picture, and in the sun's.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/sun.h"
#include "shaders/shared/view.h"
#include "shaders/lib/fetch.glsl"
#include "shaders/lib/mesh.glsl"
#include "shaders/lib/view.glsl"

layout(constant_id = 1) const bool kInterpolate = false; // of the smooth mesh alone
layout(constant_id = 3) const bool kTwoSided = true;     // open surfaces: the normal follows the side that is seen
layout(push_constant, scalar) uniform Params { ForwardParams params; };
layout(location = kAttributeAlbedo) in uint aAlbedo;
HELIO_READS_UINT(valueOf, kForwardValueOf)
HELIO_READS_VEC4(light, kForwardLight)
layout(location = 0) out vec4 vSun;   // place in the sun's picture, seen from the eye's: small near it, so that its
                                      // derivatives are precise; and the cosine of the sun
layout(location = 1) out vec3 vLight; // one value a patch, or interpolated
layout(location = 2) flat out vec3 vAlbedo;
layout(location = 3) flat out uint vPatch;

void main()
{
    const vec3 position = worldPosition(), fromEye = position - params.eye.xyz;
    vec3 normal = normalize(worldNormal());
    if (kTwoSided) normal = dot(normal, fromEye) > 0.0 ? -normal : normal;
    vSun = vec4(dot(params.sunRow0.xyz, fromEye), dot(params.sunRow1.xyz, fromEye), dot(params.sunRow2.xyz, fromEye),
                dot(normal, view.sunDirection.xyz));
    vPatch = patchOfVertex();
    vLight = readVec4(light, kInterpolate ? readUint(valueOf, gl_VertexIndex) : vPatch).rgb;
    vAlbedo = unpackUnorm4x8(aAlbedo).rgb;
    gl_Position = params.clipFromWorld * vec4(position, 1.0);
}
