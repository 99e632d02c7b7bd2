// SPDX-License-Identifier: Apache-2.0
// Stage 4: radiance to display. Each sample is tone mapped by itself, then averaged, so that edges against bright light stay
// smooth. The curve is Hable's filmic one (Uncharted 2, GDC 2010) with its published constants, white at 8.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/view.h"

layout(local_size_x = kToneGroup, local_size_y = kToneGroup) in;
layout(set = 0, binding = kToneInput) uniform sampler2D radiance;
layout(set = 0, binding = kToneOutput, rgba8) uniform writeonly image2D display;
layout(push_constant, scalar) uniform Params { ToneParams params; };
// Constants, since software devices walk through every branch that they could take.
layout(constant_id = 0) const uint kMode = kModeFinal;
layout(constant_id = 1) const uint kSamples = 1u; // texels of the input a pixel, in x and in y

vec3 filmic(vec3 x) { return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3; }

// From dark blue over violet and orange to pale yellow, rising in lightness (engine/view/legend.cpp draws the same).
vec3 falseColour(float x)
{
    const vec3 stops[5] = vec3[](vec3(0.02, 0.02, 0.12), vec3(0.17, 0.03, 0.34), vec3(0.60, 0.09, 0.20), vec3(0.93, 0.42, 0.06),
                                 vec3(0.98, 0.93, 0.55));
    const float at = clamp(x, 0.0, 1.0) * 4.0;
    const int k = min(int(at), 3);
    return mix(stops[k], stops[k + 1], at - float(k));
}

vec3 displayOf(vec4 value)
{
    if (kMode == kModeFinal) return filmic(2.0 * params.exposure * value.rgb) / filmic(vec3(8.0));
    if (kMode == kModeId) return value.rgb;
    if (kMode == kModeDepth) return value.a < 0.0 ? vec3(0.0) : vec3(params.scale / (params.scale + value.r));
    if (kMode >= kModeLevel) return value.a < 0.0 ? vec3(0.0) : falseColour(value.r / params.scale);
    return value.rgb / params.scale;
}

vec3 srgb(vec3 linear)
{
    const vec3 x = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

void main()
{
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= params.width || at.y >= params.height) return;
    vec3 sum = vec3(0.0);
    for (uint y = 0u; y < kSamples; ++y)
        for (uint x = 0u; x < kSamples; ++x)
            sum += clamp(displayOf(texelFetch(radiance, ivec2(at * kSamples + uvec2(x, y)), 0)), 0.0, 1.0);
    imageStore(display, ivec2(at), vec4(srgb(sum / float(kSamples * kSamples)), 1.0));
}
