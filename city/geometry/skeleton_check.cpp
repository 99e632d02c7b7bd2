// SPDX-License-Identifier: Apache-2.0
#include "city/geometry/skeleton_check.h"

#include <algorithm>
#include <cmath>

#include "city/base/check.h"

namespace helio {

namespace {

/// Allowed distance of a node from a face's plane: contracted arcs are shorter than 0.01 steps.
constexpr Real kPlaneTolerance = 0.05L;
/// Sides that cross by less than this touch, grid steps.
constexpr Real kTouch = 1e-3L;

/// A node in the plane of a face: along its edge, and up the slope.
struct Flat
{
    Real s, t;
};

Real side(const Flat& a, const Flat& b, const Flat& p)
{
    const Real ds = b.s - a.s, dt = b.t - a.t;
    const Real length = std::hypot(ds, dt);
    return length > 0 ? (ds * (p.t - a.t) - dt * (p.s - a.s)) / length : 0;
}

bool cross(const Flat& a, const Flat& b, const Flat& c, const Flat& d)
{
    if (std::max(a.s, b.s) < std::min(c.s, d.s) || std::max(c.s, d.s) < std::min(a.s, b.s)) return false;
    if (std::max(a.t, b.t) < std::min(c.t, d.t) || std::max(c.t, d.t) < std::min(a.t, b.t)) return false;
    const Real c1 = side(a, b, c), d1 = side(a, b, d), a1 = side(c, d, a), b1 = side(c, d, b);
    const auto opposite = [](Real x, Real y) { return (x > kTouch && y < -kTouch) || (x < -kTouch && y > kTouch); };
    return opposite(c1, d1) && opposite(a1, b1);
}

bool simple(const std::vector<Flat>& ring)
{
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 2; j < n; ++j) {
            if (i == 0 && j + 1 == n) continue;
            if (cross(ring[i], ring[i + 1], ring[j], ring[(j + 1) % n])) return false;
        }
    }
    return true;
}

} // namespace

std::string skeletonProblem(std::span<const WaveEdge> edges, std::span<const WaveNode> nodes,
                            std::span<const std::vector<u32>> faces, Real area)
{
    for (const WaveNode& node : nodes) {
        if (!std::isfinite(node.position.x) || !std::isfinite(node.position.y) || !std::isfinite(node.time))
            return "a node is not finite";
        if (node.time < 0) return "a node lies below the base";
    }
    Real sum = 0;
    std::vector<std::pair<u32, u32>> sides;
    std::vector<Flat> flat;
    for (u32 i = 0; i < faces.size(); ++i) {
        const std::vector<u32>& face = faces[i];
        const WaveEdge& edge = edges[i];
        if (face.size() < 3) return concat("face ", i, " has no area");
        if (face[0] != i || face[1] != edge.next) return concat("face ", i, " left its edge");
        flat.clear();
        for (const u32 n : face) {
            const Real x = nodes[n].position.x - Real(edge.x), y = nodes[n].position.y - Real(edge.y);
            const Real distance = x * edge.normal.x + y * edge.normal.y;
            if (std::abs(distance - edge.speed * nodes[n].time) > kPlaneTolerance)
                return concat("face ", i, " is not plane");
            flat.push_back({x * edge.along.x + y * edge.along.y, nodes[n].time});
        }
        Real twice = 0;
        for (std::size_t j = 0; j < flat.size(); ++j) {
            const Flat& a = flat[j];
            const Flat& b = flat[(j + 1) % flat.size()];
            twice += a.s * b.t - a.t * b.s;
            sides.push_back({face[j], face[(j + 1) % face.size()]});
        }
        if (!(twice > 0)) return concat("face ", i, " has no area");
        if (!simple(flat)) return concat("face ", i, " crosses itself");
        sum += twice / 2 * edge.speed;
    }
    if (!(std::abs(sum - area) <= 1e-6L * area)) return "the areas of the faces do not add up";
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 0; i + 1 < sides.size(); ++i)
        if (sides[i] == sides[i + 1]) return "two faces on one side of an arc";
    for (u32 i = 0; i < edges.size(); ++i) {
        // The edges of the base have one face.
        const auto own = std::lower_bound(sides.begin(), sides.end(), std::pair(i, edges[i].next));
        sides.erase(own);
    }
    for (const auto& [a, b] : sides)
        if (!std::binary_search(sides.begin(), sides.end(), std::pair(b, a))) return "an arc has one face only";
    return {};
}

} // namespace helio
