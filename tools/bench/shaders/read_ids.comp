// SPDX-License-Identifier: Apache-2.0
// The floor of any histogram: reads every texel of the ids, lanes side by side, 64 rows a lane, and counts nothing but an id
// that is not there.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/sun.h"

layout(local_size_x = kHistogramGroup) in;
layout(set = 0, binding = kHistogramIds, r32ui) uniform readonly uimage2D ids;
layout(set = 0, binding = kHistogramCounts, scalar) buffer Counts { uint counts[]; };
layout(push_constant, scalar) uniform Params { HistogramParams params; };

void main()
{
    const uint x = gl_GlobalInvocationID.x, yBegin = gl_WorkGroupID.y * kHistogramRun;
    if (x >= params.width) return;
    uint all = 0u;
    for (uint step = 0u; step < kHistogramRun; step += kHistogramStep)
        for (uint k = 0u; k < kHistogramStep; ++k) all ^= imageLoad(ids, ivec2(x, min(yBegin + step + k, params.height - 1u))).x;
    if (all == 0xABCDEF01u) counts[0] = all;
}
