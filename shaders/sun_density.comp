// SPDX-License-Identifier: Apache-2.0
// Stage 2: per square metre of each patch, the area that the sun reaches (x) and the area that it would reach alone (y),
// both perpendicular to the sun. The pull over the tree gives the same two for every node.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/records.h"
#include "shaders/shared/disc.h"
#include "shaders/shared/sun.h"
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/fetch.glsl"

layout(local_size_x = kSunGroup) in;
HELIO_READS_UINT(counts, kSunCounts)
HELIO_READS_VEC4(planes, kSunPlanes)
layout(set = 0, binding = kSunDensity, scalar) writeonly buffer Density { vec4 density[]; };
layout(push_constant, scalar) uniform Params { SunEnergyParams params; };

void main()
{
    const uint i = globalIndex(kSunGroup);
    if (i >= params.patchCount) return;
    const vec4 plane = readVec4(planes, i);
    const float cosine = discCosine(dot(plane.xyz, params.direction), params.discRadius);
    vec4 result = vec4(0.0);
    if (cosine > 0.0) result.xy = vec2(float(readUint(counts, i)) * params.texelArea / plane.w, cosine);
    density[i] = result;
}
