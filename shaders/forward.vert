// SPDX-License-Identifier: Apache-2.0
// Stage 4: places the meshes in the picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/sun.h"
#include "shaders/shared/view.h"
#include "shaders/lib/fetch.glsl"
#include "shaders/lib/mesh.glsl"

layout(constant_id = 1) const bool kInterpolate = false; // of the smooth mesh alone
layout(push_constant, scalar) uniform Params { ForwardParams params; };
layout(location = kAttributeAlbedo) in uint aAlbedo;
HELIO_READS_UINT(valueOf, kForwardValueOf)
HELIO_READS_VEC4(smooth_, kForwardSmooth)
layout(location = 0) out vec3 vFromEye; // small near the eye, so that its derivatives are precise
layout(location = 1) out vec3 vNormal;
layout(location = 2) out vec3 vAlbedo;
layout(location = 3) out vec3 vSky;
layout(location = 4) out vec3 vIndirect;
layout(location = 5) flat out uint vPatch;

void main()
{
    const vec3 position = worldPosition();
    vFromEye = position - params.eye.xyz;
    vNormal = worldNormal();
    vAlbedo = unpackUnorm4x8(aAlbedo).rgb;
    vPatch = patchOfVertex();
    vSky = vec3(0.0);
    vIndirect = vec3(0.0);
    if (kInterpolate) {
        const uint k = readUint(valueOf, gl_VertexIndex);
        vSky = readVec4(smooth_, 2u * k).rgb;
        vIndirect = readVec4(smooth_, 2u * k + 1u).rgb;
    }
    gl_Position = params.clipFromWorld * vec4(position, 1.0);
}
