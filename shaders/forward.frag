// SPDX-License-Identifier: Apache-2.0
// Stage 4: albedo / pi x (shadow-mapped sun + E_sky + E_indirect of the pixel's patch), and the debug views of every stage.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/records.h"
#include "shaders/shared/view.h"
#include "shaders/lib/view.glsl"
#include "shaders/lib/sky.glsl"

const float kPi = 3.14159265358979;

layout(constant_id = 0) const uint kMode = kModeFinal;
layout(set = 0, binding = kForwardShadow) uniform sampler2DArrayShadow shadow;
layout(set = 0, binding = kForwardPatches, scalar) readonly buffer Patches { PatchRecord patches[]; };
layout(set = 0, binding = kForwardSun, scalar) readonly buffer Sun { vec4 sun[]; };
layout(set = 0, binding = kForwardSky, scalar) readonly buffer Sky { vec4 sky[]; };
layout(set = 0, binding = kForwardIndirect, scalar) readonly buffer Indirect { vec4 indirect[]; };
layout(set = 0, binding = kForwardRadiosity, scalar) readonly buffer Radiosity { vec4 radiosity[]; };
layout(location = 0) in vec3 vPosition;
layout(location = 1) in vec3 vNormal;
layout(location = 2) in vec3 vAlbedo;
layout(location = 3) in vec3 vSky;
layout(location = 4) in vec3 vIndirect;
layout(location = 5) flat in uint vPatch;
layout(location = 6) flat in uint vInterpolated;
layout(location = 0) out vec4 oRadiance;

// The fraction of this point that the sun reaches. A plane under angle theta to the sun departs from its depth sample by
// texel tan(theta) over one texel; moving the point out by 1.5 texel sin(theta) along its normal clears that for the four
// samples of the comparison, whatever the angle.
float sunVisibility(vec3 normal, float cosine)
{
    if (view.sunDirection.w == 0.0 || cosine <= 0.0) return 0.0;
    const float texel = max(view.shadowTexel.x, view.shadowTexel.y);
    const float sine = sqrt(max(0.0, 1.0 - cosine * cosine));
    const vec3 outside = vPosition + normal * (1.5 * texel * sine);
    const vec3 s = (view.sunFromWorld * vec4(outside, 1.0)).xyz;
    const vec2 cell = clamp(floor(s.xy), vec2(0.0), view.gridSize - 1.0);
    const vec2 inside = s.xy - cell;
    const float layer = cell.y * view.gridSize.x + cell.x;
    const float depth = s.z - (0.002 + 0.25 * texel) / view.depthRange;
    return texture(shadow, vec4(inside.x, 1.0 - inside.y, layer, depth));
}

vec3 hashColour(uint id)
{
    uint h = (id ^ (id >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    h ^= h >> 16;
    return 0.15 + 0.85 * vec3(h & 255u, (h >> 8) & 255u, (h >> 16) & 255u) / 255.0;
}

void main()
{
    // Polygons are drawn from both sides: the normal follows the side that is seen.
    const vec3 toEye = view.eye.xyz - vPosition;
    vec3 seen = cross(dFdx(vPosition), dFdy(vPosition));
    seen = dot(seen, toEye) < 0.0 ? -seen : seen;
    vec3 normal = normalize(vNormal);
    normal = dot(normal, seen) < 0.0 ? -normal : normal;
    const float cosine = dot(normal, view.sunDirection.xyz);

    if (kMode == kModeId) {
        oRadiance = vec4(hashColour(vPatch), float(vPatch));
    } else if (kMode == kModeDepth) {
        oRadiance = vec4(length(toEye));
    } else if (kMode == kModeSunVisibility) {
        oRadiance = vec4(sunVisibility(normal, cosine));
    } else if (kMode == kModeSun) {
        oRadiance = sun[vPatch];
    } else if (kMode == kModeSky) {
        oRadiance = sky[vPatch];
    } else if (kMode == kModeIndirect) {
        oRadiance = indirect[vPatch];
    } else if (kMode == kModeRadiosity) {
        oRadiance = radiosity[vPatch];
    } else {
        const vec3 direct = view.dni.rgb * max(cosine, 0.0) * sunVisibility(normal, cosine);
        const vec3 fromSky = vInterpolated != 0u ? vSky : sky[vPatch].rgb;
        const vec3 bounced = vInterpolated != 0u ? vIndirect : indirect[vPatch].rgb;
        const vec3 incoming = direct * view.sunTint.rgb + fromSky * view.skyTint.rgb + bounced;
        vec3 radiance = (vAlbedo * incoming + view.emissionScale * patches[vPatch].emission.rgb) / kPi;
        const float distance = length(toEye);
        if (view.eye.w > 0.0) {
            const vec3 direction = -toEye / distance;
            const vec3 haze = skyRadiance(normalize(vec3(direction.xy, max(direction.z, 0.02))));
            radiance = mix(haze, radiance, exp(-distance * view.eye.w));
        }
        oRadiance = vec4(radiance, 1.0);
    }
}
