// SPDX-License-Identifier: Apache-2.0
// Stage 4, option: light in the middles of the fans of a patch that has several (see SmoothMesh).
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
HELIO_READS_VEC4(means, kSmoothMeans)
HELIO_READS_VEC4(before, kSmoothBefore)
layout(set = 0, binding = kSmoothValues, scalar) buffer Values { vec4 values[]; };
layout(push_constant, scalar) uniform Params { SmoothParams params; };

void main()
{
    const uint i = globalIndex(kSolveGroup);
    if (i >= params.patchCount) return;
    const uint first = readUint(fans, i), end = readUint(fans, i + 1u);
    if (first == end) return;
    const uint fan = params.cornerCount + params.patchCount;
    const vec4 mean = readVec4(means, i), middle = readVec4(before, params.cornerCount + i);
    vec4 least = vec4(0.0);
    for (uint f = first; f < end; ++f) { // b - a
        const uint begin = readUint(rows, f), endRow = readUint(rows, f + 1u);
        if (begin == endRow) continue;
        vec4 over = 0.5 * (middle - mean);
        for (uint k = begin; k < endRow; ++k) {
            const uvec2 item = readUvec2(weights, k);
            over += uintBitsToFloat(item.y) * (readVec4(before, item.x) - mean);
        }
        least = min(least, over);
        values[fan + f] = over;
    }
    // The part of the difference between fans that leaves the least of them at zero or more.
    const vec4 turn = min(middle / max(-least, vec4(1e-30)), vec4(1.0));
    for (uint f = first; f < end; ++f) {
        const bool flat_ = readUint(rows, f) == readUint(rows, f + 1u);
        values[fan + f] = flat_ ? mean : max(middle + turn * values[fan + f], vec4(0.0));
    }
}
