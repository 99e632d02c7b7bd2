// SPDX-License-Identifier: Apache-2.0
// Stage 4, option: E_sky and E_indirect at a corner of the smooth mesh. First the mean over the patches that meet
// there; in later rounds it moves half as far as the middles of these patches are from their means, so that light which
// rises evenly ends up without a peak in the middle of each patch. For pictures; tables use the raw values.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/fetch.glsl"

layout(local_size_x = kSolveGroup) in;
HELIO_READS_UINT(rows, kSmoothRows)
HELIO_READS_UINT(patches, kSmoothItems)
HELIO_READS_VEC4(sky, kSmoothSky)
HELIO_READS_VEC4(indirect, kSmoothIndirect)
HELIO_READS_VEC4(before, kSmoothBefore)
layout(set = 0, binding = kSmoothValues, scalar) buffer Values { vec4 values[]; };
layout(push_constant, scalar) uniform Params { SmoothParams params; };

void main()
{
    const uint i = globalIndex(kSolveGroup);
    if (i >= params.cornerCount) return;
    const uint begin = readUint(rows, i), end = readUint(rows, i + 1u);
    const float share = 1.0 / float(max(end - begin, 1u));
    const vec4 infinite = vec4(uintBitsToFloat(0x7F800000u));
    vec4 skyLeast = infinite, indirectLeast = infinite;
    vec4 skyMove = vec4(0.0), indirectMove = vec4(0.0);
    for (uint k = begin; k < end; ++k) {
        const uint patch_ = readUint(patches, k), middle = 2u * (params.cornerCount + patch_);
        const vec4 skyMean = readVec4(sky, patch_), indirectMean = readVec4(indirect, patch_);
        skyLeast = min(skyLeast, skyMean);
        indirectLeast = min(indirectLeast, indirectMean);
        skyMove += params.round == 0u ? skyMean : 0.5 * (readVec4(before, middle) - skyMean);
        indirectMove += params.round == 0u ? indirectMean : 0.5 * (readVec4(before, middle + 1u) - indirectMean);
    }
    const vec4 skyFrom = params.round == 0u ? vec4(0.0) : values[2u * i];
    const vec4 indirectFrom = params.round == 0u ? vec4(0.0) : values[2u * i + 1u];
    values[2u * i] = clamp(skyFrom + share * skyMove, vec4(0.0), kSmoothLimit * max(skyLeast, 0.0));
    values[2u * i + 1u] = clamp(indirectFrom + share * indirectMove, vec4(0.0), kSmoothLimit * max(indirectLeast, 0.0));
}
