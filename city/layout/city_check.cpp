// SPDX-License-Identifier: Apache-2.0
#include "city/layout/city_check.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "city/geometry/clip.h"
#include "city/layout/polygon_repair.h"

namespace helio {

namespace {

constexpr double kSlit = 0.5;      // m: what is narrower between two houses is a flaw of the plan
constexpr double kSplinter = 0.45; // m: depths of neighbours differ by 0.5 at least

double distanceToRing(const glm::dvec2& p, const Ring2& ring)
{
    double least = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 a = ring[i], along = ring[(i + 1) % ring.size()] - a;
        const double t = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
        least = std::min(least, glm::distance(p, a + t * along));
    }
    return least;
}

// Houses meet in whole party walls or not at all: no corner of one stands at a wall of another without being one of its
// corners.
bool meetsInCorners(const Ring2& house, const Ring2& other)
{
    return std::all_of(house.begin(), house.end(), [&](const glm::dvec2& p) {
        return std::find(other.begin(), other.end(), p) != other.end() || distanceToRing(p, other) > kSlit;
    });
}

double shortestEdge(const Ring2& ring)
{
    double least = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < ring.size(); ++i)
        least = std::min(least, glm::distance(ring[i], ring[(i + 1) % ring.size()]));
    return least;
}

} // namespace

bool isBuildable(const std::vector<Lot>& lots)
{
    ClipperLib::Paths houses;
    double sum = 0.0;
    for (const Lot& lot : lots) {
        if (signedArea(lot.outline.outer) <= 0.0 || !isSimple(lot.outline)) return false;
        if (shortestEdge(lot.outline.outer) < kSplinter) return false;
        sum += area(lot.outline);
        appendRings(houses, lot.outline);
        for (const Lot& other : lots)
            if (&other != &lot && !meetsInCorners(lot.outline.outer, other.outline.outer)) return false;
    }
    return sum - areaOf(unite(houses)) < 0.05;
}

} // namespace helio
