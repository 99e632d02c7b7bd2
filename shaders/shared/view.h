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
HELIO_CONSTANT uint kModeAlbedo = 8u;
// A number a patch, in false colour.
HELIO_CONSTANT uint kModeLevel = 9u;       // ancestors in the tree
HELIO_CONSTANT uint kModeLinks = 10u;      // form factor from a picked patch, a square metre
HELIO_CONSTANT uint kModeResidual = 11u;   // what the last sweep changed of B, W/m2
HELIO_CONSTANT uint kModeError = 12u;      // expected error of E_indirect, W/m2

HELIO_CONSTANT uint kForwardView = 0u;     // ViewRecord
HELIO_CONSTANT uint kForwardShadow = 1u;   // depth array of the sun raster; of lit views alone: final and sun visibility
HELIO_CONSTANT uint kForwardShown = 2u;    // vec4 a patch: of lit views the emission, of others what they show
HELIO_CONSTANT uint kForwardLight = 3u;    // soft light: of the patches, or the values of smooth_fans and its kin
HELIO_CONSTANT uint kForwardValueOf = 4u;  // which of these values a vertex of the smooth mesh takes

// Push constant of the city's passes: what every vertex and every pixel needs. Software devices read a word of a storage
// buffer lane by lane, a push constant once.
struct ForwardParams {
    mat4 clipFromWorld;    // reversed depth: 1 at the near plane, 0 at infinity
    vec4 sunRow0;          // place in the sun's picture: texels to the right, texels down, depth; w: of the eye
    vec4 sunRow1;
    vec4 sunRow2;
    vec4 eye;              // m; w = 1 / length of the haze, 1/m
};
HELIO_SIZE(ForwardParams, 128);

// The rest of what one picture needs.
struct ViewRecord {
    mat4 worldFromClip;
    vec4 sunDirection;     // unit, towards the sun; w = 1 when the sun is up
    vec4 sunLight;         // W/m2: DNI x display tint
    vec4 zenith;           // radiance of the picture's sky, W/m2/sr; display only
    vec4 horizon;          // w = 1 / length of the haze over the ground beyond the scene, 1/m
    vec4 glow;             // radiance added around the sun; w = 1 where panes of glass reflect the sky, display only
    vec4 ground;           // radiance of the ground beyond the scene; w = height of the eye above it, m
    vec4 eye;              // m
    vec2 rayCentre;        // middle of the picture, in its samples
    vec2 gridSize;         // views in x and y
    vec2 shadowStep;       // texel of the sun raster in texture coordinates
    float shadowTexel;     // m
    float sunShear;        // see SunView: added to y a unit of x inside a view
    float depthRange;      // m of light space from depth 0 to 1
    float emissionScale;
    float rayStep;         // m a sample, 1 m before the eye
    float pad0;
};
HELIO_SIZE(ViewRecord, 224);

// tone: samples x samples texels a pixel, tone mapped each, averaged, sRGB
HELIO_CONSTANT uint kToneGroup = 8u;
HELIO_CONSTANT uint kToneInput = 0u;       // radiance image
HELIO_CONSTANT uint kToneOutput = 1u;      // rgba8 image
struct ToneParams {        // push constant
    uint width;            // of the output
    uint height;
    float exposure;        // display scale of a radiance: 1 / (W/m2/sr)
    float scale;           // false colour: value shown as white
};
HELIO_SIZE(ToneParams, 16);

HELIO_SHARED_END
#endif
