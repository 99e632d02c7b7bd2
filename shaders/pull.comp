// SPDX-License-Identifier: Apache-2.0
// Area-weighted means upwards, one level of the tree a dispatch: X_parent = sum A_child X_child / A_parent. Children are
// summed in their order, so the same input gives the same bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"

layout(local_size_x = kSolveGroup) in;
layout(set = 0, binding = kPullRows, scalar) readonly buffer Rows { uint childRows[]; };
layout(set = 0, binding = kPullChildren, scalar) readonly buffer Children { ChildRecord children[]; };
layout(set = 0, binding = kPullValues, scalar) buffer Values { vec4 values[]; };
layout(push_constant, scalar) uniform Params { LevelParams params; };

void main()
{
    const uint k = globalIndex(kSolveGroup);
    if (k >= params.count) return;
    const uint node = params.first + k;
    const uint row = node - params.patchCount;
    vec4 sum = vec4(0.0);
    for (uint c = childRows[row]; c < childRows[row + 1u]; ++c) sum += children[c].weight * values[children[c].node];
    values[node] = sum;
}
