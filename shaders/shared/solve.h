// SPDX-License-Identifier: Apache-2.0
// Stage 3 and the sky: bindings, group sizes and parameters of the light solve. Every light quantity is a vec4:
// linear r, g, b and broadband solar, W/m2.
#ifndef HELIO_SOLVE_H
#define HELIO_SOLVE_H
#include "interop.h"

HELIO_SHARED_BEGIN

HELIO_CONSTANT uint kSolveGroup = 64u;

// The light of all senders, one array of 16-byte elements: patch i at i, inner node k (node patchCount + k) from patchCount + k
// x stride on: its mean, four floats, and with linear senders (stride 2, else 1) its two slopes in its own slope coordinates
// over the mean, eight half floats: x r, g, b, solar, y r, g, b, solar (lib/senders.glsl).

HELIO_CONSTANT float kDarkest = 1e-30f;      // W/m2: a mean from here down has no slopes

// A child of an inner node, with its share of the parent's area and its place in the parent (see ChildSlopeRecord).
struct ChildRecord {
    uint node;
    float weight;          // area of the child / area of the parent
    float offsetX;
    float offsetY;
};
HELIO_SIZE(ChildRecord, 16);

// Rows of links lie in strips of kStripRows: record n of row r of a strip at begin + n x kStripRows + r, so that lanes side by
// side read side by side and run equally long (SELL-C-sigma: Kreutzer et al., SIAM J. Sci. Comput. 36, 2014). A row is, in
// this order, records of four links to patches, records of four links to inner nodes, each with a record of moments, and
// single links in full precision: those that the short form cannot hold, or all.
HELIO_CONSTANT uint kStripRows = 8u;
struct StripRecord {
    uint begin;            // of the link records
    uint momentBegin;      // of the moment records
    uint patchBase;        // sender that column 0 means, links to patches
    uint innerBase;        // the same, links to inner nodes, counted from the first inner node
    uint patchRecords;     // a row
    uint innerRecords;     // a row
    uint singleRecords;    // a row
    uint pad0;
};
HELIO_SIZE(StripRecord, 32);

// Where a row goes, and whose irradiance comes down to it.
struct RowRecord {
    uint receiver;         // node; kNone = padding of a strip
    uint parent;           // of the receiver, kNone = none
};
HELIO_SIZE(RowRecord, 8);

// Four links in short form: column << factorBits | factor, the column from its base on. A factor is a float without sign, with
// kExponentBits bits of exponent and the others of mantissa, m: (1 + m) 2^(e - 31), e = 1..31; code 0 is 0. As many bits as the
// columns leave: kMinFactorBits to kMaxFactorBits.
struct LinkQuadRecord {
    uint link0;
    uint link1;
    uint link2;
    uint link3;
};
HELIO_SIZE(LinkQuadRecord, 16);
HELIO_CONSTANT uint kExponentBits = 5u;
HELIO_CONSTANT uint kMinFactorBits = 12u;
HELIO_CONSTANT uint kMaxFactorBits = 28u;    // a float's whole mantissa
HELIO_CONSTANT float kFactorScale = 79228162514264337593543950336.0f; // 2^96: what a code at a float's place is too small by

// Moments of four links, signed bytes x0, y0, x1, y1 and x2, y2, x3, y3: moment = factor x kMomentLimit x byte / 127.
struct MomentQuadRecord {
    uint moments01;
    uint moments23;
};
HELIO_SIZE(MomentQuadRecord, 8);
HELIO_CONSTANT float kMomentLimit = 4.0f;

// One link in full precision: E += factor B + momentX slopeX + momentY slopeY; to a patch: moments 0.
struct LinkSingleRecord {
    uint column;           // sender node
    float factor;
    float momentX;
    float momentY;
};
HELIO_SIZE(LinkSingleRecord, 16);

// first_light: B0 = emission + rho (E_sun + E_sky), B = B0 + rho E_indirect
HELIO_CONSTANT uint kFirstReflectance = 0u;
HELIO_CONSTANT uint kFirstSun = 1u;
HELIO_CONSTANT uint kFirstSky = 2u;
HELIO_CONSTANT uint kFirstIndirect = 3u;     // nodes
HELIO_CONSTANT uint kFirstB0 = 4u;           // patches
HELIO_CONSTANT uint kFirstSenders = 5u;
HELIO_CONSTANT uint kFirstEmission = 6u;
struct FirstLightParams {  // push constant
    uint patchCount;
    float emissionScale;   // 1, or 0 without emitters
    float indirectScale;   // 1 for a warm start from the last solution, 0 for a cold one
    uint pad0;
};
HELIO_SIZE(FirstLightParams, 16);

// pull: X_parent = sum weight X_child, one dispatch a level, upwards; with slopes (stride 2): slope_parent = sum weight
// (offset_child X_child + T_child slope_child)
HELIO_CONSTANT uint kPullRows = 0u;          // inner nodes + 1: first child
HELIO_CONSTANT uint kPullChildren = 1u;      // ChildRecord
HELIO_CONSTANT uint kPullTurns = 2u;         // vec4 a child: T = (x y; z w)
HELIO_CONSTANT uint kPullValues = 3u;        // read
HELIO_CONSTANT uint kPullOut = 4u;           // the same array, written
struct PullParams {        // push constant
    uint first;            // nodes first..first + count - 1
    uint count;
    uint patchCount;
    uint stride;           // of an inner node, 1 or 2
};
HELIO_SIZE(PullParams, 16);

