// SPDX-License-Identifier: Apache-2.0
// Stage 4: albedo / pi x (shadow-mapped sun + E_sky + E_indirect of the pixel's patch), and the debug views of every stage.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/records.h"
#include "shaders/shared/view.h"
#include "shaders/lib/fetch.glsl"
#include "shaders/lib/view.glsl"

const float kPi = 3.14159265358979;

layout(constant_id = 0) const uint kMode = kModeFinal;
layout(constant_id = 1) const bool kInterpolate = false;
layout(constant_id = 2) const bool kEmitters = false;
layout(push_constant, scalar) uniform Params { ForwardParams params; };
layout(set = 0, binding = kForwardShadow) uniform sampler2DArray shadow;
HELIO_READS_VEC4(emission, kForwardEmission)
HELIO_READS_VEC4(sun, kForwardSun)
HELIO_READS_VEC4(sky, kForwardSky)
HELIO_READS_VEC4(indirect, kForwardIndirect)
HELIO_READS_VEC4(radiosity, kForwardRadiosity)
layout(location = 0) in vec3 vFromEye;
layout(location = 1) in vec3 vNormal;
layout(location = 2) in vec3 vAlbedo;
layout(location = 3) in vec3 vSky;
layout(location = 4) in vec3 vIndirect;
layout(location = 5) flat in uint vPatch;
layout(location = 0) out vec4 oRadiance;

// The fraction of this point that the sun reaches: nine depth comparisons, a tent three texels wide. Each texel is compared
// with the depth that the point's own plane has at the texel's centre (its depth there is what the raster stored), so the
// test stays sharp at grazing light, where any constant bias would move shadows by metres. Where the plane falls away from
// the sun the point's own depth is taken instead: beyond a concave edge there is another surface, not the plane.
// plane: the normal of the point's plane, of any length.
float sunVisibility(float cosine, vec3 plane)
{
    // A loop of no rounds where the sun does not shine: software devices walk through a branch that no lane takes.
    const bool faces = view.sunDirection.w != 0.0 && cosine > 0.0;
    const vec2 size = 1.0 / view.shadowStep;
    const vec4 point = vec4(vFromEye + params.eye.xyz, 1.0);
    vec2 at = vec2(dot(params.sunRow0, point), dot(params.sunRow1, point));
    vec2 cell;
    cell.x = clamp(floor(at.x), 0.0, view.gridSize.x - 1.0);
    at.y += view.sunShear * (at.x - cell.x);
    cell.y = clamp(floor(at.y), 0.0, view.gridSize.y - 1.0);
    const float layer = cell.y * view.gridSize.x + cell.x;
    const vec2 texel = size * vec2(at.x - cell.x, 1.0 - (at.y - cell.y)); // centres at one half
    const float depth = dot(params.sunRow2, point);

    // Depth a texel, in x and in y, along the plane.
    const float steepest = 10.0 / view.depthRange;
    const float across = dot(plane, view.shadowDown.xyz);
    vec2 slope = vec2(dot(plane, view.shadowRight.xyz), dot(plane, view.shadowUp.xyz)) / across;
    slope = across == 0.0 ? vec2(0.0) : clamp(slope, -steepest, steepest);
    const float bias = (0.002 + 0.25 * view.shadowTexel) / view.depthRange + 0.02 * (abs(slope.x) + abs(slope.y));

    // The samples stay inside the view: beyond its edge there is no depth to compare with.
    const vec2 from = clamp(texel, vec2(1.5), size - 1.5) - 1.0;
    const vec2 first = floor(from); // of three texels along each axis
    const vec2 share = from - first;
    float sum = 0.0;
    const int gathers = faces ? 4 : 0;
    for (int k = 0; k < gathers; ++k) {
        const vec2 corner = first + vec2(k & 1, k >> 1);
        // Order of a gather: (0, 1), (1, 1), (1, 0), (0, 0).
        const vec4 stored = textureGather(shadow, vec3((corner + 1.0) * view.shadowStep, layer), 0);
        const vec2 d = corner + 0.5 - texel;
        const float inPlane = dot(slope, d);
        const vec4 reference = depth - bias + min(inPlane + vec4(slope.y, slope.x + slope.y, slope.x, 0.0), 0.0);
        const vec4 lit = vec4(greaterThanEqual(stored, reference));
        const vec2 row = mix(lit.wx, lit.zy, share.x);
        sum += mix(row.x, row.y, share.y);
    }
    return 0.25 * sum;
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
    // Open surfaces are drawn from both sides: the normal follows the side that is seen.
    vec3 seen = cross(dFdx(vFromEye), dFdy(vFromEye));
    seen = dot(seen, vFromEye) > 0.0 ? -seen : seen;
    vec3 normal = normalize(vNormal);
    normal = dot(normal, seen) < 0.0 ? -normal : normal;
    const float cosine = dot(normal, view.sunDirection.xyz);

    if (kMode == kModeId) {
        oRadiance = vec4(hashColour(vPatch), float(vPatch));
    } else if (kMode == kModeDepth) {
        oRadiance = vec4(length(vFromEye));
    } else if (kMode == kModeSunVisibility) {
        oRadiance = vec4(sunVisibility(cosine, seen));
    } else if (kMode == kModeSun) {
        oRadiance = readVec4(sun, vPatch);
    } else if (kMode == kModeSky) {
        oRadiance = readVec4(sky, vPatch);
    } else if (kMode == kModeIndirect) {
        oRadiance = readVec4(indirect, vPatch);
    } else if (kMode == kModeRadiosity) {
        oRadiance = readVec4(radiosity, vPatch);
    } else if (kMode >= kModeLevel) {
        oRadiance = vec4(readVec4(radiosity, vPatch).rgb, 1.0);
    } else if (kMode == kModeAlbedo) {
        oRadiance = vec4(vAlbedo, 1.0);
    } else {
        const vec3 direct = view.sunLight.rgb * (max(cosine, 0.0) * sunVisibility(cosine, seen));
        const vec3 fromSky = kInterpolate ? vSky : readVec4(sky, vPatch).rgb;
        const vec3 bounced = kInterpolate ? vIndirect : readVec4(indirect, vPatch).rgb;
        vec3 radiance = vAlbedo * (direct + fromSky * view.skyTint.rgb + bounced);
        if (kEmitters) radiance += view.emissionScale * readVec4(emission, vPatch).rgb;
        radiance /= kPi;
        // Distance turns to the horizon's colour.
        const float clear = exp(-length(vFromEye) * params.eye.w);
        radiance = mix(view.horizon.rgb, radiance, clear);
        oRadiance = vec4(radiance, 1.0);
    }
}
