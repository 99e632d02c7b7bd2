// SPDX-License-Identifier: Apache-2.0
// E_sky = pi sum factor (L + slope . offset) over the sky patches that a patch sees, L being linear across each and the offset
// the middle of what the patch sees of it; once a sky change, never part of the sweeps.
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
layout(set = 0, binding = kSkyRadiance, scalar) readonly buffer Radiance { SkyRadianceRecord radiance[]; };
layout(set = 0, binding = kSkyIrradiance, scalar) writeonly buffer Irradiance { vec4 irradiance[]; };
layout(set = 0, binding = kSkyOffsets, scalar) readonly buffer Offsets { uint offsets[]; };
layout(push_constant, scalar) uniform Params { SkyParams params; };

void main()
{
    const uint i = globalIndex(kSolveGroup);
    if (i >= params.patchCount) return;
    vec4 sum = vec4(0.0);
    for (uint k = rows[i]; k < rows[i + 1u]; ++k) {
        const uint column = columns[k];
        vec4 seen = radiance[column].mean;
        if (params.hasOffsets != 0u) seen += 0.5 * dot(radiance[column].slope, unpackSnorm2x16(offsets[k]));
        sum += factors[k] * seen;
    }
    irradiance[i] = kPi * sum;
}
