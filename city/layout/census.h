// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <span>
#include <string>

#include "city/layout/geojson_features.h"

namespace helio {

/// Counts the defects of a city as delivered (metres, near the origin, before any repair), by the names of the data
/// sets' statistics. Of polygons: "polygons", "with_holes", "holes", "vertices" (corners of all rings, the closing one
/// not counted), "missing_height"; "clockwise_outer"; "invalid" and "invalid_kinds.KIND" (polygonFindings);
/// "rings_not_closed" (rings); "has_duplicate_vertex(<1mm)" and "has_short_edge(1mm..0.25m)" in any ring;
/// "has_collinear_vertex" (turns by less than 0.01 rad) in the outer ring; "spike_vertices" (corners of any ring that
/// turn back by more than 179 degrees); of the outer ring "non_convex(<95% hull)" (area below 0.95 of the convex
/// hull's) and "slivers(compactness<0.12)" (4 pi area / perimeter^2); "tiny(<4m2)", holes subtracted;
/// "in_shared_wall(>0.5m)": an edge runs along one of another polygon's, within 0.05 m and 1 degree, over more than 0.5
/// m. Of pairs: "overlapping_pairs(>0.5m2)". Of polygons equal to an earlier one: "duplicate_footprints".
std::map<std::string, u32> censusOf(std::span<const GeoFeature> features);

} // namespace helio
