// SPDX-License-Identifier: Apache-2.0
// Stage 2: E_sun = DNI cos(theta) V. V is the patch's own ratio of seen to unoccluded area when the raster has samples
// enough to judge it, else the ratio of its smallest ancestor that has: a patch that the raster missed is unknown, not dark.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/records.h"
#include "shaders/shared/sun.h"
#include "shaders/lib/dispatch.glsl"

layout(local_size_x = kSunGroup) in;
layout(set = 0, binding = kSunPatches, scalar) readonly buffer Patches { PatchRecord patches[]; };
layout(set = 0, binding = kSunDensity, scalar) readonly buffer Density { vec4 density[]; };
layout(set = 0, binding = kSunNodes, scalar) readonly buffer Nodes { NodeRecord nodes[]; };
layout(set = 0, binding = kSunIrradiance, scalar) writeonly buffer Irradiance { vec4 irradiance[]; };
layout(set = 0, binding = kSunTally, scalar) buffer Tally { SunTallyRecord tally; };
layout(push_constant, scalar) uniform Params { SunEnergyParams params; };

void main()
{
    const uint i = globalIndex(kSunGroup);
    if (i >= params.patchCount) return;
    const vec2 own = density[i].xy;
    if (!(own.y > 0.0) || params.dni == vec4(0.0)) {
        irradiance[i] = vec4(0.0);
        return;
    }
    vec2 judged = own;
    float area = patches[i].area;
    uint node = i;
    bool enough = own.y >= params.minCosine && own.y * area >= params.minSamples * params.texelArea;
    const bool flagged = !enough;
    while (!enough && nodes[node].parent != kNone) {
        node = nodes[node].parent;
        judged = density[node].xy;
        area = nodes[node].area;
        enough = judged.y * area >= params.minSamples * params.texelArea;
    }
    // On edge the raster sees nothing of a patch but strays along its border.
    const float ratio = enough || own.y >= params.discRadius ? judged.x / judged.y : 0.0;
    irradiance[i] = params.dni * (own.y * min(ratio, 1.0));
    atomicAdd(tally.lit, 1u);
    if (flagged) atomicAdd(tally.flagged, 1u);
    if (!flagged && ratio > 1.0) atomicAdd(tally.excess, 1u);
}
