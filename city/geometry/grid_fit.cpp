// SPDX-License-Identifier: Apache-2.0
#include "city/geometry/grid_fit.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace helio {

namespace {

template <class Map> Polygon2 mapped(const Polygon2& polygon, Map&& map)
{
    Polygon2 result = polygon;
    for (glm::dvec2& corner : result.outer) corner = map(corner);
    for (Ring2& hole : result.holes)
        for (glm::dvec2& corner : hole) corner = map(corner);
    return result;
}

} // namespace

GridBounds gridBounds(const Polygon2& polygon)
{
    if (polygon.outer.empty()) return {};
    GridBounds box{polygon.outer[0], polygon.outer[0]};
    for (const glm::dvec2& corner : polygon.outer) {
        box.low = glm::min(box.low, corner);
        box.high = glm::max(box.high, corner);
    }
    return box;
}

GridFit::GridFit(const GridBounds& bounds)
{
    // Half the limit, so that what is cut out of the polygon's surroundings fits too.
    constexpr double kRoom = 0.5 * kGridLimit;
    const double farthest = std::max({-bounds.low.x, -bounds.low.y, bounds.high.x, bounds.high.y});
    if (farthest <= kRoom) return;
    centre_ = 0.5 * (bounds.low + bounds.high);
    const glm::dvec2 half = 0.5 * bounds.size();
    while (std::max(half.x, half.y) > kRoom * unit_) unit_ *= 2.0;
}

Polygon2 GridFit::toLocal(const Polygon2& polygon) const
{
    return mapped(polygon, [&](const glm::dvec2& p) { return (p - centre_) / unit_; });
}

Polygon2 GridFit::fromLocal(const Polygon2& polygon) const
{
    return mapped(polygon, [&](const glm::dvec2& p) { return p * unit_ + centre_; });
}

} // namespace helio
