// SPDX-License-Identifier: Apache-2.0
// Stage 4, option: light in the middle of a patch's fan, such that the patch keeps its mean (see SmoothMesh).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/fetch.glsl"

layout(local_size_x = kSolveGroup) in;
HELIO_READS_UINT(rows, kSmoothRows)
HELIO_READS_UVEC2(weights, kSmoothItems)
HELIO_READS_VEC4(means, kSmoothMeans)
HELIO_READS_VEC4(before, kSmoothBefore)
layout(set = 0, binding = kSmoothValues, scalar) writeonly buffer Values { vec4 values[]; };
layout(push_constant, scalar) uniform Params { SmoothParams params; };

void main()
{
    const uint i = globalIndex(kSolveGroup);
    if (i >= params.patchCount) return;
    const vec4 mean = readVec4(means, i);
    vec4 middle = mean;
    const uint end = readUint(rows, i + 1u);
    for (uint k = readUint(rows, i); k < end; ++k) {
        const uvec2 item = readUvec2(weights, k);
        middle += uintBitsToFloat(item.y) * (mean - readVec4(before, item.x));
    }
    values[params.cornerCount + i] = max(middle, vec4(0.0));
}
