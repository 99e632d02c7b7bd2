// SPDX-License-Identifier: Apache-2.0
#include "city/model/triangulate.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace helio {
namespace {

bool insideTriangle(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c)
{
    return cross(a, b, p) >= 0.0 && cross(b, c, p) >= 0.0 && cross(c, a, p) >= 0.0;
}

/// Joins a hole to the loop by two coincident edges from the hole's rightmost corner to a visible corner of the loop.
void bridgeHole(std::vector<u32>& loop, std::vector<u32> hole, const std::vector<glm::dvec2>& p)
{
    const auto rightmost = std::max_element(
        hole.begin(), hole.end(), [&](u32 a, u32 b) { return p[a].x != p[b].x ? p[a].x < p[b].x : p[a].y < p[b].y; });
    std::rotate(hole.begin(), rightmost, hole.end());
    const glm::dvec2 m = p[hole[0]];

    // Nearest edge of the loop to the right of m on the horizontal ray.
    size_t best = loop.size();
    double bestX = 0.0;
    for (size_t i = 0; i < loop.size(); ++i) {
        const glm::dvec2 a = p[loop[i]], b = p[loop[(i + 1) % loop.size()]];
        if (a.y == b.y || std::min(a.y, b.y) > m.y || std::max(a.y, b.y) < m.y) continue;
        const double x = a.x + (m.y - a.y) / (b.y - a.y) * (b.x - a.x);
        if (x < m.x || (best < loop.size() && x >= bestX)) continue;
        best = i;
        bestX = x;
    }
    if (best == loop.size()) return; // The hole is not inside the outer ring: leave it out.

    // The edge's end with larger x is visible unless a reflex corner lies in the triangle (m, hit, end); then the one
    // with the smallest angle to the ray is.
    const size_t next = (best + 1) % loop.size();
    size_t bridge = p[loop[best]].x > p[loop[next]].x ? best : next;
    const glm::dvec2 hit(bestX, m.y), end = p[loop[bridge]];
    double bestSlope = -1.0, bestDistance = 0.0;
    for (size_t i = 0; i < loop.size(); ++i) {
        const glm::dvec2 q = p[loop[i]];
        if (q.x < m.x || loop[i] == loop[bridge]) continue;
        const bool inside = end.y < m.y ? insideTriangle(q, m, end, hit) : insideTriangle(q, m, hit, end);
        if (!inside) continue;
        const double dx = q.x - m.x, slope = dx / std::max(1e-300, glm::length(q - m)), distance = glm::length(q - m);
        if (slope > bestSlope || (slope == bestSlope && distance < bestDistance)) {
            bestSlope = slope;
            bestDistance = distance;
            bridge = i;
        }
    }
    std::vector<u32> insert(hole.begin(), hole.end());
    insert.push_back(hole[0]);
    insert.push_back(loop[bridge]);
    loop.insert(loop.begin() + std::ptrdiff_t(bridge) + 1, insert.begin(), insert.end());
}

} // namespace

std::vector<std::array<u32, 3>> triangulate(const Polygon2& polygon)
{
    std::vector<glm::dvec2> p(polygon.outer);
    std::vector<u32> loop(polygon.outer.size());
    for (u32 i = 0; i < loop.size(); ++i) loop[i] = i;
    if (signedArea(polygon.outer) < 0.0) std::reverse(loop.begin(), loop.end());

    std::vector<std::vector<u32>> holes;
    for (const Ring2& ring : polygon.holes) {
        std::vector<u32> hole(ring.size());
        for (u32 i = 0; i < hole.size(); ++i) hole[i] = u32(p.size()) + i;
        if (signedArea(ring) > 0.0) std::reverse(hole.begin(), hole.end());
        p.insert(p.end(), ring.begin(), ring.end());
        if (hole.size() >= 3) holes.push_back(std::move(hole));
    }
    const auto maxX = [&](const std::vector<u32>& hole) {
        double x = p[hole[0]].x;
        for (const u32 i : hole) x = std::max(x, p[i].x);
        return x;
    };
    std::stable_sort(holes.begin(), holes.end(), [&](const auto& a, const auto& b) { return maxX(a) > maxX(b); });
    for (std::vector<u32>& hole : holes) bridgeHole(loop, std::move(hole), p);

    std::vector<std::array<u32, 3>> triangles;
    while (loop.size() > 2) {
        const size_t n = loop.size();
        size_t ear = n;
        size_t flattest = 0;
        double flattestArea = 0.0;
        for (size_t i = 0; i < n && ear == n; ++i) {
            const u32 ia = loop[(i + n - 1) % n], ib = loop[i], ic = loop[(i + 1) % n];
            const glm::dvec2 a = p[ia], b = p[ib], c = p[ic];
            const double twice = cross(a, b, c);
            if (i == 0 || std::abs(twice) < flattestArea) {
                flattestArea = std::abs(twice);
                flattest = i;
            }
            if (twice <= 0.0) continue;
            bool empty = true;
            for (size_t j = 0; j < n && empty; ++j) {
                const glm::dvec2 q = p[loop[j]];
                if (q == a || q == b || q == c) continue;
                empty = !insideTriangle(q, a, b, c);
            }
            if (empty) ear = i;
        }
        const bool found = ear < n;
        if (!found) ear = flattest; // Collinear or touching corners are left: drop the flattest one.
        const std::array<u32, 3> t{loop[(ear + n - 1) % n], loop[ear], loop[(ear + 1) % n]};
        if (cross(p[t[0]], p[t[1]], p[t[2]]) > 0.0) triangles.push_back(t);
        loop.erase(loop.begin() + std::ptrdiff_t(ear));
    }
    return triangles;
}

std::vector<std::array<u32, 3>> triangulate(const Polygon3& polygon)
{
    const PlaneFrame frame = planeFrame(unitNormal(polygon));
    const auto flatten = [&](const Ring3& ring) {
        Ring2 flat;
        for (const glm::dvec3& q : ring)
            flat.emplace_back(glm::dot(q - polygon.outer[0], frame.u), glm::dot(q - polygon.outer[0], frame.v));
        return flat;
    };
    Polygon2 flat{flatten(polygon.outer), {}};
    for (const Ring3& hole : polygon.holes) flat.holes.push_back(flatten(hole));
    return triangulate(flat);
}

} // namespace helio
