// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <clipper.hpp>
#include <span>
#include <vector>

#include "city/model/polygon.h"

// Between our polygons and Clipper's integer grid. For city/layout and city/grammar.
namespace helio {

/// Grid steps per metre: 0.1 mm, so that Clipper stays in its fast 64-bit range up to +-107 km.
inline constexpr double kGridPerMetre = 1e4;
/// Largest coordinate that may be put on the grid, m.
inline constexpr double kGridLimit = 1e5;

/// Nearest grid point. Programmer error: |coordinate| > kGridLimit or not finite.
ClipperLib::IntPoint toGrid(const glm::dvec2& point);
glm::dvec2 fromGrid(const ClipperLib::IntPoint& point);
ClipperLib::Path toGrid(std::span<const glm::dvec2> ring);
Ring2 fromGrid(const ClipperLib::Path& path);

/// Appends a polygon's rings: outer counter-clockwise, holes clockwise, whatever their direction was.
void appendRings(ClipperLib::Paths& paths, const Polygon2& polygon);
ClipperLib::Paths toPaths(const Polygon2& polygon);
/// Every outer contour with its holes, in Clipper's order.
std::vector<Polygon2> toPolygons(const ClipperLib::PolyTree& tree);

/// Boolean operations (non-zero filling on both sides); corners on straight lines stay.
ClipperLib::Paths unite(const ClipperLib::Paths& paths);
ClipperLib::Paths subtract(const ClipperLib::Paths& from, const ClipperLib::Paths& what);
ClipperLib::Paths intersect(const ClipperLib::Paths& a, const ClipperLib::Paths& b);
std::vector<Polygon2> subtractToPolygons(const ClipperLib::Paths& from, const ClipperLib::Paths& what);
/// Grows (or, negative, shrinks) by a distance in metres; corners keep their angle up to a miter of twice the distance.
ClipperLib::Paths offset(const ClipperLib::Paths& paths, double distance);
/// Area of the paths, holes negative, m2.
double areaOf(const ClipperLib::Paths& paths);

} // namespace helio
