// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "city/base/result.h"
#include "city/model/polygon.h"

namespace helio {

/// Most corners of one polygon: the candidates for split events grow with the square of it.
inline constexpr u32 kSkeletonMaxCorners = 1200;

/// A point where wavefront edges meet.
struct SkeletonNode
{
    glm::dvec2 position{0.0}; ///< m
    double time = 0.0;        ///< m that an edge of speed 1 has moved when its wavefront is here
};

/// The planar subdivision that the edges of a polygon sweep while they move inwards.
struct Skeleton
{
    std::vector<SkeletonNode> nodes; ///< first the polygon's corners (outer ring, then holes), at time 0
    /// Per edge (outer ring, then holes; edge i starts at corner i) its face, counter-clockwise, first the edge's two
    /// corners. Every arc belongs to two faces, once in each direction. The face of an edge of speed 0 has no area: it
    /// stands on the edge.
    std::vector<std::vector<u32>> faces;
    u32 tries = 1; ///< wavefronts that were run; above 1, speeds were changed by less than 1e-7
};

/// Straight skeleton of a simple polygon with holes (outer ring counter-clockwise, holes clockwise, |coordinate| <=
/// 1e5 m, put on the 0.1 mm grid). `speeds`: per edge, >= 0, in units of the common speed; empty = 1 everywhere. Edges
/// of equal direction that touch need equal speeds.
///
/// The wavefront is moved from event to event (Aichholzer, Aurenhammer, Alberts, Gaertner, "A novel type of skeleton
/// for polygons", J. UCS 1(12), 1995; with speeds: Eppstein, Erickson, "Raising roofs, crashing cycles, and playing
/// pool", Discrete Comput. Geom. 22, 1999, section 2) in 64-bit mantissas, with exact predicates for parallel and
/// reflex edges. The result is checked: faces simple, areas add up to the polygon's within 1e-6, times >= 0 and equal
/// to the distance from the face's edge divided by its speed. Errors: what did not hold.
Result<Skeleton> straightSkeleton(const Polygon2& polygon, std::span<const double> speeds = {});

} // namespace helio
