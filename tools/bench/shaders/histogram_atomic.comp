// SPDX-License-Identifier: Apache-2.0
// The naive histogram: one atomic a texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/sun.h"

layout(local_size_x = 256) in;
layout(set = 0, binding = kHistogramIds, r32ui) uniform readonly uimage2D ids;
layout(set = 0, binding = kHistogramCounts, scalar) buffer Counts { uint counts[]; };
layout(push_constant, scalar) uniform Params { HistogramParams params; };

void main()
{
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= params.width || at.y >= params.height) return;
    const uint id = imageLoad(ids, ivec2(at)).x;
    if (id < params.patchCount) atomicAdd(counts[id], 1u);
}
