// SPDX-License-Identifier: Apache-2.0
// Stage 4: what a picture adds to the sun's direct light on a patch: E_sky, in the colour of the picture's sky, and
// E_indirect.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/fetch.glsl"

layout(local_size_x = kSolveGroup) in;
HELIO_READS_VEC4(sky, kSoftSky)
HELIO_READS_VEC4(indirect, kSoftIndirect)
layout(set = 0, binding = kSoftLight, scalar) writeonly buffer Light { vec4 light[]; };
layout(push_constant, scalar) uniform Params { SoftLightParams params; };

void main()
{
    const uint i = globalIndex(kSolveGroup);
    if (i < params.patchCount) light[i] = params.skyTint * readVec4(sky, i) + readVec4(indirect, i);
}
