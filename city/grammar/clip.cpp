// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/clip.h"

#include <glm/geometric.hpp>

#include "city/grammar/cap.h"

namespace helio::cga {

namespace {

Geometry clipHalf(const Geometry& geometry, const HalfSpace& plane)
{
    Geometry result;
    result.closed = geometry.closed;
    for (const Face& face : geometry.faces)
        for (Polygon3& polygon : clipPolygon(plane, face.polygon)) {
            Face piece = face;
            piece.polygon = std::move(polygon);
            if (!face.edges.empty()) inheritEdges(face, piece);
            result.faces.push_back(std::move(piece));
        }
    if (!geometry.closed || result.faces.empty()) return result;
    const glm::dvec3 outward = -plane.normal, up(0, 1, 0);
    const glm::dvec3 level = glm::cross(up, outward);
    closeCut(
        result, [&](const glm::dvec3& p) { return plane.distance(p) == 0.0; }, outward,
        glm::length(level) > 1e-6 ? glm::normalize(level) : glm::dvec3(1, 0, 0));
    return result;
}

} // namespace

Geometry clipSlab(const Geometry& geometry, int axis, double low, double high)
{
    const auto [least, most] = bounds(geometry);
    if (least[axis] > high - kSnap && most[axis] > high + kSnap) return {};
    Geometry result = least[axis] < low - kSnap ? clipHalf(geometry, HalfSpace::alongAxis(axis, low, 1.0)) : geometry;
    return most[axis] > high + kSnap ? clipHalf(result, HalfSpace::alongAxis(axis, high, -1.0)) : result;
}

Geometry clipPlane(const Geometry& geometry, const glm::dvec3& normal, double offset)
{
    const HalfSpace plane{normal, offset};
    bool outside = false;
    for (const Face& face : geometry.faces)
        for (const glm::dvec3& p : face.polygon.outer) outside = outside || plane.distance(p) < 0.0;
    return outside ? clipHalf(geometry, plane) : geometry;
}

} // namespace helio::cga
