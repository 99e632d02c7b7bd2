// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "city/layout/box_grid.h"
#include "city/model/footprint.h"

namespace helio {

/// Areas that buildings enclose: what is open to the sky inside a ring of footprints whose gaps are below 3 m, up to
/// 20,000 m2. They reach up to the walls and may overlap them by the rounding of mitered corners.
std::vector<Polygon2> enclosedCourts(std::span<const Footprint> footprints);

/// Answers whether a point lies in one of many polygons.
class PolygonIndex
{
public:
    explicit PolygonIndex(std::vector<Polygon2> polygons);
    bool contains(const glm::dvec2& point) const;

private:
    std::vector<Polygon2> polygons_;
    BoxGrid grid_;
};

} // namespace helio
