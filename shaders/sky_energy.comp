// SPDX-License-Identifier: Apache-2.0
// E_sky = pi sum factor L over the sky patches that a patch sees; once a sky change, never part of the sweeps.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"

const float kPi = 3.14159265358979;

layout(local_size_x = kSolveGroup) in;
layout(set = 0, binding = kSkyRows, scalar) readonly buffer Rows { uint rows[]; };
layout(set = 0, binding = kSkyColumns, scalar) readonly buffer Columns { uint columns[]; };
layout(set = 0, binding = kSkyFactors, scalar) readonly buffer Factors { float factors[]; };
layout(set = 0, binding = kSkyRadiance, scalar) readonly buffer Radiance { vec4 radiance[]; };
layout(set = 0, binding = kSkyIrradiance, scalar) writeonly buffer Irradiance { vec4 irradiance[]; };
layout(push_constant, scalar) uniform Params { SkyParams params; };

void main()
{
    const uint i = globalIndex(kSolveGroup);
    if (i >= params.patchCount) return;
    vec4 sum = vec4(0.0);
    for (uint k = rows[i]; k < rows[i + 1u]; ++k) sum += factors[k] * radiance[columns[k]];
    irradiance[i] = kPi * sum;
}
