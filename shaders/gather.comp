// SPDX-License-Identifier: Apache-2.0
// Stage 3: the light that arrives at each node over its own links and comes down from its ancestors, E_i = E_parent + sum F_ij
// B_j + M_ij . slope_j; one dispatch a level of the tree, downwards. One thread a receiver, links in the order of the row and
// no atomics, so the same input gives the same bits. HELIO_UPDATE, for the level of the patches: and B = B0 + rho E.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/records.h"
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/fetch.glsl"
#include "shaders/lib/senders.glsl"

layout(constant_id = 1) const uint kFactorBits = kMinFactorBits;
layout(local_size_x = kSolveGroup) in;
HELIO_READS_UVEC2(rows, kGatherRows)
HELIO_READS_UVEC4(strips, kGatherStrips)
HELIO_READS_UVEC4(links, kGatherLinks)
HELIO_READS_UVEC2(moments, kGatherMoments)
HELIO_READS_UVEC4(senders, kGatherSenders)
HELIO_READS_VEC4(parents, kGatherParents)
layout(set = 0, binding = kGatherIrradiance, scalar) writeonly buffer Irradiance { vec4 irradiance[]; };
#ifdef HELIO_UPDATE
HELIO_READS_VEC4(reflectance, kGatherReflectance)
HELIO_READS_VEC4(b0, kGatherB0)
HELIO_READS_VEC4(before, kGatherBefore)
layout(set = 0, binding = kGatherOut, scalar) writeonly buffer Out { vec4 updated[]; };
layout(constant_id = 0) const bool kChebyshev = false;
#endif
layout(push_constant, scalar) uniform Params { GatherParams params; };

float factorOf(uint link)
{
    return kFactorScale * uintBitsToFloat(link << (kMaxFactorBits - kFactorBits) & (1u << kMaxFactorBits) - 1u);
}

vec4 meanOf(uint at) { return uintBitsToFloat(readUvec4(senders, at)); }

vec4 fromPatch(uint link, uint base)
{
    precise vec4 light = factorOf(link) * meanOf(base + (link >> kFactorBits));
    return light;
}

// moment: the link's two bytes in its upper half.
vec4 fromInner(uint link, uint base, uint moment)
{
    const uint at = base + (link >> kFactorBits << params.stride - 1u); // the stride is 1 or 2
    const vec2 part = vec2(int(moment << 8) >> 24, int(moment) >> 24) * (kMomentLimit / 127.0);
    const uvec4 slopes = readUvec4(senders, at + 1u);
    const vec4 mean = meanOf(at);
    precise vec4 light = factorOf(link) * (mean + mean * (part.x * slopeX(slopes) + part.y * slopeY(slopes)));
    return light;
}

void main()
{
    const uint k = globalIndex(kSolveGroup);
    if (k >= params.rowCount) return;
    const uint row = params.rowFirst + k, strip = row / kStripRows;
    const uvec4 places = readUvec4(strips, 2u * strip), counts = readUvec4(strips, 2u * strip + 1u);
    uint at = places.x - params.recordFirst + row % kStripRows;
    precise vec4 sum = vec4(0.0);
    for (uint n = 0u; n < counts.x; ++n) {
        const uvec4 quad = readUvec4(links, at);
        sum += fromPatch(quad.x, places.z);
        sum += fromPatch(quad.y, places.z);
        sum += fromPatch(quad.z, places.z);
        sum += fromPatch(quad.w, places.z);
        at += kStripRows;
    }
    const uint inner = params.patchCount + params.stride * places.w;
    uint momentAt = places.y - params.momentFirst + row % kStripRows;
    for (uint n = 0u; n < counts.y; ++n) {
        const uvec4 quad = readUvec4(links, at);
        const uvec2 bytes = readUvec2(moments, momentAt);
        sum += fromInner(quad.x, inner, bytes.x << 16);
        sum += fromInner(quad.y, inner, bytes.x);
        sum += fromInner(quad.z, inner, bytes.y << 16);
        sum += fromInner(quad.w, inner, bytes.y);
        at += kStripRows;
        momentAt += kStripRows;
    }
    for (uint n = 0u; n < counts.z; ++n) {
        const uvec4 link = readUvec4(links, at);
        const bool isPatch = link.x < params.patchCount;
        const uint sender = isPatch ? link.x : params.patchCount + params.stride * (link.x - params.patchCount);
        const vec4 mean = meanOf(sender);
        sum += uintBitsToFloat(link.y) * mean;
        if ((link.z | link.w) != 0u) {
            const uvec4 slopes = readUvec4(senders, sender + 1u);
            sum += mean * (uintBitsToFloat(link.z) * slopeX(slopes) + uintBitsToFloat(link.w) * slopeY(slopes));
        }
        at += kStripRows;
    }
    const uvec2 receiver = readUvec2(rows, row);
    if (receiver.x == kNone) return;
    sum *= params.scale;
    if (receiver.y != kNone) sum += readVec4(parents, receiver.y);
    irradiance[receiver.x] = sum;
#ifdef HELIO_UPDATE
    precise vec4 next = readVec4(b0, receiver.x) + readVec4(reflectance, receiver.x) * sum;
    if (kChebyshev) {
        // Where the weight is 1 what lies there is nobody's radiosity yet.
        const vec4 last = readVec4(before, receiver.x);
        next = mix(next, last + params.weight * (next - last), greaterThan(params.weight, vec4(1.0)));
    }
    updated[receiver.x] = next;
#endif
}
