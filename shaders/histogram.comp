// SPDX-License-Identifier: Apache-2.0
// Stage 2: texels of each patch, exact. Lanes side by side in x; a lane walks down its column and makes one atomic of each run
// of equal ids. HELIO_SUBGROUPS: lanes that lie side by side make one atomic of the runs that they end on the same patch, for
// devices on which atomics cost more than votes; any subgroup size.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#ifdef HELIO_SUBGROUPS
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#endif
#include "shaders/shared/sun.h"

layout(local_size_x = kHistogramGroup) in;
layout(set = 0, binding = kHistogramIds, r32ui) uniform readonly uimage2D ids;
layout(set = 0, binding = kHistogramCounts, scalar) buffer Counts { uint counts[]; };
layout(push_constant, scalar) uniform Params { HistogramParams params; };

const uint kNothing = 0xFFFFFFFFu;

void addRun(uint id, uint length)
{
#ifdef HELIO_SUBGROUPS
    if (id >= params.patchCount || length == 0u) return;
    for (;;) {
        if (id == subgroupBroadcastFirst(id)) {
            const uint total = subgroupAdd(length);
            if (subgroupElect()) atomicAdd(counts[id], total);
            break;
        }
    }
#else
    if (id < params.patchCount) atomicAdd(counts[id], length);
#endif
}

uint idAt(uint x, uint y) { return imageLoad(ids, ivec2(x, y)).x; }

void main()
{
    const uint x = gl_GlobalInvocationID.x;
    uint y = gl_WorkGroupID.y * kHistogramRun;
    const uint end = min(y + kHistogramRun, params.height);
    if (x >= params.width) return;

    uint current = kNothing, length = 0u;
    for (; y + kHistogramStep <= end; y += kHistogramStep) {
        uint changes = 0u, before = current;
        for (uint k = 0u; k < kHistogramStep; ++k) {
            const uint id = idAt(x, y + k);
            changes |= uint(id != before) << k;
            before = id;
        }
        // A loop, since where nothing changes software devices leave it but would walk through a branch.
        uint counted = 0u;
        while (changes != 0u) {
            const uint k = uint(findLSB(changes));
            changes &= changes - 1u;
            addRun(current, length + k - counted);
            length = 0u;
            counted = k;
            current = idAt(x, y + k);
        }
        length += kHistogramStep - counted;
    }
    for (; y < end; ++y) {
        const uint id = idAt(x, y);
        if (id != current) {
            addRun(current, length);
            length = 0u;
            current = id;
        }
        ++length;
    }
    addRun(current, length);
}
