// SPDX-License-Identifier: Apache-2.0
// Sky energy and stage 3: bindings, group sizes and parameters of the light solve. Every light quantity is a vec4:
// linear r, g, b and broadband solar, W/m2.
#ifndef HELIO_SOLVE_H
#define HELIO_SOLVE_H
#include "interop.h"

HELIO_SHARED_BEGIN

HELIO_CONSTANT uint kSolveGroup = 64u;

// A child of an inner node, with its share of the parent's area.
struct ChildRecord {
    uint node;
    float weight;          // area of the child / area of the parent
};
HELIO_SIZE(ChildRecord, 8);

// Two links of one row; a row of odd length ends with a link of factor 0.
struct LinkPairRecord {
    uint column0;          // sender node
    uint factor0;          // bits of the float F(receiver to sender) x visibility
    uint column1;
    uint factor1;
};
HELIO_SIZE(LinkPairRecord, 16);

// Linear senders: a row goes on, after the pairs of its links to patches, with a record like this for each link to an inner
// node, in the same array. E += factor B + momentX slopeX + momentY slopeY.
struct LinearLinkRecord {
    uint column;           // sender, an inner node
    float factor;
    float momentX;
    float momentY;
};
HELIO_SIZE(LinearLinkRecord, 16);

// sky_energy: E_sky of each patch
HELIO_CONSTANT uint kSkyRows = 0u;
HELIO_CONSTANT uint kSkyColumns = 1u;
HELIO_CONSTANT uint kSkyFactors = 2u;
HELIO_CONSTANT uint kSkyRadiance = 3u;
HELIO_CONSTANT uint kSkyIrradiance = 4u;
HELIO_CONSTANT uint kSkyOffsets = 5u;
struct SkyParams {         // push constant
    uint patchCount;
    uint hasOffsets;       // 0: sky patches have one radiance each
};
HELIO_SIZE(SkyParams, 8);

// Radiance of a sky patch, W/m2/sr: its mean and its change across the patch, the same in all channels.
struct SkyRadianceRecord {
    vec4 mean;
    vec2 slope;
};
HELIO_SIZE(SkyRadianceRecord, 24);

// first_light: B0 = emission + rho (E_sun + E_sky), B = B0 + rho E_indirect
HELIO_CONSTANT uint kFirstPatches = 0u;
HELIO_CONSTANT uint kFirstSun = 1u;
HELIO_CONSTANT uint kFirstSky = 2u;
HELIO_CONSTANT uint kFirstIndirect = 3u; // nodes
HELIO_CONSTANT uint kFirstB0 = 4u;       // patches
HELIO_CONSTANT uint kFirstRadiosity = 5u; // nodes
struct FirstLightParams {  // push constant
    uint patchCount;
    float emissionScale;   // 1, or 0 without emitters
    float indirectScale;   // 1 for a warm start from the last solution, 0 for a cold one
    uint pad0;
};
HELIO_SIZE(FirstLightParams, 16);

// pull: X_parent = sum weight X_child, one dispatch a level, upwards
HELIO_CONSTANT uint kPullRows = 0u;      // inner nodes: first child, count
HELIO_CONSTANT uint kPullChildren = 1u;
HELIO_CONSTANT uint kPullValues = 2u;
// pull with linear senders: slope_parent = sum weight (offset_child X_child + T_child slope_child)
HELIO_CONSTANT uint kPullChildSlopes = 3u; // ChildSlopeRecord, parallel to the children
HELIO_CONSTANT uint kPullSlopes = 4u;      // vec4 pairs, an inner node
// push: E_child += E_parent, one dispatch a level, downwards
HELIO_CONSTANT uint kPushParents = 0u;
HELIO_CONSTANT uint kPushValues = 1u;
struct LevelParams {       // push constant
    uint first;            // nodes first..first + count - 1
    uint count;
    uint patchCount;
};
HELIO_SIZE(LevelParams, 12);

// gather: E_i = sum factor B_column over the links of row i
HELIO_CONSTANT uint kGatherRows = 0u;    // in records: nodeCount + 1; linear senders: 2 nodeCount + 1
HELIO_CONSTANT uint kGatherLinks = 1u;   // LinkPairRecord (and LinearLinkRecord), from record `recordFirst` on
HELIO_CONSTANT uint kGatherRadiosity = 2u;
HELIO_CONSTANT uint kGatherIrradiance = 3u;
HELIO_CONSTANT uint kGatherSlopes = 4u;  // linear senders: vec4 pairs, an inner node
HELIO_CONSTANT uint kGatherOrder = 5u;   // receiver of each row
struct GatherParams {      // push constant
    uint rowFirst;
    uint rowCount;
    uint recordFirst;      // record that is element 0 of the bound links
    uint patchCount;
};
HELIO_SIZE(GatherParams, 16);

// update: B = B0 + rho E at the patches, and the partial sums of the residual. Chebyshev: B = w (B0 + rho E) + (1 - w)
// B_before, with B_before the radiosity before the last sweep
HELIO_CONSTANT uint kUpdateRun = 16u;    // patches a lane
HELIO_CONSTANT uint kUpdatePatches = 0u;
HELIO_CONSTANT uint kUpdateB0 = 1u;
HELIO_CONSTANT uint kUpdateIrradiance = 2u;
HELIO_CONSTANT uint kUpdateRadiosity = 3u;
HELIO_CONSTANT uint kUpdatePartials = 4u;
HELIO_CONSTANT uint kUpdateBefore = 5u;  // Chebyshev: patches
struct UpdateParams {      // push constant
    vec4 weight;           // Chebyshev: w, >= 1
    uint patchCount;
};
HELIO_SIZE(UpdateParams, 20);

// Area-weighted sums over patches, per channel, with B_new = B0 + rho E. Also the partial sums of one group.
struct ResidualRecord {
    vec4 change;           // sum A (B_new - B)^2: the defect of B
    vec4 scale;            // sum A (B_new - B0)^2
    vec4 radiosity;        // sum A B_new, W
    vec4 largest;          // largest |B_new - B| of a patch, W/m2
};
HELIO_SIZE(ResidualRecord, 64);

// residual: the sum of the partials, in a fixed order
HELIO_CONSTANT uint kResidualGroup = 256u;
HELIO_CONSTANT uint kResidualPartials = 0u;
HELIO_CONSTANT uint kResidualResult = 1u;
struct ResidualParams {    // push constant
    uint partialCount;
};
HELIO_SIZE(ResidualParams, 4);

// smooth_light: E_sky and E_indirect of a corner, from the coplanar patches that meet there
HELIO_CONSTANT uint kSmoothRows = 0u;
HELIO_CONSTANT uint kSmoothPatches = 1u;
HELIO_CONSTANT uint kSmoothSky = 2u;
HELIO_CONSTANT uint kSmoothIndirect = 3u;
HELIO_CONSTANT uint kSmoothValues = 4u;  // vec4 pairs: E_sky, E_indirect
struct SmoothParams {      // push constant
    uint cornerCount;
};
HELIO_SIZE(SmoothParams, 4);

HELIO_SHARED_END
#endif
