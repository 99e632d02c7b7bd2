// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "city/base/types.h"
#include "city/model/polygon.h"

// Polygons in extended precision (64 bits of mantissa on x86-64), for form factors of pairs. Internal to city/light.
namespace helio {

using Real = long double;
using PreciseVec = glm::vec<3, Real>;

/// One planar ring relative to some origin, m. Where a concave ring was cut apart its pieces stay joined by edges that
/// are walked twice and cancel in every contour integral.
struct PrecisePolygon
{
    std::vector<PreciseVec> corners;
    PreciseVec normal{0};   ///< unit, to the lit side
    PreciseVec centroid{0}; ///< m
    Real area = 0;          ///< m2
    Real radius = 0;        ///< m, from the centroid to the farthest corner
};

/// A value with a bound of its error as the method itself sees it (not a proof), and what it cost.
struct Estimate
{
    Real value = 0, error = 0;
    u64 evaluations = 0; ///< of an edge from a point, or of a polygon from a point

    void operator+=(const Estimate& other)
    {
        value += other.value;
        error += other.error;
        evaluations += other.evaluations;
    }
};

/// A ring of the world relative to `origin`, in metres. A ring without area has a zero normal.
PrecisePolygon precisePolygon(const Ring3& ring, const glm::dvec3& origin);

/// What of `polygon` has (dot(direction, p) - offset) >= 0; heights within `tolerance` count as 0. Normal and kind of
/// rings as in PrecisePolygon; no corners if nothing is left.
PrecisePolygon keepAbove(const PrecisePolygon& polygon, const PreciseVec& direction, Real offset, Real tolerance);

/// Smallest distance between the axis-parallel boxes, m: a lower bound of the polygons' distance.
Real boxDistance(const PrecisePolygon& a, const PrecisePolygon& b);

} // namespace helio
