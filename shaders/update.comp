// SPDX-License-Identifier: Apache-2.0
// Stage 3: B = B0 + rho E at the patches, with this group's part of the residual ||B_new - B|| / ||B_new - B0||. Lanes sum
// their patches in order and a fixed tree sums the lanes: no float atomics, the same bits every time. HELIO_CHEBYSHEV: the
// new B leans away from the one before the last; the residual is that of B as ever.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/records.h"
#include "shaders/shared/solve.h"

layout(local_size_x = kSolveGroup) in;
layout(set = 0, binding = kUpdatePatches, scalar) readonly buffer Patches { PatchRecord patches[]; };
layout(set = 0, binding = kUpdateB0, scalar) readonly buffer FirstLight { vec4 b0[]; };
layout(set = 0, binding = kUpdateIrradiance, scalar) readonly buffer Irradiance { vec4 irradiance[]; };
layout(set = 0, binding = kUpdateRadiosity, scalar) buffer Radiosity { vec4 radiosity[]; };
layout(set = 0, binding = kUpdatePartials, scalar) writeonly buffer Partials { ResidualRecord partials[]; };
#ifdef HELIO_CHEBYSHEV
layout(set = 0, binding = kUpdateBefore, scalar) buffer Before { vec4 before[]; };
#endif
layout(push_constant, scalar) uniform Params { UpdateParams params; };

shared vec4 change[kSolveGroup];
shared vec4 scale[kSolveGroup];
shared vec4 total[kSolveGroup];
shared vec4 largest[kSolveGroup];

void main()
{
    const uint lane = gl_LocalInvocationID.x;
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    vec4 c = vec4(0.0), s = vec4(0.0), t = vec4(0.0), m = vec4(0.0);
    for (uint k = 0u; k < kUpdateRun; ++k) {
        const uint i = (group * kUpdateRun + k) * kSolveGroup + lane;
        if (i >= params.patchCount) break;
        const float area = patches[i].area;
        const vec4 added = patches[i].rho * irradiance[i];
        const vec4 next = b0[i] + added;
        const vec4 step = next - radiosity[i];
        c += area * step * step;
        s += area * added * added;
        t += area * next;
        m = max(m, abs(step));
#ifdef HELIO_CHEBYSHEV
        // Where the weight is 1 what `before` holds is nobody's radiosity yet.
        const vec4 last = before[i];
        before[i] = radiosity[i];
        radiosity[i] = mix(next, last + params.weight * (next - last), greaterThan(params.weight, vec4(1.0)));
#else
        radiosity[i] = next;
#endif
    }
    change[lane] = c;
    scale[lane] = s;
    total[lane] = t;
    largest[lane] = m;
    for (uint width = kSolveGroup / 2u; width > 0u; width /= 2u) {
        barrier();
        if (lane < width) {
            change[lane] += change[lane + width];
            scale[lane] += scale[lane + width];
            total[lane] += total[lane + width];
            largest[lane] = max(largest[lane], largest[lane + width]);
        }
    }
    if (lane == 0u && group * kUpdateRun * kSolveGroup < params.patchCount)
        partials[group] = ResidualRecord(change[0], scale[0], total[0], largest[0]);
}
