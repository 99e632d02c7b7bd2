// SPDX-License-Identifier: Apache-2.0
#include "city/geometry/straight_skeleton.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "city/geometry/clip.h"
#include "city/geometry/skeleton_check.h"
#include "city/geometry/wavefront.h"

namespace helio {

namespace {

/// Arcs shorter than this (1e-6 m) become one node.
constexpr Real kContract = 0.01L;
constexpr u32 kTries = 4;

struct Grid
{
    std::vector<WaveEdge> edges;
    glm::dvec2 origin{0.0};
    Real area = 0; ///< grid steps squared
};

Result<Grid> toWave(const Polygon2& polygon, std::span<const double> speeds)
{
    if (polygon.outer.size() < 3) return Error{"a ring has less than three corners"};
    Grid grid;
    // Whole metres: corners that were on the grid stay where they are.
    grid.origin = glm::dvec2(std::floor(polygon.outer[0].x), std::floor(polygon.outer[0].y));
    const auto addRing = [&](const Ring2& ring) {
        const u32 first = u32(grid.edges.size());
        for (const glm::dvec2& corner : ring) {
            const glm::dvec2 local = corner - grid.origin;
            if (!(std::abs(local.x) <= kGridLimit && std::abs(local.y) <= kGridLimit)) return false;
            WaveEdge edge;
            edge.x = std::llround(local.x * kGridPerMetre);
            edge.y = std::llround(local.y * kGridPerMetre);
            edge.next = u32(grid.edges.size()) + 1;
            grid.edges.push_back(edge);
        }
        if (ring.size() < 3) return false;
        grid.edges.back().next = first;
        return true;
    };
    bool sound = addRing(polygon.outer);
    for (const Ring2& hole : polygon.holes) sound = addRing(hole) && sound;
    if (!sound) return Error{"a ring has less than three corners, or is larger than 100 km"};
    if (grid.edges.size() > kSkeletonMaxCorners)
        return Error{concat(grid.edges.size(), " corners, more than ", kSkeletonMaxCorners)};
    __int128 twice = 0;
    for (WaveEdge& edge : grid.edges) {
        const WaveEdge& to = grid.edges[edge.next];
        edge.dx = to.x - edge.x;
        edge.dy = to.y - edge.y;
        if (edge.dx == 0 && edge.dy == 0) return Error{"two corners on one place"};
        twice += __int128(edge.x) * to.y - __int128(edge.y) * to.x;
        if (!speeds.empty()) edge.speed = Real(speeds[std::size_t(&edge - grid.edges.data())]);
    }
    if (twice <= 0) return Error{"no area"};
    grid.area = Real(twice) / 2;
    return grid;
}

/// Speeds that differ by less than 1e-7 and smoothly with direction: events of one moment fall apart, corners between
/// almost parallel edges keep their way, and slopes stay what they were.
void disturb(std::vector<WaveEdge>& edges, u32 tryIndex)
{
    for (WaveEdge& edge : edges) {
        const double angle = std::atan2(double(edge.dy), double(edge.dx));
        const double phase = 1.7 * double(tryIndex);
        edge.speed *= 1 + Real(3e-8 * (std::cos(3.0 * angle + phase) + std::cos(2.0 * angle + 2.0 * phase)));
    }
}

/// Nodes that arcs shorter than kContract join, by their smallest index.
std::vector<u32> contract(const Wavefront& front)
{
    std::vector<u32> root(front.nodes().size());
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](u32 n) {
        while (root[n] != n) n = root[n] = root[root[n]];
        return n;
    };
    const u32 corners = u32(front.edges().size());
    for (const auto& arcs : front.arcs()) {
        for (const auto& [from, to] : arcs) {
            const WaveNode& a = front.nodes()[from];
            const WaveNode& b = front.nodes()[to];
            if (std::hypot(a.position.x - b.position.x, a.position.y - b.position.y) > kContract ||
                std::abs(a.time - b.time) > kContract)
                continue;
            const u32 low = std::min(find(from), find(to)), high = std::max(find(from), find(to));
            if (high >= corners) root[high] = low;
        }
    }
    for (u32 n = 0; n < root.size(); ++n) root[n] = find(n);
    return root;
}

/// Chains the arcs of one face to a ring; empty if they make none.
std::vector<u32> ringOf(const std::vector<std::pair<u32, u32>>& arcs, const std::vector<u32>& root)
{
    std::vector<std::pair<u32, u32>> sides;
    for (const auto& [from, to] : arcs)
        if (root[from] != root[to]) sides.push_back({root[from], root[to]});
    const std::pair<u32, u32> base = sides.empty() ? std::pair(0u, 0u) : sides[0];
    // An arc there and back again is no border.
    for (std::size_t i = 0; i < sides.size();) {
        const auto back = std::find(sides.begin(), sides.end(), std::pair(sides[i].second, sides[i].first));
        if (back == sides.end()) {
            ++i;
            continue;
        }
        const std::size_t j = std::size_t(back - sides.begin());
        sides.erase(sides.begin() + std::ptrdiff_t(std::max(i, j)));
        sides.erase(sides.begin() + std::ptrdiff_t(std::min(i, j)));
        i = 0;
    }
    if (sides.size() < 3 || sides[0] != base) return {};
    std::vector<u32> ring{base.first};
    std::sort(sides.begin(), sides.end());
    u32 at = base.second;
    while (at != base.first) {
        if (ring.size() >= sides.size()) return {};
        ring.push_back(at);
        const auto range = std::equal_range(sides.begin(), sides.end(), std::pair(at, 0u),
                                            [](const auto& a, const auto& b) { return a.first < b.first; });
        if (range.second - range.first != 1) return {};
        at = range.first->second;
    }
    return ring.size() == sides.size() ? ring : std::vector<u32>{};
}

Result<Skeleton> tryOnce(const Grid& grid, const std::vector<WaveEdge>& edges)
{
    Wavefront front(edges);
    if (!front.run()) return Error{front.problem()};
    const std::vector<u32> root = contract(front);
    Skeleton skeleton;
    for (const auto& arcs : front.arcs()) {
        skeleton.faces.push_back(ringOf(arcs, root));
        if (skeleton.faces.back().empty()) return Error{"a face does not close"};
    }
    if (std::string problem = skeletonProblem(front.edges(), front.nodes(), skeleton.faces, grid.area);
        !problem.empty())
        return Error{std::move(problem)};
    // Only nodes in use, in their order.
    std::vector<u32> place(front.nodes().size(), kNoIndex);
    for (u32 i = 0; i < edges.size(); ++i) place[i] = 0;
    for (const auto& face : skeleton.faces)
        for (const u32 n : face) place[n] = 0;
    for (u32 n = 0; n < place.size(); ++n) {
        if (place[n] == kNoIndex) continue;
        place[n] = u32(skeleton.nodes.size());
        const WaveNode& node = front.nodes()[n];
        skeleton.nodes.push_back({grid.origin + glm::dvec2(double(node.position.x / Real(kGridPerMetre)),
                                                           double(node.position.y / Real(kGridPerMetre))),
                                  double(node.time / Real(kGridPerMetre))});
    }
    for (auto& face : skeleton.faces)
        for (u32& n : face) n = place[n];
    return skeleton;
}

} // namespace

Result<Skeleton> straightSkeleton(const Polygon2& polygon, std::span<const double> speeds)
{
    Result<Grid> grid = toWave(polygon, speeds);
    if (!grid) return grid.error();
    HELIO_CHECK(speeds.empty() || speeds.size() == grid->edges.size(), speeds.size(), " ", grid->edges.size());
    Result<Skeleton> result = tryOnce(*grid, grid->edges);
    for (u32 i = 1; i < kTries && !result; ++i) {
        std::vector<WaveEdge> edges = grid->edges;
        disturb(edges, i);
        if (Result<Skeleton> next = tryOnce(*grid, edges); next) {
            next->tries = i + 1;
            return next;
        }
    }
    return result;
}

} // namespace helio
