// SPDX-License-Identifier: Apache-2.0
// Stage 2: E_sun = DNI cos(theta) V. V is the patch's own ratio of seen to unoccluded area when the raster has samples
// enough to judge it, else the ratio of its smallest ancestor that has: a patch that the raster missed is unknown, not dark.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "shaders/shared/records.h"
#include "shaders/shared/sun.h"
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/fetch.glsl"

layout(local_size_x = kSunGroup) in;
HELIO_READS_VEC4(planes, kSunPlanes)
HELIO_READS_VEC4(density, kSunDensity)
HELIO_READS_UVEC2(nodes, kSunNodes)
layout(set = 0, binding = kSunIrradiance, scalar) writeonly buffer Irradiance { vec4 irradiance[]; };
layout(set = 0, binding = kSunTally, scalar) buffer Tally { SunTallyRecord tally; };
layout(push_constant, scalar) uniform Params { SunEnergyParams params; };

uint countLanes(bool which) { return subgroupBallotBitCount(subgroupBallot(which)); }

void main()
{
    const uint i = globalIndex(kSunGroup);
    const bool exists = i < params.patchCount;
    const vec2 own = exists ? readVec4(density, i).xy : vec2(0.0);
    const bool lit = own.y > 0.0 && params.dni != vec4(0.0);
    vec2 judged = own;
    uint node = i;
    bool enough = !lit || own.y >= params.minCosine && own.y * readVec4(planes, i).w >= params.minSamples * params.texelArea;
    const bool flagged = !enough;
    while (!enough) {
        node = readUvec2(nodes, node).x;
        if (node == kNone) break;
        judged = readVec4(density, node).xy;
        enough = judged.y * uintBitsToFloat(readUvec2(nodes, node).y) >= params.minSamples * params.texelArea;
    }
    // On edge the raster sees nothing of a patch but strays along its border.
    const float ratio = lit && (enough || own.y >= params.discRadius) ? judged.x / judged.y : 0.0;
    if (exists) irradiance[i] = params.dni * (own.y * min(ratio, 1.0));

    const uint litLanes = countLanes(lit), flaggedLanes = countLanes(flagged);
    const uint excessLanes = countLanes(lit && !flagged && ratio > 1.0);
    if (!subgroupElect()) return;
    if (litLanes > 0u) atomicAdd(tally.lit, litLanes);
    if (flaggedLanes > 0u) atomicAdd(tally.flagged, flaggedLanes);
    if (excessLanes > 0u) atomicAdd(tally.excess, excessLanes);
}
