// SPDX-License-Identifier: Apache-2.0
// Stages 1 and 2: sun raster, histogram, sun energy. Descriptor bindings, group sizes and parameters.
#ifndef HELIO_SUN_H
#define HELIO_SUN_H
#include "interop.h"

HELIO_SHARED_BEGIN

// Vertex attributes of every mesh pass: binding 0 = VertexRecord, binding 1 = InstanceRecord.
HELIO_CONSTANT uint kAttributePosition = 0u;
HELIO_CONSTANT uint kAttributePatch = 1u;
HELIO_CONSTANT uint kAttributeNormal = 2u;
HELIO_CONSTANT uint kAttributeAlbedo = 3u;
HELIO_CONSTANT uint kAttributeRow0 = 4u;
HELIO_CONSTANT uint kAttributeRow1 = 5u;
HELIO_CONSTANT uint kAttributeRow2 = 6u;
HELIO_CONSTANT uint kAttributeInstancePatch = 7u;

struct SunRasterParams {   // push constant
    mat4 clipFromWorld;    // orthographic view from the sun, one a view of the grid
    vec4 towardsSun;       // unit; w = depth by which surfaces that face away are moved towards the sun
};
HELIO_SIZE(SunRasterParams, 80);

// Histogram: lanes side by side in x, each walks kHistogramRun rows down, kHistogramStep texels at a time.
HELIO_CONSTANT uint kHistogramGroup = 64u;
HELIO_CONSTANT uint kHistogramRun = 64u;
HELIO_CONSTANT uint kHistogramStep = 16u;
HELIO_CONSTANT uint kHistogramIds = 0u;    // binding: r32ui image
HELIO_CONSTANT uint kHistogramCounts = 1u; // binding: one counter a patch
struct HistogramParams {   // push constant
    uint width;            // texels
    uint height;
    uint patchCount;       // ids from here on are not counted
};
HELIO_SIZE(HistogramParams, 12);

HELIO_CONSTANT uint kSunGroup = 64u;
HELIO_CONSTANT uint kSunCounts = 0u;   // bindings of sun_density and sun_energy
HELIO_CONSTANT uint kSunPlanes = 1u;    // a patch: normal and area
HELIO_CONSTANT uint kSunDensity = 2u;
HELIO_CONSTANT uint kSunNodes = 3u;     // a node: parent and area
HELIO_CONSTANT uint kSunIrradiance = 4u;
HELIO_CONSTANT uint kSunTally = 5u;
struct SunEnergyParams {   // push constant
    vec3 direction;        // unit, towards the sun
    float texelArea;       // m2, perpendicular to the sun
    vec4 dni;              // W/m2 a channel, 0 when the sun is below the horizon
    uint patchCount;
    float minSamples;      // texels that a node must be expected to cover to be judged by its own count
    float minCosine;       // a patch that faces the sun less takes an ancestor's ratio
    float discRadius;      // rad, of the sun's disc; 0 = a point
};
HELIO_SIZE(SunEnergyParams, 48);

struct SunTallyRecord {
    uint flagged;          // patches lit by the ratio of an ancestor
    uint excess;           // patches whose own ratio was above 1 and was clamped
    uint lit;              // patches that face the sun
    uint pad0;
};
HELIO_SIZE(SunTallyRecord, 16);

HELIO_SHARED_END
#endif
