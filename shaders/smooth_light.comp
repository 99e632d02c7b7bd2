// SPDX-License-Identifier: Apache-2.0
// Stage 4, option: E_sky and E_indirect at a corner of the static mesh, the mean over the coplanar patches that meet there.
// For pictures; tables use the raw values.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/fetch.glsl"

layout(local_size_x = kSolveGroup) in;
HELIO_READS_UINT(rows, kSmoothRows)
HELIO_READS_UINT(patches, kSmoothPatches)
HELIO_READS_VEC4(sky, kSmoothSky)
HELIO_READS_VEC4(indirect, kSmoothIndirect)
layout(set = 0, binding = kSmoothValues, scalar) writeonly buffer Values { vec4 values[]; };
layout(push_constant, scalar) uniform Params { SmoothParams params; };

void main()
{
    const uint i = globalIndex(kSolveGroup);
    if (i >= params.cornerCount) return;
    vec4 skySum = vec4(0.0), indirectSum = vec4(0.0);
    const uint begin = readUint(rows, i), end = readUint(rows, i + 1u);
    for (uint k = begin; k < end; ++k) {
        const uint patch_ = readUint(patches, k);
        skySum += readVec4(sky, patch_);
        indirectSum += readVec4(indirect, patch_);
    }
    const float share = 1.0 / float(max(end - begin, 1u));
    values[2u * i] = skySum * share;
    values[2u * i + 1u] = indirectSum * share;
}
