// SPDX-License-Identifier: Apache-2.0
// Roofline of the gather: 64 independent loads a thread, 16 bytes each, from places that a linear congruence scatters over a
// table of a power of two elements.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/fetch.glsl"

layout(local_size_x = 64) in;
HELIO_READS_VEC4(values, 0)
layout(set = 0, binding = 1, scalar) writeonly buffer Out { vec4 sums[]; };
layout(push_constant, scalar) uniform Params { uint mask; };

void main()
{
    uint at = gl_GlobalInvocationID.x * 747796405u + 2891336453u;
    vec4 sum = vec4(0.0);
    for (uint n = 0u; n < 64u; ++n) {
        at = at * 1664525u + 1013904223u;
        sum += readVec4(values, (at >> 8) & mask);
    }
    sums[gl_GlobalInvocationID.x] = sum;
}
