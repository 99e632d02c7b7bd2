// SPDX-License-Identifier: Apache-2.0
#include "city/layout/shared_walls.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "city/layout/courts.h"

namespace helio {

namespace {

constexpr double kWallGap = 0.3;              // m
constexpr double kAntiparallel = -0.98480775; // cos of 170 degrees

struct Wall
{
    glm::dvec2 a, b;
    u32 footprint;
};

struct Cover
{
    double from, to; // along the edge, 0..1
    double height;
};

// The part of `wall` that `other` stands against, if any.
bool coverOf(const Wall& wall, const Wall& other, Cover& cover)
{
    const glm::dvec2 along = wall.b - wall.a, against = other.b - other.a;
    const double length = glm::length(along), otherLength = glm::length(against);
    if (length <= 0.0 || otherLength <= 0.0) return false;
    if (glm::dot(along, against) > kAntiparallel * length * otherLength) return false;
    const auto position = [&](const glm::dvec2& p) { return glm::dot(p - wall.a, along) / (length * length); };
    const double start = position(other.b), end = position(other.a); // antiparallel: b comes first
    cover.from = std::max(0.0, start);
    cover.to = std::min(1.0, end);
    if (cover.to <= cover.from) return false;
    for (const double t : {cover.from, cover.to}) {
        const glm::dvec2 point = glm::mix(other.b, other.a, (t - start) / (end - start));
        if (std::abs(cross(along, point - wall.a)) > kWallGap * length) return false;
    }
    return true;
}

// Length of the union of intervals.
double unionLength(std::vector<Cover> covers)
{
    std::sort(covers.begin(), covers.end(), [](const Cover& x, const Cover& y) { return x.from < y.from; });
    double sum = 0.0, end = 0.0;
    for (const Cover& cover : covers) {
        sum += std::max(0.0, cover.to - std::max(cover.from, end));
        end = std::max(end, cover.to);
    }
    return sum;
}

// The largest height that at least half of the edge is covered up to.
double coveredHalf(std::vector<Cover> covers)
{
    std::stable_sort(covers.begin(), covers.end(), [](const Cover& x, const Cover& y) { return x.height > y.height; });
    for (size_t n = 1; n <= covers.size(); ++n)
        if (unionLength({covers.begin(), covers.begin() + long(n)}) >= 0.5 - 1e-9) return covers[n - 1].height;
    return 0.0;
}

template <class Visit> void forEachEdge(const Polygon2& outline, Visit&& visit)
{
    const auto walk = [&](const Ring2& ring) {
        for (size_t i = 0; i < ring.size(); ++i) visit(ring[i], ring[(i + 1) % ring.size()]);
    };
    walk(outline.outer);
    for (const Ring2& hole : outline.holes) walk(hole);
}

} // namespace

void findSharedWalls(Layout& layout)
{
    std::vector<Wall> walls;
    BoxGrid grid(16.0);
    for (u32 f = 0; f < layout.footprints.size(); ++f) {
        forEachEdge(layout.footprints[f].outline, [&](const glm::dvec2& a, const glm::dvec2& b) {
            grid.insert({glm::min(a, b), glm::max(a, b)}, u32(walls.size()));
            walls.push_back({a, b, f});
        });
    }
    for (Footprint& footprint : layout.footprints) footprint.coveredHeight.clear();
    for (const Wall& wall : walls) {
        Footprint& own = layout.footprints[wall.footprint];
        const Box2 box{glm::min(wall.a, wall.b), glm::max(wall.a, wall.b)};
        std::vector<Cover> covers;
        for (const u32 candidate : grid.touching(box.grown(kWallGap))) {
            const Wall& other = walls[candidate];
            Cover cover{};
            if (other.footprint == wall.footprint || !coverOf(wall, other, cover)) continue;
            const Footprint& neighbour = layout.footprints[other.footprint];
            cover.height = neighbour.base + neighbour.height - own.base;
            if (cover.height > 0.0) covers.push_back(cover);
        }
        own.coveredHeight.push_back(coveredHalf(std::move(covers)));
    }
}

void chooseFronts(Layout& layout)
{
    const PolygonIndex courts(enclosedCourts(layout.footprints));
    for (Footprint& footprint : layout.footprints) {
        Ring2& ring = footprint.outline.outer;
        // Rank: free on the street, free on a court, partly free, covered; then the exposed wall, then the order given.
        size_t front = 0;
        int bestRank = -1;
        double bestSize = -1.0;
        for (size_t i = 0; i < ring.size(); ++i) {
            const glm::dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
            const double length = glm::distance(a, b);
            const double exposed = std::max(0.0, footprint.height - footprint.coveredHeight[i]);
            int rank = exposed > 0.0 ? 1 : 0;
            if (footprint.coveredHeight[i] == 0.0) {
                const glm::dvec2 outward(b.y - a.y, a.x - b.x);
                rank = courts.contains(0.5 * (a + b) + 0.5 / length * outward) ? 2 : 3;
            }
            const double size = rank > 0 ? length * exposed : length;
            // A hair of preference for what came first keeps the choice stable for equal edges.
            if (rank > bestRank || (rank == bestRank && size > bestSize * (1.0 + 1e-6)))
                front = i, bestRank = rank, bestSize = size;
        }
        std::rotate(ring.begin(), ring.begin() + long(front), ring.end());
        const auto covered = footprint.coveredHeight.begin();
        std::rotate(covered, covered + long(front), covered + long(ring.size()));
    }
}

} // namespace helio
