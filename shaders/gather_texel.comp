// SPDX-License-Identifier: Apache-2.0
// Gather through texel buffers: one vector fetch a pair of links and one a sender, 2 to 5 times faster than storage buffers on
// software devices, where storage loads run lane by lane.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"

layout(set = 0, binding = kGatherLinks) uniform utextureBuffer links;
layout(set = 0, binding = kGatherRadiosity) uniform textureBuffer radiosity;
uvec4 fetchLinks(uint record) { return texelFetch(links, int(record)); }
vec4 fetchRadiosity(uint node) { return texelFetch(radiosity, int(node)); }
#ifdef HELIO_LINEAR
layout(set = 0, binding = kGatherSlopes) uniform textureBuffer slopes;
vec4 fetchSlope(uint index) { return texelFetch(slopes, int(index)); }
#endif
#include "shaders/lib/gather.glsl"
