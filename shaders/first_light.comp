// SPDX-License-Identifier: Apache-2.0
// B0 = emission + rho (E_sun + E_sky), and the radiosity that the sweeps start from: B0 + rho E_indirect of the last solve.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/records.h"
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"

layout(local_size_x = kSolveGroup) in;
layout(set = 0, binding = kFirstPatches, scalar) readonly buffer Patches { PatchRecord patches[]; };
layout(set = 0, binding = kFirstSun, scalar) readonly buffer Sun { vec4 sun[]; };
layout(set = 0, binding = kFirstSky, scalar) readonly buffer Sky { vec4 sky[]; };
layout(set = 0, binding = kFirstIndirect, scalar) readonly buffer Indirect { vec4 indirect[]; };
layout(set = 0, binding = kFirstB0, scalar) writeonly buffer FirstLight { vec4 b0[]; };
layout(set = 0, binding = kFirstRadiosity, scalar) writeonly buffer Radiosity { vec4 radiosity[]; };
layout(push_constant, scalar) uniform Params { FirstLightParams params; };

void main()
{
    const uint i = globalIndex(kSolveGroup);
    if (i >= params.patchCount) return;
    const vec4 first = params.emissionScale * patches[i].emission + patches[i].rho * (sun[i] + sky[i]);
    const vec4 last = params.indirectScale > 0.0 ? params.indirectScale * indirect[i] : vec4(0.0);
    b0[i] = first;
    radiosity[i] = first + patches[i].rho * last;
}
