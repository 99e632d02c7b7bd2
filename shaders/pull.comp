// SPDX-License-Identifier: Apache-2.0
// Area-weighted means upwards, one level of the tree a dispatch: X_parent = sum A_child X_child / A_parent; HELIO_LINEAR: and
// the slopes of the parent, in its own slope coordinates. Children are summed in their order, so the same input gives the
// same bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/records.h"
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"

layout(local_size_x = kSolveGroup) in;
layout(set = 0, binding = kPullRows, scalar) readonly buffer Rows { uint childRows[]; };
layout(set = 0, binding = kPullChildren, scalar) readonly buffer Children { ChildRecord children[]; };
layout(set = 0, binding = kPullValues, scalar) buffer Values { vec4 values[]; };
#ifdef HELIO_LINEAR
layout(set = 0, binding = kPullChildSlopes, scalar) readonly buffer ChildSlopes { ChildSlopeRecord childSlopes[]; };
layout(set = 0, binding = kPullSlopes, scalar) buffer Slopes { vec4 slopes[]; };
#endif
layout(push_constant, scalar) uniform Params { LevelParams params; };

void main()
{
    const uint k = globalIndex(kSolveGroup);
    if (k >= params.count) return;
    const uint node = params.first + k;
    const uint row = node - params.patchCount;
    vec4 sum = vec4(0.0);
#ifdef HELIO_LINEAR
    vec4 slopeX = vec4(0.0), slopeY = vec4(0.0);
    for (uint c = childRows[row]; c < childRows[row + 1u]; ++c) {
        const uint child = children[c].node;
        const vec4 part = children[c].weight * values[child];
        const ChildSlopeRecord s = childSlopes[c];
        sum += part;
        slopeX += s.offsetX * part;
        slopeY += s.offsetY * part;
        if (child < params.patchCount) continue;
        const uint inner = 2u * (child - params.patchCount);
        const vec4 partX = children[c].weight * slopes[inner], partY = children[c].weight * slopes[inner + 1u];
        slopeX += s.xx * partX + s.xy * partY;
        slopeY += s.yx * partX + s.yy * partY;
    }
    slopes[2u * row] = slopeX;
    slopes[2u * row + 1u] = slopeY;
#else
    for (uint c = childRows[row]; c < childRows[row + 1u]; ++c) sum += children[c].weight * values[children[c].node];
#endif
    values[node] = sum;
}
