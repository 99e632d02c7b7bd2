// SPDX-License-Identifier: Apache-2.0
// Stage 4: albedo / pi x (shadow-mapped sun + soft light), or the share of the sun that arrives.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/records.h"
#include "shaders/shared/view.h"
#include "shaders/lib/fetch.glsl"
#include "shaders/lib/view.glsl"
#include "shaders/lib/distance.glsl"

const float kPi = 3.14159265358979;

layout(constant_id = 0) const uint kMode = kModeFinal;
layout(constant_id = 2) const bool kEmitters = false;
layout(push_constant, scalar) uniform Params { ForwardParams params; };
layout(set = 0, binding = kForwardShadow) uniform sampler2DArray shadow;
HELIO_READS_VEC4(emission, kForwardShown)
layout(location = 0) in vec4 vSun;
layout(location = 1) in vec3 vLight;
layout(location = 2) flat in vec3 vAlbedo;
layout(location = 3) flat in uint vPatch;
layout(location = 0) out vec4 oRadiance;

// The fraction of this point that the sun reaches: nine depth comparisons, a tent three texels wide. Each texel is compared
// with the depth that the point's own plane has at the texel's centre (its depth there is what the raster stored), so the
// test stays sharp at grazing light, where any constant bias would move shadows by metres. Where the plane falls away from
// the sun the point's own depth is taken instead: beyond a concave edge there is another surface, not the plane.
// slope: depth a texel along that plane, in x and in y.
float sunVisibility(vec2 slope, bool shines)
{
    const float bias = (0.002 + 0.25 * view.shadowTexel) / view.depthRange + 0.02 * (abs(slope.x) + abs(slope.y));

    const vec3 place = vSun.xyz + vec3(params.sunRow0.w, params.sunRow1.w, params.sunRow2.w);
    const vec2 size = 1.0 / view.shadowStep;
    vec2 cell; // of the grid of views
    cell.x = clamp(floor(place.x * view.shadowStep.x), 0.0, view.gridSize.x - 1.0);
    const float sheared = view.sunShear * cell.x;
    cell.y = clamp(floor(-place.y * view.shadowStep.y - sheared), 0.0, view.gridSize.y - 1.0);
    const float layer = cell.y * view.gridSize.x + cell.x;
    const vec2 texel = place.xy + size * vec2(-cell.x, 1.0 + cell.y + sheared); // centres at one half

    // The samples stay inside the view: beyond its edge there is no depth to compare with.
    const vec2 from = clamp(texel, vec2(1.5), size - 1.5) - 1.0;
    const vec2 first = floor(from); // of three texels along each axis
    const vec2 share = from - first;
    const float inPlane = dot(slope, first + 0.5 - texel);
    float sum = 0.0;
    // A loop of no rounds where the sun does not shine: software devices walk through a branch that no lane takes.
    const int gathers = shines ? 4 : 0;
    for (int k = 0; k < gathers; ++k) {
        const vec2 corner = vec2(k & 1, k >> 1);
        // Order of a gather: (0, 1), (1, 1), (1, 0), (0, 0).
        const vec4 stored = textureGather(shadow, vec3((first + corner + 1.0) * view.shadowStep, layer), 0);
        const float plane = inPlane + dot(slope, corner);
        const vec4 reference = place.z - bias + min(plane + vec4(slope.y, slope.x + slope.y, slope.x, 0.0), 0.0);
        const vec4 lit = vec4(greaterThanEqual(stored, reference));
        const vec2 row = mix(lit.wx, lit.zy, share.x);
        sum += mix(row.x, row.y, share.y);
    }
    return 0.25 * sum;
}

void main()
{
    // How places in the sun's picture change from pixel to pixel. The sun and the eye see the same side of a surface if what
    // turns clockwise in one picture does so in the other: surfaces have two sides, whatever their normal.
    const vec3 across = dFdx(vSun.xyz), down = dFdy(vSun.xyz);
    const float area = across.x * down.y - down.x * across.y;
    const float steepest = 10.0 / view.depthRange;
    const vec2 slope = vec2(across.z * down.y - down.z * across.y, across.x * down.z - down.x * across.z) / area;
    const float cosine = area > 0.0 ? abs(vSun.w) : 0.0;
    const bool shines = view.sunDirection.w != 0.0 && cosine > 0.0;
    const float visible = sunVisibility(area == 0.0 ? vec2(0.0) : clamp(slope, -steepest, steepest), shines);
    if (kMode == kModeSunVisibility) {
        oRadiance = vec4(visible);
        return;
    }
    vec3 radiance = vAlbedo * (view.sunLight.rgb * (cosine * visible) + vLight);
    if (kEmitters) radiance += view.emissionScale * readVec4(emission, vPatch).rgb;
    // Distance turns to the horizon's colour.
    oRadiance = vec4(mix(view.horizon.rgb, radiance / kPi, exp(-params.eye.w * distanceOf())), 1.0);
}
