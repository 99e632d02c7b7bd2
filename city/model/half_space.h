// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "city/model/polygon.h"

namespace helio {

/// Corners closer to a cutting plane than this lie on it, m.
inline constexpr double kSnap = 1e-7;

/// What is kept of a cut: the points with dot(normal, p) >= offset.
struct HalfSpace
{
    glm::dvec3 normal; ///< unit
    double offset;
    int axis = -1; ///< of the coordinate that is constant on the plane; -1: none

    static HalfSpace alongAxis(int axis, double at, double side)
    {
        glm::dvec3 normal(0.0);
        normal[axis] = side;
        return {normal, side * at, axis};
    }

    double exactDistance(const glm::dvec3& p) const;
    /// Distance on the kept side, m; corners within kSnap are on the plane.
    double distance(const glm::dvec3& p) const;
    /// Puts a point that is close to the plane onto it, to the last bit where the plane lies along the axes.
    glm::dvec3 snapped(glm::dvec3 p) const
    {
        if (axis >= 0) p[axis] = normal[axis] * offset;
        return p;
    }
};

/// The part of a planar polygon in a half space. Concave polygons and holes are cut exactly; both sides of a cut share
/// their corners to the bit. May be empty.
std::vector<Polygon3> clipPolygon(const HalfSpace& plane, const Polygon3& polygon);

/// A ring without corners that repeat their predecessor within 1e-9 m.
Ring3 withoutRepeats(const Ring3& ring);

/// Sorts loops of one plane into polygons: counter-clockwise ones about the normal are outlines, the others holes of
/// the outline around them. Loops of less than 1e-10 m2 are rounding and are left out.
std::vector<Polygon3> assembleLoops(std::vector<Ring3> loops, const glm::dvec3& normal);

} // namespace helio
