// SPDX-License-Identifier: Apache-2.0
// Irradiance downwards, unchanged, one level of the tree a dispatch: E_child += E_parent.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/records.h"
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"

layout(local_size_x = kSolveGroup) in;
layout(set = 0, binding = kPushParents, scalar) readonly buffer Parents { uint parents[]; };
layout(set = 0, binding = kPushValues, scalar) buffer Values { vec4 values[]; };
layout(push_constant, scalar) uniform Params { LevelParams params; };

void main()
{
    const uint k = globalIndex(kSolveGroup);
    if (k >= params.count) return;
    const uint node = params.first + k;
    const uint parent = parents[node];
    if (parent != kNone) values[node] += values[parent];
}
