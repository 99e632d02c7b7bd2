// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/primitives.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "city/base/check.h"

namespace helio::cga {

namespace {

void addFace(Geometry& geometry, Ring3 ring)
{
    Face face;
    face.xAxis = glm::normalize(ring[1] - ring[0]);
    face.polygon.outer = std::move(ring);
    geometry.faces.push_back(std::move(face));
}

void checkSides(u32 sides, u32 least)
{
    HELIO_CHECK(sides >= least && sides <= kMaxSides, sides);
}

/// A level ellipse at height y, counter-clockwise seen from above; `scale` times as wide as the scope.
Ring3 ellipse(u32 sides, const glm::dvec3& size, double y, double scale)
{
    Ring3 ring;
    for (u32 k = 0; k < sides; ++k) {
        const double angle = 2.0 * M_PI * k / sides;
        ring.emplace_back(0.5 * size.x * (1.0 + scale * std::cos(angle)), y,
                          0.5 * size.z * (1.0 - scale * std::sin(angle)));
    }
    return ring;
}

Ring3 reversed(Ring3 ring)
{
    std::reverse(ring.begin(), ring.end());
    return ring;
}

/// Walls from a lower to an upper ring of the same number of corners; triangles where one of them is a point.
void addWalls(Geometry& geometry, const Ring3& lower, const Ring3& upper)
{
    const size_t n = std::max(lower.size(), upper.size());
    for (size_t k = 0; k < n; ++k) {
        const size_t next = (k + 1) % n;
        if (upper.size() == 1)
            addFace(geometry, {lower[k], lower[next], upper[0]});
        else if (lower.size() == 1)
            addFace(geometry, {upper[next], upper[k], lower[0]});
        else
            addFace(geometry, {lower[k], lower[next], upper[next], upper[k]});
    }
}

} // namespace

Geometry boxPrimitive(const glm::dvec3& size)
{
    const int flat = int(size.x <= 0.0) + int(size.y <= 0.0) + int(size.z <= 0.0);
    HELIO_CHECK(flat <= 1, size.x, " ", size.y, " ", size.z);
    if (size.y <= 0.0) return quadPrimitive(size);
    Geometry geometry;
    if (size.z <= 0.0) addFace(geometry, {{0, 0, 0}, {size.x, 0, 0}, {size.x, size.y, 0}, {0, size.y, 0}});
    if (size.x <= 0.0) addFace(geometry, {{0, 0, size.z}, {0, 0, 0}, {0, size.y, 0}, {0, size.y, size.z}});
    if (flat == 1) return geometry;
    return extrude(quadPrimitive(size), {0.0, size.y, 0.0}, false);
}

Geometry quadPrimitive(const glm::dvec3& size)
{
    Geometry geometry;
    addFace(geometry, {{0.0, 0.0, size.z}, {size.x, 0.0, size.z}, {size.x, 0.0, 0.0}, {0.0, 0.0, 0.0}});
    return geometry;
}

Geometry diskPrimitive(u32 sides, const glm::dvec3& size)
{
    checkSides(sides, kMinSides);
    Geometry geometry;
    addFace(geometry, ellipse(sides, size, 0.0, 1.0));
    return geometry;
}

Geometry cylinderPrimitive(u32 sides, const glm::dvec3& size)
{
    return extrude(diskPrimitive(sides, size), {0.0, size.y, 0.0}, false);
}

Geometry conePrimitive(u32 sides, const glm::dvec3& size)
{
    checkSides(sides, kMinSides);
    Geometry geometry;
    geometry.closed = true;
    const Ring3 base = ellipse(sides, size, 0.0, 1.0);
    addWalls(geometry, base, {{0.5 * size.x, size.y, 0.5 * size.z}});
    addFace(geometry, reversed(base));
    return geometry;
}

Geometry spherePrimitive(u32 segments, u32 rings, const glm::dvec3& size)
{
    checkSides(segments, kMinSides);
    checkSides(rings, 2);
    Geometry geometry;
    geometry.closed = true;
    const auto level = [&](u32 k) {
        const double angle = M_PI * k / rings, y = 0.5 * size.y * (1.0 - std::cos(angle));
        // The poles are points, not rings of equal corners.
        if (k == 0 || k == rings) return Ring3{{0.5 * size.x, k == 0 ? 0.0 : size.y, 0.5 * size.z}};
        return ellipse(segments, size, y, std::sin(angle));
    };
    for (u32 k = 0; k < rings; ++k) addWalls(geometry, level(k), level(k + 1));
    return geometry;
}

} // namespace helio::cga
