// SPDX-License-Identifier: Apache-2.0
// Stage 3: adds up the parts of the residual in a fixed order, one group.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/solve.h"
#include "shaders/lib/fetch.glsl"

layout(local_size_x = kResidualGroup) in;
HELIO_READS_VEC4(parts, kResidualParts)
layout(set = 0, binding = kResidualResult, scalar) writeonly buffer Result { ResidualRecord result; };
layout(push_constant, scalar) uniform Params { CountParams params; };

shared vec4 change[kResidualGroup];
shared vec4 scale[kResidualGroup];
shared vec4 total[kResidualGroup];
shared vec4 largest[kResidualGroup];

void main()
{
    const uint lane = gl_LocalInvocationID.x;
    vec4 c = vec4(0.0), s = vec4(0.0), t = vec4(0.0), m = vec4(0.0);
    for (uint i = lane; i < params.count; i += kResidualGroup) {
        c += readVec4(parts, 4u * i);
        s += readVec4(parts, 4u * i + 1u);
        t += readVec4(parts, 4u * i + 2u);
        m = max(m, readVec4(parts, 4u * i + 3u));
    }
    change[lane] = c;
    scale[lane] = s;
    total[lane] = t;
    largest[lane] = m;
    for (uint width = kResidualGroup / 2u; width > 0u; width /= 2u) {
        barrier();
        if (lane < width) {
            change[lane] += change[lane + width];
            scale[lane] += scale[lane + width];
            total[lane] += total[lane + width];
            largest[lane] = max(largest[lane], largest[lane + width]);
        }
    }
    if (lane == 0u) result = ResidualRecord(change[0], scale[0], total[0], largest[0]);
}
