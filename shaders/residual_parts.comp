// SPDX-License-Identifier: Apache-2.0
// Stage 3: what is still missing from B, and the sums that go with it; each lane adds up its patches in their order, without
// atomics, so the same input gives the same bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/records.h"
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/fetch.glsl"

layout(local_size_x = kSolveGroup) in;
HELIO_READS_VEC4(reflectance, kPartsReflectance)
HELIO_READS_VEC4(b0, kPartsB0)
HELIO_READS_VEC4(irradiance, kPartsIrradiance)
HELIO_READS_VEC4(senders, kPartsSenders)
HELIO_READS_VEC4(planes, kPartsPlanes)
layout(set = 0, binding = kPartsOut, scalar) writeonly buffer Parts { ResidualRecord parts[]; };
layout(push_constant, scalar) uniform Params { CountParams params; };

void main()
{
    const uint lane = globalIndex(kSolveGroup);
    const uint first = lane / kSolveGroup * kSolveGroup * kResidualRun + lane % kSolveGroup;
    if (first / kSolveGroup * kSolveGroup >= params.count) return; // lanes of a group that began have zeros to give
    vec4 change = vec4(0.0), scale = vec4(0.0), total = vec4(0.0), largest = vec4(0.0);
    for (uint k = 0u; k < kResidualRun; ++k) {
        const uint i = first + k * kSolveGroup;
        if (i >= params.count) break;
        const float area = readVec4(planes, i).w;
        const vec4 added = readVec4(reflectance, i) * readVec4(irradiance, i);
        const vec4 next = readVec4(b0, i) + added;
        const vec4 step = next - readVec4(senders, i);
        change += area * step * step;
        scale += area * added * added;
        total += area * next;
        largest = max(largest, abs(step));
    }
    parts[lane] = ResidualRecord(change, scale, total, largest);
}
