// SPDX-License-Identifier: Apache-2.0
// Stage 4: forward shading and tone mapping. Bindings and parameters.
#ifndef HELIO_VIEW_H
#define HELIO_VIEW_H
#include "interop.h"

HELIO_SHARED_BEGIN

// What a pixel shows.
HELIO_CONSTANT uint kModeFinal = 0u;
HELIO_CONSTANT uint kModeId = 1u;
HELIO_CONSTANT uint kModeDepth = 2u;
HELIO_CONSTANT uint kModeSunVisibility = 3u;
HELIO_CONSTANT uint kModeSun = 4u;
HELIO_CONSTANT uint kModeSky = 5u;
HELIO_CONSTANT uint kModeIndirect = 6u;
HELIO_CONSTANT uint kModeRadiosity = 7u;

HELIO_CONSTANT uint kForwardView = 0u;     // ViewRecord
HELIO_CONSTANT uint kForwardShadow = 1u;   // depth array with comparison
HELIO_CONSTANT uint kForwardPatches = 2u;
HELIO_CONSTANT uint kForwardSun = 3u;
HELIO_CONSTANT uint kForwardSky = 4u;
HELIO_CONSTANT uint kForwardIndirect = 5u;
HELIO_CONSTANT uint kForwardRadiosity = 6u;
HELIO_CONSTANT uint kForwardCorners = 7u;  // corner of each vertex of the static mesh
HELIO_CONSTANT uint kForwardSmooth = 8u;   // smooth_light's values

struct ViewRecord {
    mat4 clipFromWorld;    // reversed depth: 1 at the near plane, 0 at infinity
    mat4 worldFromClip;
    mat4 sunFromWorld;     // light space: x, y in grid units (view = integer part), z = depth 0..1
    vec4 eye;              // m; w = sharpness of the haze, 1/m
    vec4 sunDirection;     // unit, towards the sun; w = 1 when the sun is up
    vec4 dni;              // W/m2
    vec4 sunTint;          // display only; 1 for linear output
    vec4 skyTint;          // display only
    vec4 zenith;           // radiance of the picture's sky, W/m2/sr; display only
    vec4 horizon;
    vec4 glow;             // radiance added around the sun
    vec2 gridSize;         // views in x and y
    vec2 shadowTexel;      // m, of the sun raster
    vec2 shadowSize;       // texels of one view
    float depthRange;      // m of light space from depth 0 to 1
    float emissionScale;
    uint mode;             // kMode...
    uint smoothLight;      // 1: interpolate E_sky and E_indirect over the static mesh
    uint patchCount;
    uint staticVertexCount;
};
HELIO_SIZE(ViewRecord, 368);

// tone: kToneSamples x kToneSamples samples a pixel, tone mapped each, averaged, sRGB
HELIO_CONSTANT uint kToneGroup = 8u;
HELIO_CONSTANT uint kToneInput = 0u;       // radiance image
HELIO_CONSTANT uint kToneOutput = 1u;      // rgba8 image
struct ToneParams {        // push constant
    uint width;            // of the output
    uint height;
    uint samples;          // input texels a pixel, in x and in y
    uint mode;             // kMode...
    float exposure;        // display scale of a radiance: 1 / (W/m2/sr)
    float scale;           // false colour: value shown as white
};
HELIO_SIZE(ToneParams, 24);

HELIO_SHARED_END
#endif