// gather: E_i = E_parent + sum factor B_column over the links of row i. HELIO_UPDATE, for patches: and B = B0 + rho E in a
// second array of senders. Chebyshev: B = w (B0 + rho E) + (1 - w) B_before, which the second array holds.
HELIO_CONSTANT uint kGatherRows = 0u;        // RowRecord
HELIO_CONSTANT uint kGatherStrips = 1u;      // StripRecord, as two uvec4
HELIO_CONSTANT uint kGatherLinks = 2u;       // LinkQuadRecord and LinkSingleRecord, from record `recordFirst` on
HELIO_CONSTANT uint kGatherMoments = 3u;     // MomentQuadRecord, from record `momentFirst` on
HELIO_CONSTANT uint kGatherSenders = 4u;
HELIO_CONSTANT uint kGatherIrradiance = 5u;  // written
HELIO_CONSTANT uint kGatherParents = 6u;     // the same array, read: rows of levels that are done
HELIO_CONSTANT uint kGatherReflectance = 7u;
HELIO_CONSTANT uint kGatherB0 = 8u;
HELIO_CONSTANT uint kGatherOut = 9u;
HELIO_CONSTANT uint kGatherBefore = 10u;     // the same array as the last, read
struct GatherParams {      // push constant
    uint rowFirst;         // whole strips
    uint rowCount;
    uint recordFirst;      // record that is element 0 of the bound links
    uint momentFirst;
    uint patchCount;
    uint stride;
    float scale;           // of the result: 1, or pi where senders are radiances
    uint pad0;
    vec4 weight;           // Chebyshev: w, >= 1
};
HELIO_SIZE(GatherParams, 48);

// Area-weighted sums over patches, per channel, with B_new = B0 + rho E. Also the partial sums of one lane.
struct ResidualRecord {
    vec4 change;           // sum A (B_new - B)^2: the defect of B
    vec4 scale;            // sum A (B_new - B0)^2
    vec4 radiosity;        // sum A B_new, W
    vec4 largest;          // largest |B_new - B| of a patch, W/m2
};
HELIO_SIZE(ResidualRecord, 64);

// residual_parts: each lane sums kResidualRun patches
HELIO_CONSTANT uint kResidualRun = 32u;
HELIO_CONSTANT uint kPartsReflectance = 0u;
HELIO_CONSTANT uint kPartsB0 = 1u;
HELIO_CONSTANT uint kPartsIrradiance = 2u;
HELIO_CONSTANT uint kPartsSenders = 3u;      // that the sweep started from
HELIO_CONSTANT uint kPartsPlanes = 4u;
HELIO_CONSTANT uint kPartsOut = 5u;
// residual: the sum of the parts, in a fixed order
HELIO_CONSTANT uint kResidualGroup = 256u;
HELIO_CONSTANT uint kResidualParts = 0u;
HELIO_CONSTANT uint kResidualResult = 1u;
struct CountParams {       // push constant
    uint count;
};
HELIO_SIZE(CountParams, 4);

// soft_light: skyTint E_sky + E_indirect of every patch
HELIO_CONSTANT uint kSoftSky = 0u;
HELIO_CONSTANT uint kSoftIndirect = 1u;
HELIO_CONSTANT uint kSoftLight = 2u;         // written
struct SoftLightParams {   // push constant
    vec4 skyTint;
    uint patchCount;
};
HELIO_SIZE(SoftLightParams, 20);

// Interpolated light (engine/stream/smooth_mesh.h): a vec4 a corner, then a patch, then a fan.
// smooth_corners and smooth_patches take turns, kSmoothRounds times; then smooth_fans.
HELIO_CONSTANT uint kSmoothRounds = 3u;
// Of a corner, in values of the least patch there: beyond it middles would be negative.
HELIO_CONSTANT float kSmoothLimit = 1.5f;
struct CornerWeightRecord {
    uint corner;
    float weight;
};
HELIO_SIZE(CornerWeightRecord, 8);
HELIO_CONSTANT uint kSmoothRows = 0u;        // offsets into the items
HELIO_CONSTANT uint kSmoothItems = 1u;       // a corner's patches; CornerWeightRecords of a patch or a fan
HELIO_CONSTANT uint kSmoothMeans = 2u;       // soft light of the patches
HELIO_CONSTANT uint kSmoothBefore = 3u;      // the values, read: those of the other shaders
HELIO_CONSTANT uint kSmoothValues = 4u;      // the same array, written
HELIO_CONSTANT uint kSmoothFans = 5u;        // patches + 1 offsets into the rows
struct SmoothParams {      // push constant
    uint cornerCount;
    uint patchCount;
    uint round;
};
HELIO_SIZE(SmoothParams, 12);

HELIO_SHARED_END
#endif
