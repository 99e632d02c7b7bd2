// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "city/base/types.h"
#include "city/model/polygon.h"

// What a roof stands on.
namespace helio {

/// A simple polygon on the 0.1 mm grid, with the edges of the base that its edges came from.
struct RoofBase
{
    Polygon2 polygon;
    std::vector<u32> edge; ///< per edge (outer ring, then holes) an edge of the base as it was given
};

/// Number of edges, or corners, of a polygon.
u32 edgeCount(const Polygon2& polygon);
/// Ends of all edges, outer ring first, then holes.
std::vector<std::pair<glm::dvec2, glm::dvec2>> edgesOf(const Polygon2& polygon);

/// True if no two edges touch but neighbours at their corner, and no corner is there twice; exact on the 0.1 mm grid.
/// Edges of one polygon: O(n^2).
bool isSimpleOnGrid(const Polygon2& polygon);

/// The base as simple polygons of at least 0.01 m2: itself where it is simple, with corners on the grid and without
/// edges shorter and needles narrower than 1 mm; else what the union of its rings (non-zero winding) gives, 0.5 mm
/// smaller where that touches itself or falls into several polygons. Empty where it has no area, is not finite or is
/// larger than 50 km.
std::vector<RoofBase> cleanBase(const Polygon2& base);

/// The base grown by a distance per edge (m, >= 0), corners mitred. Where that is no simple polygon, or a miter is
/// longer than four times the distance: the base grown by the largest distance everywhere, sharp corners cut.
std::optional<RoofBase> growBase(const RoofBase& base, std::span<const double> distances);

/// The base without its touching places: 0.5 mm smaller on every side. Nothing if it falls into pieces.
std::optional<RoofBase> loosenBase(const RoofBase& base);

} // namespace helio
