// SPDX-License-Identifier: Apache-2.0
// Stage 4: the sky behind the city.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/view.h"
#include "shaders/lib/view.glsl"
#include "shaders/lib/sky.glsl"

layout(constant_id = 0) const uint kMode = kModeFinal;
layout(location = 0) in vec2 vClip;
layout(location = 0) out vec4 oRadiance;

void main()
{
    if (kMode == kModeFinal) {
        const vec4 point = view.worldFromClip * vec4(vClip, 0.5, 1.0);
        oRadiance = vec4(backgroundRadiance(normalize(point.xyz / point.w - view.eye.xyz)), 0.0);
    } else {
        oRadiance = vec4(0.0, 0.0, 0.0, kMode == kModeId || kMode == kModeDepth || kMode >= kModeLevel ? -1.0 : 0.0);
    }
}
