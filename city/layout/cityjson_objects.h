// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "city/layout/geojson_features.h"

// Buildings and their parts in a "CityObjects" of CityJSON. Internal to city/layout.
namespace helio {

/// m; more is a mistake in the unit.
inline constexpr double kLargestHeight = 1000.0;

/// The ids of those that have a BuildingPart with surfaces, by the part's `parents` or their own `children`.
std::set<std::string> buildingsWithParts(const nlohmann::json& objects);

/// The scalar attributes of an object into `feature`, after those of its parents up to the eighth: height (height, else
/// measuredHeight) and levels (levels, storeysAboveGround) too where they are usable.
void readAttributes(const nlohmann::json& object, const nlohmann::json& objects, GeoFeature& feature);

/// The geometries with surfaces, best first: the highest LoD below 3, then down; then those from 3 up.
std::vector<const nlohmann::json*> rankedGeometries(const nlohmann::json& object);

} // namespace helio
