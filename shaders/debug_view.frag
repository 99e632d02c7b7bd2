// SPDX-License-Identifier: Apache-2.0
// Stage 4: views that show what a surface is, or a quantity of its patch, and need no light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/records.h"
#include "shaders/shared/view.h"
#include "shaders/lib/fetch.glsl"
#include "shaders/lib/view.glsl"
#include "shaders/lib/distance.glsl"

layout(constant_id = 0) const uint kMode = kModeId;
HELIO_READS_VEC4(shown, kForwardShown)
layout(location = 2) flat in vec3 vAlbedo;
layout(location = 3) flat in uint vPatch;
layout(location = 0) out vec4 oShown;

vec3 hashColour(uint id)
{
    uint h = (id ^ (id >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    h ^= h >> 16;
    return 0.15 + 0.85 * vec3(h & 255u, (h >> 8) & 255u, (h >> 16) & 255u) / 255.0;
}

void main()
{
    if (kMode == kModeId) {
        oShown = vec4(hashColour(vPatch), float(vPatch));
    } else if (kMode == kModeDepth) {
        oShown = vec4(distanceOf());
    } else if (kMode == kModeAlbedo) {
        oShown = vec4(vAlbedo, 1.0);
    } else if (kMode >= kModeLevel) {
        oShown = vec4(readVec4(shown, vPatch).rgb, 1.0);
    } else {
        oShown = readVec4(shown, vPatch);
    }
}
