// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string_view>

#include "city/base/result.h"
#include "city/model/footprint.h"

namespace helio {

struct ImportOptions
{
    double defaultHeight = 12.0;  ///< m, for a footprint without any hint of its height
    double storeyHeight = 3.2;    ///< m per level, where only `levels` is given: height = levels * storeyHeight + 1
    double neighbourRadius = 0.0; ///< m: a missing height is the median of the known ones within it; 0 = never
};

/// Reads building footprints: a FeatureCollection, Feature or bare geometry of Polygon and MultiPolygon, metres, x
/// east, y north. The result is clean: rings closed, simple, outer ring counter-clockwise and holes clockwise, no
/// corner twice within 1 mm, no edge below 0.1 m, no piece below 1 m2, no two footprints that overlap by more than 0.5
/// m2; the front edge comes first and coveredHeight is filled. Layout::origin is the file's metadata.origin plus the
/// offset subtracted here (centre of the bounding box, rounded to 1 m). What had to be repaired or skipped is one line
/// each in Layout::notes.
///
/// Errors (one line; file, and line or feature): not readable, not JSON, not GeoJSON, longitudes and latitudes, no
/// usable footprint.
Result<Layout> importGeoJson(const std::filesystem::path& path, const ImportOptions& options = {});

/// The same from a text; `name` stands for the file in messages.
Result<Layout> parseGeoJson(std::string_view text, std::string_view name, const ImportOptions& options = {});

} // namespace helio
