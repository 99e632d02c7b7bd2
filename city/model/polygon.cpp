// SPDX-License-Identifier: Apache-2.0
#include "city/model/polygon.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace helio {

double signedArea(std::span<const glm::dvec2> ring)
{
    double twice = 0.0;
    for (size_t i = 0; i < ring.size(); ++i) {
        // Relative to the first corner, so that a small ring far from the origin keeps its digits.
        const glm::dvec2 a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
        twice += a.x * b.y - a.y * b.x;
    }
    return 0.5 * twice;
}

bool contains(std::span<const glm::dvec2> ring, const glm::dvec2& point)
{
    bool inside = false;
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        const glm::dvec2 a = ring[i], b = ring[j];
        if ((a.y > point.y) != (b.y > point.y) && point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x)
            inside = !inside;
    }
    return inside;
}

double area(const Polygon2& polygon)
{
    double sum = std::abs(signedArea(polygon.outer));
    for (const Ring2& hole : polygon.holes) sum -= std::abs(signedArea(hole));
    return sum;
}

glm::dvec3 vectorArea(std::span<const glm::dvec3> ring)
{
    glm::dvec3 twice(0.0);
    for (size_t i = 1; i + 1 < ring.size(); ++i) twice += glm::cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
    return 0.5 * twice;
}

bool isInside(const glm::dvec3& point, std::span<const Ring3> rings, const glm::dvec3& normal)
{
    const glm::dvec3 n = glm::abs(normal);
    const glm::length_t u = n.x >= n.y && n.x >= n.z ? 1 : 0, v = n.z > n.x && n.z > n.y ? 1 : 2;
    bool inside = false;
    for (const Ring3& ring : rings) {
        for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
            const glm::dvec3 &a = ring[i], &b = ring[j];
            if ((a[v] > point[v]) != (b[v] > point[v]) &&
                point[u] < (b[u] - a[u]) * (point[v] - a[v]) / (b[v] - a[v]) + a[u])
                inside = !inside;
        }
    }
    return inside;
}

glm::dvec3 vectorArea(const Polygon3& polygon)
{
    glm::dvec3 sum = vectorArea(polygon.outer);
    for (const Ring3& hole : polygon.holes) sum += vectorArea(hole);
    return sum;
}

double area(const Polygon3& polygon)
{
    return glm::length(vectorArea(polygon));
}

glm::dvec3 unitNormal(const Polygon3& polygon)
{
    const glm::dvec3 v = vectorArea(polygon);
    const double length = glm::length(v);
    return length > 0.0 ? v / length : glm::dvec3(0.0);
}

glm::dvec3 centroid(const Polygon3& polygon)
{
    const glm::dvec3 origin = polygon.outer.empty() ? glm::dvec3(0.0) : polygon.outer[0];
    const glm::dvec3 normal = unitNormal(polygon);
    glm::dvec3 moment(0.0);
    double total = 0.0;
    const auto add = [&](const Ring3& ring) {
        for (size_t i = 1; i + 1 < ring.size(); ++i) {
            const double twice = glm::dot(normal, glm::cross(ring[i] - ring[0], ring[i + 1] - ring[0]));
            moment += twice / 3.0 * ((ring[0] - origin) + (ring[i] - origin) + (ring[i + 1] - origin));
            total += twice;
        }
    };
    add(polygon.outer);
    for (const Ring3& hole : polygon.holes) add(hole);
    if (total > 0.0) return origin + moment / total;
    glm::dvec3 mean(0.0);
    for (const glm::dvec3& p : polygon.outer) mean += p / double(polygon.outer.size());
    return mean;
}

PlaneFrame planeFrame(const glm::dvec3& n)
{
    // Walls get a horizontal u, so that rectangles of a facade are axis-aligned in the frame.
    const glm::dvec3 u =
        std::abs(n.z) < 0.999999 ? glm::normalize(glm::cross(glm::dvec3(0, 0, 1), n)) : glm::dvec3(1, 0, 0);
    return {u, glm::cross(n, u), n};
}

} // namespace helio
