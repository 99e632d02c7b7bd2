// SPDX-License-Identifier: Apache-2.0
// Area-weighted means upwards, one level of the tree a dispatch: X_parent = sum A_child X_child / A_parent; with linear senders
// also the slopes of the parent, in its own slope coordinates. Children are summed in their order, so the same input gives the
// same bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/records.h"
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/fetch.glsl"
#include "shaders/lib/senders.glsl"

layout(constant_id = 0) const bool kSlopes = false;
layout(local_size_x = kSolveGroup) in;
HELIO_READS_UINT(childRows, kPullRows)
HELIO_READS_UVEC4(children, kPullChildren)
HELIO_READS_VEC4(turns, kPullTurns)
HELIO_READS_UVEC4(values, kPullValues)
layout(set = 0, binding = kPullOut, scalar) writeonly buffer Out { uvec4 pulled[]; };
layout(push_constant, scalar) uniform Params { PullParams params; };

void main()
{
    const uint k = globalIndex(kSolveGroup);
    if (k >= params.count) return;
    const uint row = params.first + k - params.patchCount;
    const uint end = readUint(childRows, row + 1u);
    precise vec4 sum = vec4(0.0), x = vec4(0.0), y = vec4(0.0); // the same bits however the arrays are read
    for (uint c = readUint(childRows, row); c < end; ++c) {
        const uvec4 child = readUvec4(children, c);
        const bool isPatch = child.x < params.patchCount;
        const uint at = isPatch ? child.x : params.patchCount + params.stride * (child.x - params.patchCount);
        const vec4 part = uintBitsToFloat(child.y) * uintBitsToFloat(readUvec4(values, at));
        sum += part;
        if (kSlopes) {
            x += uintBitsToFloat(child.z) * part;
            y += uintBitsToFloat(child.w) * part;
            if (isPatch) continue;
            const vec4 turn = readVec4(turns, c);
            const uvec4 slopes = readUvec4(values, at + 1u);
            const vec4 partX = part * slopeX(slopes), partY = part * slopeY(slopes);
            x += turn.x * partX + turn.y * partY;
            y += turn.z * partX + turn.w * partY;
        }
    }
    const uint to = params.patchCount + params.stride * row;
    pulled[to] = floatBitsToUint(sum);
    if (kSlopes) {
        // Without light there is no slope either.
        const vec4 share = mix(vec4(0.0), 1.0 / sum, greaterThan(sum, vec4(kDarkest)));
        pulled[to + 1u] = packSlopes(share * x, share * y);
    }
}
