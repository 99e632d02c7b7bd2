// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "city/model/polygon.h"

// Offsets of a simple polygon with holes (outer ring counter-clockwise, holes clockwise; metres).
namespace helio {

/// The polygon grown (distance > 0) or shrunk (< 0); corners keep their angle up to a miter limit. Empty when nothing
/// is left.
std::vector<Polygon2> offsetPolygon(const Polygon2& polygon, double distance);

/// A strip along one edge.
struct SetbackStrip
{
    u32 edge = 0;     ///< of the outer ring, then of the holes
    Polygon2 polygon; ///< its first edge lies on the polygon's edge
};

struct Setback
{
    std::vector<SetbackStrip> strips; ///< in the order of the edges; an edge may have several pieces or none
    std::vector<Polygon2> remainder;
};

/// Cuts strips of the given widths (m, one per edge, outer ring then holes; 0 = none) off the edges. Strips and
/// remainder tile the polygon: no overlap, no gap beyond the 0.1 mm grid.
Setback setback(const Polygon2& polygon, std::span<const double> widths);

/// A rectangle with its axes.
struct InnerRectangle
{
    glm::dvec2 origin, axis; ///< lower left corner and unit direction of its first side
    glm::dvec2 size;         ///< m
};

/// A large rectangle inside the polygon with a side along `axis` (unit); nullopt for a polygon that has none above 1e-3
/// m. Exact for convex polygons without holes up to the step of the search that its source states.
std::optional<InnerRectangle> innerRectangle(const Polygon2& polygon, const glm::dvec2& axis);

} // namespace helio
