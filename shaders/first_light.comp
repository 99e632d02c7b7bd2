// SPDX-License-Identifier: Apache-2.0
// B0 = emission + rho (E_sun + E_sky), and the radiosity that the sweeps start from: B0 + rho E_indirect of the last solve.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/records.h"
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/fetch.glsl"

layout(constant_id = 0) const bool kEmitters = false;
layout(local_size_x = kSolveGroup) in;
HELIO_READS_VEC4(reflectance, kFirstReflectance)
HELIO_READS_VEC4(sun, kFirstSun)
HELIO_READS_VEC4(sky, kFirstSky)
HELIO_READS_VEC4(indirect, kFirstIndirect)
HELIO_READS_VEC4(emission, kFirstEmission)
layout(set = 0, binding = kFirstB0, scalar) writeonly buffer FirstLight { vec4 b0[]; };
layout(set = 0, binding = kFirstSenders, scalar) writeonly buffer Senders { vec4 senders[]; };
layout(push_constant, scalar) uniform Params { FirstLightParams params; };

void main()
{
    const uint i = globalIndex(kSolveGroup);
    if (i >= params.patchCount) return;
    const vec4 rho = readVec4(reflectance, i);
    vec4 first = rho * (readVec4(sun, i) + readVec4(sky, i));
    if (kEmitters) first += params.emissionScale * readVec4(emission, i);
    const vec4 last = params.indirectScale > 0.0 ? params.indirectScale * readVec4(indirect, i) : vec4(0.0);
    b0[i] = first;
    senders[i] = first + rho * last;
}
