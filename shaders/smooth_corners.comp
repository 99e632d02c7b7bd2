// SPDX-License-Identifier: Apache-2.0
// Stage 4, option: light at a corner of the smooth mesh. First the mean over the patches that meet there; in later rounds
// it moves half as far as the middles of these patches are from their means, so that light which rises evenly ends up
// without a peak in the middle of each patch. For pictures; tables use the raw values.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/fetch.glsl"

layout(local_size_x = kSolveGroup) in;
HELIO_READS_UINT(rows, kSmoothRows)
HELIO_READS_UINT(patches, kSmoothItems)
HELIO_READS_VEC4(means, kSmoothMeans)
HELIO_READS_VEC4(before, kSmoothBefore)
layout(set = 0, binding = kSmoothValues, scalar) buffer Values { vec4 values[]; };
layout(push_constant, scalar) uniform Params { SmoothParams params; };

void main()
{
    const uint i = globalIndex(kSolveGroup);
    if (i >= params.cornerCount) return;
    const uint begin = readUint(rows, i), end = readUint(rows, i + 1u);
    vec4 least = vec4(uintBitsToFloat(0x7F800000u)), move = vec4(0.0);
    for (uint k = begin; k < end; ++k) {
        const uint patch_ = readUint(patches, k);
        const vec4 mean = readVec4(means, patch_);
        least = min(least, mean);
        move += params.round == 0u ? mean : 0.5 * (readVec4(before, params.cornerCount + patch_) - mean);
    }
    const vec4 from = params.round == 0u ? vec4(0.0) : values[i];
    values[i] = clamp(from + move / float(max(end - begin, 1u)), vec4(0.0), kSmoothLimit * max(least, 0.0));
}
