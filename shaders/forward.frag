// SPDX-License-Identifier: Apache-2.0
// Stage 4: albedo / pi x (shadow-mapped sun + E_sky + E_indirect of the pixel's patch), and the debug views of every stage.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/records.h"
#include "shaders/shared/view.h"
#include "shaders/lib/view.glsl"

const float kPi = 3.14159265358979;

layout(constant_id = 0) const uint kMode = kModeFinal;
layout(constant_id = 1) const bool kInterpolate = false;
layout(constant_id = 2) const bool kEmitters = false;
layout(push_constant, scalar) uniform Params { ForwardParams params; };
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
layout(location = 0) out vec4 oRadiance;

// The fraction of this point that the sun reaches: four bilinear comparisons, a tent three texels wide. A plane under angle
// theta to the sun departs from its depth sample by texel tan(theta) over one texel; moving the point out by 2.2 texel
// sin(theta) along its normal clears that for all samples of the tent, whatever the angle.
float sunVisibility(vec3 normal, float cosine)
{
    if (view.sunDirection.w == 0.0 || cosine <= 0.0) return 0.0;
    const float sine = sqrt(max(0.0, 1.0 - cosine * cosine));
    const vec4 outside = vec4(vPosition + normal * (2.2 * view.shadowTexel * sine), 1.0);
    vec2 at = vec2(dot(params.sunRow0, outside), dot(params.sunRow1, outside));
    vec2 cell;
    cell.x = clamp(floor(at.x), 0.0, view.gridSize.x - 1.0);
    at.y += view.sunShear * (at.x - cell.x);
    cell.y = clamp(floor(at.y), 0.0, view.gridSize.y - 1.0);
    // The samples stay inside the view: beyond its edge there is no depth to compare with.
    const vec2 uv = clamp(vec2(at.x - cell.x, 1.0 - (at.y - cell.y)), view.shadowStep, 1.0 - view.shadowStep);
    const float layer = cell.y * view.gridSize.x + cell.x;
    const float depth = dot(params.sunRow2, outside) - (0.002 + 0.25 * view.shadowTexel) / view.depthRange;
    const vec2 s = 0.5 * view.shadowStep;
    return 0.25 * (texture(shadow, vec4(uv - s, layer, depth)) + texture(shadow, vec4(uv + s, layer, depth)) +
                   texture(shadow, vec4(uv.x - s.x, uv.y + s.y, layer, depth)) +
                   texture(shadow, vec4(uv.x + s.x, uv.y - s.y, layer, depth)));
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
    const vec3 toEye = params.eye.xyz - vPosition;
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
        const vec3 direct = view.sunLight.rgb * (max(cosine, 0.0) * sunVisibility(normal, cosine));
        const vec3 fromSky = kInterpolate ? vSky : sky[vPatch].rgb;
        const vec3 bounced = kInterpolate ? vIndirect : indirect[vPatch].rgb;
        vec3 radiance = vAlbedo * (direct + fromSky * view.skyTint.rgb + bounced);
        if (kEmitters) radiance += view.emissionScale * patches[vPatch].emission.rgb;
        radiance /= kPi;
        // Distance turns to the horizon's colour.
        const float clear = exp(-length(toEye) * params.eye.w);
        radiance = mix(view.horizon.rgb, radiance, clear);
        oRadiance = vec4(radiance, 1.0);
    }
}
