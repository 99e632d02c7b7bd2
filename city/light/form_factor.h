// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/model/polygon.h"

namespace helio {

/// A planar polygon that exchanges light. Rings as in NodeTree: outer rings counter-clockwise seen from the lit side,
/// holes clockwise; convex or not.
struct PlanarShape
{
    std::span<const Ring3> rings;
    glm::dvec3 normal{0.0};   ///< unit normal of the lit side
    glm::dvec3 centroid{0.0}; ///< m
    double area = 0.0;        ///< m2
    double radius = 0.0;      ///< m, from the centroid to the farthest corner
};

/// The shape of a polygon's rings; area and normal by Newell's vector area.
PlanarShape planarShape(std::span<const Ring3> rings);

/// Form factor from a surface element to a polygon: the fraction of what a diffuse element at `point` (m) with unit
/// `normal` sends that meets the lit side of the polygon, 0..1. The polygon is clipped to the element's horizon; from
/// behind it is 0. Lambert's contour formula with atan2 (Baum, Rushmeier, Winget 1989, eq. 4).
double pointFactor(const glm::dvec3& point, const glm::dvec3& normal, std::span<const Ring3> rings);

/// The unoccluded exchange of two polygons, A_a F_ab = A_b F_ba, m2, never negative. Symmetric. Each polygon counts
/// only with what lies before the other's plane. Near pairs: double contour integral of ln r (Sparrow 1963; parallel
/// edges in closed form, else the inner integral in closed form and the outer by Gauss points graded towards the
/// nearest approach); pairs farther apart than the smaller one's size: Gauss points over the smaller, pointFactor to
/// the larger. Relative error below 3e-3 where F of the smaller polygon is above 1e-4, absolute error below 2e-7
/// elsewhere (triangles at four to eight times their size are the worst; errors of single pairs cancel: rows of closed
/// rooms add up to 1 within 5e-5). pairFactor() is exact.
double exchange(const PlanarShape& a, const PlanarShape& b);

} // namespace helio
