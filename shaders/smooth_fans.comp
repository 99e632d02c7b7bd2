// SPDX-License-Identifier: Apache-2.0
// Stage 4, option: E_sky and E_indirect in the middles of the fans of a patch that has several (see SmoothMesh).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/fetch.glsl"

layout(local_size_x = kSolveGroup) in;
HELIO_READS_UINT(fans, kSmoothFans)
HELIO_READS_UINT(rows, kSmoothRows)
HELIO_READS_UVEC2(weights, kSmoothItems)
HELIO_READS_VEC4(sky, kSmoothSky)
HELIO_READS_VEC4(indirect, kSmoothIndirect)
HELIO_READS_VEC4(before, kSmoothBefore)
layout(set = 0, binding = kSmoothValues, scalar) buffer Values { vec4 values[]; };
layout(push_constant, scalar) uniform Params { SmoothParams params; };

// The part of the difference between fans that leaves the least of them at zero or more.
vec4 turnOf(vec4 middle, vec4 least)
{
    return min(middle / max(-least, vec4(1e-30)), vec4(1.0));
}

void main()
{
    const uint i = globalIndex(kSolveGroup);
    if (i >= params.patchCount) return;
    const uint first = readUint(fans, i), end = readUint(fans, i + 1u);
    if (first == end) return;
    const vec4 skyMean = readVec4(sky, i), indirectMean = readVec4(indirect, i);
    const uint patch_ = 2u * (params.cornerCount + i), fan = 2u * (params.cornerCount + params.patchCount);
    const vec4 skyMiddle = readVec4(before, patch_), indirectMiddle = readVec4(before, patch_ + 1u);
    vec4 skyLeast = vec4(0.0), indirectLeast = vec4(0.0);
    for (uint f = first; f < end; ++f) { // b - a
        vec4 skyOver = 0.5 * (skyMiddle - skyMean), indirectOver = 0.5 * (indirectMiddle - indirectMean);
        const uint begin = readUint(rows, f), endRow = readUint(rows, f + 1u);
        if (begin == endRow) continue;
        for (uint k = begin; k < endRow; ++k) {
            const uvec2 item = readUvec2(weights, k);
            const float weight = uintBitsToFloat(item.y);
            skyOver += weight * (readVec4(before, 2u * item.x) - skyMean);
            indirectOver += weight * (readVec4(before, 2u * item.x + 1u) - indirectMean);
        }
        skyLeast = min(skyLeast, skyOver);
        indirectLeast = min(indirectLeast, indirectOver);
        values[fan + 2u * f] = skyOver;
        values[fan + 2u * f + 1u] = indirectOver;
    }
    const vec4 skyTurn = turnOf(skyMiddle, skyLeast), indirectTurn = turnOf(indirectMiddle, indirectLeast);
    for (uint f = first; f < end; ++f) {
        const bool flat_ = readUint(rows, f) == readUint(rows, f + 1u);
        const uint at = fan + 2u * f;
        values[at] = flat_ ? skyMean : max(skyMiddle + skyTurn * values[at], vec4(0.0));
        values[at + 1u] = flat_ ? indirectMean : max(indirectMiddle + indirectTurn * values[at + 1u], vec4(0.0));
    }
}
