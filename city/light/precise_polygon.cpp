// SPDX-License-Identifier: Apache-2.0
#include "city/light/precise_polygon.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace helio {
namespace {

/// Area, centroid and radius from the corners; the normal from them too if there is none yet.
void measure(PrecisePolygon& polygon)
{
    const std::vector<PreciseVec>& p = polygon.corners;
    if (p.size() < 3) {
        polygon.corners.clear();
        polygon.area = 0;
        return;
    }
    PreciseVec twice(0);
    for (size_t i = 1; i + 1 < p.size(); ++i) twice += glm::cross(p[i] - p[0], p[i + 1] - p[0]);
    if (polygon.normal == PreciseVec(0)) {
        const Real length = glm::length(twice);
        if (length > 0) polygon.normal = twice / length;
    }
    PreciseVec moment(0);
    for (size_t i = 1; i + 1 < p.size(); ++i) {
        const Real part = glm::dot(polygon.normal, glm::cross(p[i] - p[0], p[i + 1] - p[0]));
        moment += part / 6 * ((p[i] - p[0]) + (p[i + 1] - p[0]));
    }
    polygon.area = glm::dot(polygon.normal, twice) / 2;
    polygon.centroid = polygon.area > 0 ? p[0] + moment / polygon.area : p[0];
    polygon.radius = 0;
    for (const PreciseVec& corner : p)
        polygon.radius = std::max(polygon.radius, glm::distance(corner, polygon.centroid));
}

} // namespace

PrecisePolygon precisePolygon(const Ring3& ring, const glm::dvec3& origin)
{
    PrecisePolygon polygon;
    polygon.corners.reserve(ring.size());
    // Both are doubles: their difference is exact in extended precision unless they differ by many orders.
    for (const glm::dvec3& corner : ring) polygon.corners.push_back(PreciseVec(corner) - PreciseVec(origin));
    measure(polygon);
    return polygon;
}

PrecisePolygon keepAbove(const PrecisePolygon& polygon, const PreciseVec& direction, Real offset, Real tolerance)
{
    PrecisePolygon kept;
    kept.normal = polygon.normal;
    const auto heightOf = [&](const PreciseVec& corner) {
        const Real h = glm::dot(direction, corner) - offset;
        return std::abs(h) <= tolerance ? Real(0) : h;
    };
    bool above = false, below = false;
    for (const PreciseVec& corner : polygon.corners) {
        above = above || heightOf(corner) > 0;
        below = below || heightOf(corner) < 0;
    }
    if (!above) return kept;
    if (!below) return polygon;
    PreciseVec a = polygon.corners.back();
    Real ha = heightOf(a);
    for (const PreciseVec& b : polygon.corners) {
        const Real hb = heightOf(b);
        if (ha * hb < 0) kept.corners.push_back(a + ha / (ha - hb) * (b - a));
        if (hb >= 0) kept.corners.push_back(b);
        a = b;
        ha = hb;
    }
    measure(kept);
    return kept;
}

Real boxDistance(const PrecisePolygon& a, const PrecisePolygon& b)
{
    const auto boxOf = [](const PrecisePolygon& polygon) {
        std::pair<PreciseVec, PreciseVec> box{polygon.corners[0], polygon.corners[0]};
        for (const PreciseVec& p : polygon.corners) {
            box.first = glm::min(box.first, p);
            box.second = glm::max(box.second, p);
        }
        return box;
    };
    const auto [aLow, aHigh] = boxOf(a);
    const auto [bLow, bHigh] = boxOf(b);
    return glm::length(glm::max(glm::max(aLow - bHigh, bLow - aHigh), PreciseVec(0)));
}

} // namespace helio
