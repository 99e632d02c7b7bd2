// SPDX-License-Identifier: Apache-2.0
#include "city/layout/courts.h"

#include <algorithm>

#include "city/geometry/clip.h"
#include "city/layout/polygon_repair.h"

namespace helio {

namespace {

constexpr double kLargestCourt = 20000.0; // m2: a ring of buildings around more than this is a quarter with streets

// Holes of the footprints grown by `closing`, grown back by as much.
void appendHoles(ClipperLib::Paths& holes, const ClipperLib::Paths& buildings, double closing)
{
    for (ClipperLib::Path& path : offset(buildings, closing)) {
        if (ClipperLib::Orientation(path)) continue;
        ClipperLib::ReversePath(path);
        const ClipperLib::Paths court = offset({path}, closing);
        if (areaOf(court) <= kLargestCourt) holes.insert(holes.end(), court.begin(), court.end());
    }
}

} // namespace

std::vector<Polygon2> enclosedCourts(std::span<const Footprint> footprints)
{
    ClipperLib::Paths buildings;
    for (const Footprint& footprint : footprints) appendRings(buildings, footprint.outline);
    buildings = unite(buildings);
    ClipperLib::Paths holes;
    appendHoles(holes, buildings, 1.5);
    appendHoles(holes, buildings, 0.05); // light wells, which the wide closing fills
    return subtractToPolygons(holes, {});
}

PolygonIndex::PolygonIndex(std::vector<Polygon2> polygons) : polygons_(std::move(polygons)), grid_(32.0)
{
    for (u32 i = 0; i < polygons_.size(); ++i) grid_.insert(boxOf(polygons_[i].outer), i);
}

bool PolygonIndex::contains(const glm::dvec2& point) const
{
    const auto isInside = [&](u32 item) {
        const Polygon2& polygon = polygons_[item];
        return helio::contains(polygon.outer, point) &&
               std::none_of(polygon.holes.begin(), polygon.holes.end(),
                            [&](const Ring2& hole) { return helio::contains(hole, point); });
    };
    const std::vector<u32> near = grid_.touching({point, point});
    return std::any_of(near.begin(), near.end(), isInside);
}

} // namespace helio
