// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "city/model/polygon.h"

// Roofs over any simple polygon, with holes. The base lies in the plane z = 0 and is seen from above (outer ring
// counter-clockwise, holes clockwise); metres. Every roof is a closed solid: each edge belongs to two faces, once in
// each direction, the bottom included.
namespace helio {

/// How steep a roof is.
struct RoofPitch
{
    bool byHeight = false; ///< false: `value` is the slope in degrees, 0 < value < 90; true: the rise of the highest
                           ///< point above the base in metres, > 0
    double value = 30.0;
};

enum class RoofPart : u8
{
    Slope, ///< roof.top
    Gable, ///< roof.side: vertical
    Bottom ///< roof.bottom: looks down
};

struct RoofFace
{
    Polygon3 polygon; ///< seen from outside
    RoofPart part = RoofPart::Slope;
    u32 edge = kNoIndex; ///< edge of the base under it (outer ring, then holes); kNoIndex: the bottom
};

/// What had to be done where the skeleton did not pass its own checks.
enum class RoofFallback : u8
{
    None,
    Parts, ///< simpler roof (a hip instead of gables, or hips over parts of the base)
    Flat   ///< a slab of 0.1 m, no slope
};

struct Roof
{
    std::vector<RoofFace> faces; ///< empty: the base has no area
    RoofFallback fallback = RoofFallback::None;
    std::string reason; ///< of the fallback
};

/// Equal slopes from every edge. `overhang` (m, >= 0) lets the slopes go on beyond the base, downwards: the bottom then
/// lies at z = -overhang * tan(slope).
Roof hipRoof(const Polygon2& base, const RoofPitch& pitch, double overhang);
/// Gables on the ends that CGA's roofGable puts them on; `overhangX` beyond the gables, `overhangY` beyond the eaves
/// (m,
/// >= 0). `even`: all ridge ends of one height. `index` turns which ends are gables on four-cornered bases.
Roof gableRoof(const Polygon2& base, const RoofPitch& pitch, double overhangX, double overhangY, bool even, u32 index);
/// One plane that rises from edge `edge` of the outer ring.
Roof shedRoof(const Polygon2& base, const RoofPitch& pitch, u32 edge);
/// One apex above the centroid; a hip where not all of the base sees the centroid.
Roof pyramidRoof(const Polygon2& base, const RoofPitch& pitch);

} // namespace helio
