// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "city/base/types.h"
#include "city/model/polygon.h"

// Roofs over any polygon, with holes. The base lies in the plane z = 0 and is seen from above (outer ring
// counter-clockwise, holes clockwise); metres. It is put on the 0.1 mm grid; rings that touch or cross become the
// simple polygons of their union. Every roof is a closed solid per simple polygon: each edge belongs to two faces, once
// in each direction, the bottom included.
namespace helio {

/// How steep a roof is.
struct RoofPitch
{
    bool byHeight = false; ///< false: `value` is the slope in degrees, 0.1 to 89; true: the rise of the highest point
                           ///< above the base in metres, > 0. Anything else makes a flat roof.
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
    u32 edge = kNoIndex; ///< edge of the base under it (outer ring, then holes); kNoIndex: the bottom, a flat top
};

/// What had to be done where the skeleton did not pass its own checks.
enum class RoofFallback : u8
{
    None,
    Parts, ///< a simpler roof: a hip instead of gables, or no overhang
    Flat   ///< a slab of 0.1 m, no slope
};

struct Roof
{
    std::vector<RoofFace> faces; ///< empty: the base has no area
    RoofFallback fallback = RoofFallback::None;
    std::string reason; ///< of the fallback
};

/// Equal slopes from every edge. `overhang` (m in plan, 0 to 50) lets the slopes go on beyond the base, downwards: the
/// bottom then lies at z = -overhang * tan(slope).
Roof hipRoof(const Polygon2& base, const RoofPitch& pitch, double overhang);

/// Slopes with gables (vertical ends). Sides are runs of edges that turn by less than 5 degrees from one to the next.
/// A gable stands on a side whose hip would be a triangle between the slopes of the two sides next to it, both corners
/// convex, its two angles together 120 to 230 degrees; shorter sides first, no two next to each other. A base with no
/// such side gets a hip roof. On convex bases of four sides `index` turns the ridge into the direction of the side of
/// edge `index` of the outer ring, taken modulo its edges (gables on the two sides next to it); kNoIndex: by the rule
/// above. `overhangX`, `overhangY` (m in plan, 0 to 50): beyond the eaves and, in the direction of the ridges, beyond
/// the gables, as in CGA. `even`: a ridge that ends on gables is level at the mean height of its ends; slopes that are
/// no longer plane come as triangles.
Roof gableRoof(const Polygon2& base, const RoofPitch& pitch, double overhangX, double overhangY, bool even, u32 index);

/// One plane that rises from edge `edge` (modulo the edges) of the outer ring; raised so far that no point of the base
/// lies below z = 0. Vertical sides.
Roof shedRoof(const Polygon2& base, const RoofPitch& pitch, u32 edge);

/// One apex above the mean of the outer ring's corners, as in CGA, or above the centroid where not all of the base sees
/// that; by angle, the face of the first edge has it. A hip where not all of the base sees the centroid either, and on
/// bases with holes.
Roof pyramidRoof(const Polygon2& base, const RoofPitch& pitch);

} // namespace helio
