// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "city/light/form_factor.h"

namespace helio {

/// The boundary of a polygon as a chain of closed rings, relative to some origin, m.
struct Contour
{
    std::vector<glm::dvec3> corners;
    std::vector<u32> ringEnd; ///< one past the last corner of each ring
};

/// The part of `shape` that lies before the plane of `viewer`, relative to `origin`; false if there is none. Rings are
/// cut one by one: where a concave ring falls apart, its pieces stay joined by edges that are walked twice and cancel
/// in every contour integral.
bool cutToFront(const PlanarShape& shape, const PlanarShape& viewer, const glm::dvec3& origin, Contour& out);

/// Smallest distance between the axis-parallel boxes of two contours, m; a lower bound of their distance.
double boxDistance(const Contour& a, const Contour& b);

/// A_a F_ab of two polygons that lie wholly before each other's planes, m2:
/// (1 / 2 pi) sum over pairs of edges of (e_p . e_q) times the double integral of ln r along them.
double contourExchange(const Contour& a, const Contour& b);

} // namespace helio
