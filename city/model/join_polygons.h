// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "city/model/polygon.h"

namespace helio {

/// Union of coplanar polygons that touch but do not overlap (m): edges that two of them share go, what is left is
/// chained to rings without collinear corners. Corners within a micrometre count as one. Holes stay holes, and gaps
/// that the polygons enclose become holes. The area is kept to 1e-6; where that fails (polygons overlap) or above 4096
/// corners, the polygons come back as they are. O(corners^2).
std::vector<Polygon3> joinPolygons(std::span<const Polygon3> polygons, const glm::dvec3& normal);

/// The part of a planar polygon where dot(cut, p) >= offset; `cut` is a unit vector in the polygon's plane. Concave
/// polygons and holes give several parts. The part beyond, taken with -cut and -offset, has the same corners on the
/// cut.
std::vector<Polygon3> clipPolygon(const Polygon3& polygon, const glm::dvec3& cut, double offset);

/// The polygons cut into `count` >= 1 parts of equal extent along `axis`, a unit vector in their plane; parts come in
/// its direction, empty ones included. Areas add up to that of the polygons.
std::vector<std::vector<Polygon3>> cutIntoStrips(std::span<const Polygon3> polygons, const glm::dvec3& axis, u32 count);

} // namespace helio
