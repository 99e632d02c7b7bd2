// SPDX-License-Identifier: Apache-2.0
// Stage 1: every surface as the sun sees it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/sun.h"
#include "shaders/lib/mesh.glsl"

layout(constant_id = 0) const bool kGuard = true; // closed surfaces are drawn without their backs and need none
layout(push_constant, scalar) uniform Params { SunRasterParams params; };
layout(location = 0) flat out uint vPatch;
invariant gl_Position;

void main()
{
    vPatch = patchOfVertex();
    gl_Position = params.clipFromWorld * vec4(worldPosition(), 1.0);
    // Along an edge that a lit and an unlit surface share, rounding must not let light in: the unlit one wins.
    if (kGuard && dot(worldNormal(), params.towardsSun.xyz) < 0.0) gl_Position.z -= params.towardsSun.w;
}
