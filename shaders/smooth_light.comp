// SPDX-License-Identifier: Apache-2.0
// Stage 4, option: E_sky and E_indirect at a corner of the static mesh, the mean over the coplanar patches that meet there.
// For pictures; tables use the raw values.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"

layout(local_size_x = kSolveGroup) in;
layout(set = 0, binding = kSmoothRows, scalar) readonly buffer Rows { uint rows[]; };
layout(set = 0, binding = kSmoothPatches, scalar) readonly buffer Patches { uint patches[]; };
layout(set = 0, binding = kSmoothSky, scalar) readonly buffer Sky { vec4 sky[]; };
layout(set = 0, binding = kSmoothIndirect, scalar) readonly buffer Indirect { vec4 indirect[]; };
layout(set = 0, binding = kSmoothValues, scalar) writeonly buffer Values { vec4 values[]; };
layout(push_constant, scalar) uniform Params { SmoothParams params; };

void main()
{
    const uint i = globalIndex(kSolveGroup);
    if (i >= params.cornerCount) return;
    vec4 skySum = vec4(0.0), indirectSum = vec4(0.0);
    for (uint k = rows[i]; k < rows[i + 1u]; ++k) {
        skySum += sky[patches[k]];
        indirectSum += indirect[patches[k]];
    }
    const float share = 1.0 / float(max(rows[i + 1u] - rows[i], 1u));
    values[2u * i] = skySum * share;
    values[2u * i + 1u] = indirectSum * share;
}
