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
#include "shaders/lib/sky.glsl"

layout(constant_id = 0) const uint kMode = kModeFinal;
layout(constant_id = 1) const bool kInterpolate = false; // of the smooth mesh alone
layout(push_constant, scalar) uniform Params { ForwardParams params; };
layout(location = kAttributeAlbedo) in uint aAlbedo;
HELIO_READS_UINT(valueOf, kForwardValueOf)
HELIO_READS_VEC4(light, kForwardLight)
layout(location = 0) out vec4 vSun;   // place in the sun's picture, seen from the eye's: small near it, so that its
                                      // derivatives are precise; and the cosine of the sun to the normal
layout(location = 1) out vec3 vLight; // one value a patch, or interpolated
layout(location = 2) flat out vec3 vAlbedo;
layout(location = 3) flat out uint vPatch;

const float kPi = 3.14159265358979;

// What a pane of glass reflects: Fresnel at its two faces (Schlick, An inexpensive BRDF model, 1994; n = 1.5), without
// interference 2 R / (1 + R). Near the horizon a city stands before the sky: it shines with its own soft light.
// toEye, normal: unit, from either side; light: soft light there, W/m2. Radiance, W/m2/sr.
vec3 reflectedByPane(vec3 toEye, vec3 normal, vec3 light)
{
    const float cosine = min(abs(dot(normal, toEye)), 1.0);
    const float low = 1.0 - cosine, low2 = low * low;
    const float face = 0.04 + 0.96 * low2 * low2 * low;
    const vec3 direction = reflect(-toEye, normal);
    const vec3 city = 0.3 / kPi * light;
    return 2.0 * face / (1.0 + face) * mix(city, domeRadiance(direction), smoothstep(0.0, 0.5, direction.z));
}

void main()
{
    const vec3 position = worldPosition(), fromEye = position - params.eye.xyz;
    const vec3 normal = normalize(worldNormal());
    vSun = vec4(dot(params.sunRow0.xyz, fromEye), dot(params.sunRow1.xyz, fromEye), dot(params.sunRow2.xyz, fromEye),
                dot(normal, view.sunDirection.xyz));
    vPatch = patchOfVertex();
    const vec4 albedo = unpackUnorm4x8(aAlbedo);
    vAlbedo = albedo.rgb;
    vLight = vec3(0.0);
    if (kMode == kModeFinal) {
        vLight = readVec4(light, kInterpolate ? readUint(valueOf, gl_VertexIndex) : vPatch).rgb;
        // As light that makes the pane as bright as its reflection does. Chosen, not branched: software devices would walk
        // through a branch, and a loop of no rounds costs them more than this.
        const bool pane = view.glow.w > 0.0 && albedo.a == 0.0;
        vAlbedo = max(vAlbedo, vec3(pane ? 0.01 : 0.0));
        const vec3 asLight = kPi / vAlbedo * reflectedByPane(normalize(-fromEye), normal, vLight);
        vLight += pane ? asLight : vec3(0.0);
    }
    gl_Position = params.clipFromWorld * vec4(position, 1.0);
}
