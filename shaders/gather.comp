// SPDX-License-Identifier: Apache-2.0
// Gather through storage buffers: for devices whose texel buffers are too small.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/solve.h"
#include "shaders/lib/dispatch.glsl"

layout(set = 0, binding = kGatherLinks, scalar) readonly buffer Links { uvec4 links[]; };
layout(set = 0, binding = kGatherRadiosity, scalar) readonly buffer Radiosity { vec4 radiosity[]; };
uvec4 fetchLinks(uint record) { return links[record]; }
vec4 fetchRadiosity(uint node) { return radiosity[node]; }
#ifdef HELIO_LINEAR
layout(set = 0, binding = kGatherSlopes, scalar) readonly buffer Slopes { vec4 slopes[]; };
vec4 fetchSlope(uint index) { return slopes[index]; }
#endif
#include "shaders/lib/gather.glsl"
