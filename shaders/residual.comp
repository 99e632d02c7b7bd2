// SPDX-License-Identifier: Apache-2.0
// Stage 3: sums the partial residuals in a fixed order, one group.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/solve.h"

layout(local_size_x = kResidualGroup) in;
layout(set = 0, binding = kResidualPartials, scalar) readonly buffer Partials { ResidualRecord partials[]; };
layout(set = 0, binding = kResidualResult, scalar) writeonly buffer Result { ResidualRecord result; };
layout(push_constant, scalar) uniform Params { ResidualParams params; };

shared vec4 change[kResidualGroup];
shared vec4 scale[kResidualGroup];
shared vec4 total[kResidualGroup];
shared vec4 largest[kResidualGroup];

void main()
{
    const uint lane = gl_LocalInvocationID.x;
    vec4 c = vec4(0.0), s = vec4(0.0), t = vec4(0.0), m = vec4(0.0);
    for (uint i = lane; i < params.partialCount; i += kResidualGroup) {
        c += partials[i].change;
        s += partials[i].scale;
        t += partials[i].radiosity;
        m = max(m, partials[i].largest);
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
