// SPDX-License-Identifier: Apache-2.0
#include "city/model/convex_hull.h"

#include <algorithm>

namespace helio {

Ring2 convexHull(std::span<const glm::dvec2> points)
{
    std::vector<glm::dvec2> sorted(points.begin(), points.end());
    std::sort(sorted.begin(), sorted.end(),
              [](const glm::dvec2& a, const glm::dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    if (sorted.size() < 3) return sorted;
    const auto turnsLeft = [](const glm::dvec2& o, const glm::dvec2& a, const glm::dvec2& b) {
        return cross(o, a, b) > 0.0;
    };
    Ring2 hull;
    const auto chain = [&](auto begin, auto end) {
        const size_t base = hull.size();
        for (auto it = begin; it != end; ++it) {
            while (hull.size() >= base + 2 && !turnsLeft(hull[hull.size() - 2], hull.back(), *it)) hull.pop_back();
            hull.push_back(*it);
        }
        hull.pop_back(); // The end of one chain is the start of the other.
    };
    chain(sorted.begin(), sorted.end());
    chain(sorted.rbegin(), sorted.rend());
    return hull;
}

} // namespace helio
