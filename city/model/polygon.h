// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "city/base/types.h"

namespace helio {

/// A closed ring of corners, the last one not repeated.
using Ring2 = std::vector<glm::dvec2>;
using Ring3 = std::vector<glm::dvec3>;

/// A polygon in the plane: outer ring counter-clockwise, holes clockwise.
struct Polygon2
{
    Ring2 outer;
    std::vector<Ring2> holes;
};

/// A planar polygon in space, in metres. Seen from its lit side the outer ring runs counter-clockwise, holes clockwise.
struct Polygon3
{
    Ring3 outer;
    std::vector<Ring3> holes;
};

/// Signed area, m2: positive if the ring runs counter-clockwise.
double signedArea(std::span<const glm::dvec2> ring);
/// Area of a polygon less its holes, m2.
double area(const Polygon2& polygon);

/// z of the cross product: twice the signed area of the triangle 0, a, b.
inline double cross(const glm::dvec2& a, const glm::dvec2& b)
{
    return a.x * b.y - a.y * b.x;
}
/// The same for the triangle o, a, b: positive if it runs counter-clockwise.
inline double cross(const glm::dvec2& o, const glm::dvec2& a, const glm::dvec2& b)
{
    return cross(a - o, b - o);
}
/// True if the point lies inside the ring (even-odd); points on the border may go either way.
bool contains(std::span<const glm::dvec2> ring, const glm::dvec2& point);

/// Vector area of a ring, m2 (Newell): its length is the area, its direction the normal of the lit side.
glm::dvec3 vectorArea(std::span<const glm::dvec3> ring);
glm::dvec3 vectorArea(const Polygon3& polygon);
/// Even-odd test of a point in the plane of some rings, in the coordinate plane that they face most.
bool isInside(const glm::dvec3& point, std::span<const Ring3> rings, const glm::dvec3& normal);
double area(const Polygon3& polygon);
/// Unit normal of the lit side; zero vector for a degenerate polygon.
glm::dvec3 unitNormal(const Polygon3& polygon);
/// Area centroid, holes subtracted; the mean of the corners for a degenerate polygon.
glm::dvec3 centroid(const Polygon3& polygon);

/// Two unit vectors that make a right-handed frame (u, v, normal).
struct PlaneFrame
{
    glm::dvec3 u, v, normal;
};
PlaneFrame planeFrame(const glm::dvec3& unitNormal);

} // namespace helio
