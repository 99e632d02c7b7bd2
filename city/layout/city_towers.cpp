// SPDX-License-Identifier: Apache-2.0
#include "city/layout/city_towers.h"

#include <glm/geometric.hpp>
#include <utility>

#include "city/geometry/clip.h"

namespace helio {

namespace {

constexpr double kForecourt = 5.0, kBetweenTowers = 15.0, kAroundHall = 10.0; // m

bool fits(const Polygon2& polygon, const ClipperLib::Paths& land, const std::vector<Polygon2>& others, double distance)
{
    if (areaOf(subtract(toPaths(polygon), land)) > 0.05) return false;
    ClipperLib::Paths built;
    for (const Polygon2& other : others) appendRings(built, other);
    return areaOf(intersect(offset(toPaths(polygon), distance), built)) == 0.0;
}

// A lot on an edge of the block, at its beginning or its end.
struct Site
{
    size_t edge;
    bool atEnd;
};

std::vector<Polygon2> tryTowers(Random& random, const CityBlock& block, const ClipperLib::Paths& land, u32 wanted)
{
    const size_t n = block.outline.size();
    std::vector<Site> sites;
    for (size_t i = 0; i < n; ++i)
        for (const bool atEnd : {false, true}) sites.push_back({i, atEnd});
    for (size_t i = sites.size(); i > 1; --i) std::swap(sites[i - 1], sites[below(random, u32(i))]);

    std::vector<Polygon2> towers;
    for (const Site& site : sites) {
        if (towers.size() == wanted) break;
        const glm::dvec2 a = block.outline[site.edge], b = block.outline[(site.edge + 1) % n];
        const glm::dvec2 along = glm::normalize(b - a), inward(-along.y, along.x);
        const double size = 18.0 + below(random, 5), depth = 18.0 + below(random, 5);
        // From the corner along the edge until the neighbouring side is far enough too.
        for (double shift = kForecourt; shift < 14.0; shift += 0.5) {
            const glm::dvec2 start = site.atEnd ? b - (shift + size) * along : a + shift * along;
            const Polygon2 lot = orientedBox(start + kForecourt * inward, along, size, depth);
            if (!fits(lot, land, towers, kBetweenTowers)) continue;
            towers.push_back(lot);
            break;
        }
    }
    return towers;
}

} // namespace

TowerPlace placeTowers(Random& random, const CityBlock& block)
{
    // A little more land than asked for, because the lots are rounded to millimetres.
    const ClipperLib::Paths land = offset({toGrid(block.outline)}, -kForecourt + 0.01);
    TowerPlace place;
    const u32 wanted = 3 + below(random, 2);
    for (u32 attempt = 0; attempt < 12 && place.towers.size() < wanted; ++attempt) {
        std::vector<Polygon2> towers = tryTowers(random, block, land, wanted);
        if (towers.size() > place.towers.size()) place.towers = std::move(towers);
    }

    const glm::dvec2 a = block.outline[0], along = glm::normalize(block.outline[1] - a), inward(-along.y, along.x);
    for (u32 attempt = 0; attempt < 64 && place.halls.empty(); ++attempt) {
        const glm::dvec2 corner = a + range(random, 5.0, 70.0) * along + range(random, 5.0, 80.0) * inward;
        const Polygon2 hall = orientedBox(corner, along, range(random, 14.0, 18.0), range(random, 10.0, 12.0));
        if (fits(hall, land, place.towers, kAroundHall)) place.halls.push_back(hall);
    }
    return place;
}

} // namespace helio
