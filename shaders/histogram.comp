// SPDX-License-Identifier: Apache-2.0
// Stage 2: texels of each patch, exact. A lane counts runs down its column, so the coherence of the picture is used before
// any atomic; the runs that reach the end of the column are summed over the lanes of the subgroup that hold the same patch.
// Works with every subgroup size. kAggregate = false is the twin with one plain atomic a run.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shaders/shared/sun.h"

layout(constant_id = 0) const bool kAggregate = true;
layout(local_size_x = kHistogramGroup) in;
layout(set = 0, binding = kHistogramIds, r32ui) uniform readonly uimage2D ids;
layout(set = 0, binding = kHistogramCounts, scalar) buffer Counts { uint counts[]; };
layout(push_constant, scalar) uniform Params { HistogramParams params; };

void addRun(uint id, uint length)
{
    if (id < params.patchCount && length > 0u) atomicAdd(counts[id], length);
}

// Sums the runs of the lanes that ended on the same patch, one atomic a patch.
void addLastRun(uint id, uint length)
{
    if (id >= params.patchCount || length == 0u) return;
    for (;;) {
        if (id == subgroupBroadcastFirst(id)) {
            const uint total = subgroupAdd(length);
            if (subgroupElect()) atomicAdd(counts[id], total);
            break;
        }
    }
}

void main()
{
    const uint x = gl_GlobalInvocationID.x;
    const uint yBegin = gl_WorkGroupID.y * kHistogramRun;
    if (x >= params.width) return;

    uint current = 0xFFFFFFFFu;
    uint length = 0u;
    for (uint step = 0u; step < kHistogramRun; step += kHistogramStep) {
        const uint y = yBegin + step;
        uint id[kHistogramStep];
        bool same = true;
        for (uint k = 0u; k < kHistogramStep; ++k) {
            id[k] = y + k < params.height ? imageLoad(ids, ivec2(x, y + k)).x : 0xFFFFFFFFu;
            same = same && id[k] == current;
        }
        if (same) {
            length += kHistogramStep;
            continue;
        }
        for (uint k = 0u; k < kHistogramStep; ++k) {
            if (id[k] != current) {
                addRun(current, length);
                current = id[k];
                length = 0u;
            }
            ++length;
        }
    }
    if (kAggregate)
        addLastRun(current, length);
    else
        addRun(current, length);
}
