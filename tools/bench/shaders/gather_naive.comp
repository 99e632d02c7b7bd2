// SPDX-License-Identifier: Apache-2.0
// The naive gather: CSR rows as the pack has them, one thread a row, all through storage buffers; HELIO_LINEAR: with moments
// and slopes.
#version 460
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Rows { uint rows[]; };
layout(set = 0, binding = 1, scalar) readonly buffer Columns { uint columns[]; };
layout(set = 0, binding = 2, scalar) readonly buffer Factors { float factors[]; };
layout(set = 0, binding = 3, scalar) readonly buffer Radiosity { vec4 radiosity[]; };
layout(set = 0, binding = 4, scalar) writeonly buffer Irradiance { vec4 irradiance[]; };
#ifdef HELIO_LINEAR
layout(set = 0, binding = 5, scalar) readonly buffer Moments { vec2 moments[]; };
layout(set = 0, binding = 6, scalar) readonly buffer Slopes { vec4 slopes[]; };
#endif
layout(push_constant, scalar) uniform Params { uint rowFirst; uint rowCount; };

void main()
{
    const uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x;
    if (index >= rowCount) return;
    const uint row = rowFirst + index;
#ifdef HELIO_LINEAR
    const uint first = rows[rowFirst];
#endif
    vec4 sum = vec4(0.0);
    for (uint k = rows[row]; k < rows[row + 1u]; ++k) {
        const uint column = columns[k];
        sum += factors[k] * radiosity[column];
#ifdef HELIO_LINEAR
        sum += moments[k - first].x * slopes[2u * column] + moments[k - first].y * slopes[2u * column + 1u];
#endif
    }
    irradiance[row] = sum;
}
