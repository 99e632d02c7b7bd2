// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string_view>

#include "city/base/result.h"
#include "city/layout/box_grid.h"
#include "city/model/footprint.h"

namespace helio {

struct ImportOptions
{
    double defaultHeight = 12.0;   ///< m, for a footprint without any hint of its height
    double storeyHeight = 3.2;     ///< m per level, where only `levels` is given: height = levels * storeyHeight + 1
    double neighbourRadius = 50.0; ///< m: a missing height is the median of the known ones within it; 0 = never
    std::filesystem::path streets =
        {};                        ///< GeoJSON with LineStrings in the footprints' CRS; empty: those of the city's file
    std::optional<Box2> bbox = {}; ///< only footprints whose centroid lies inside, in the file's own coordinates
    std::optional<u32> limit = {}; ///< only the first features, in file order, of those that bbox leaves
    bool keepFirstEdge = false;    ///< the file's first edge is the front; else it is chosen (chooseFronts)
    bool lod2 = false;             ///< CityJSON: take the walls and roofs that the file models (Footprint::faces)
};

/// Reads a city, told apart by content: GeoJSON (Polygon, MultiPolygon; LineString and MultiLineString are streets),
/// CityJSON 1.0/1.1/2.0 or CityJSONSeq. Coordinates are metres (x east, y north), or longitude and latitude, which are
/// projected (Layout::latitudeDeg, longitudeDeg and crs say where to). The result is clean: rings closed, simple, outer
/// ring counter-clockwise and holes clockwise, no corner twice within 1 mm, no edge below 0.1 m, no piece below 1 m2,
/// parts in place of their outlines, no footprint twice, no id twice, no two that overlap by more than 0.5 m2; the
/// front edge comes first; covered, onStreet (where streets are known) and heights are filled. Layout::origin is the
/// file's origin plus the offset subtracted here (centre of the bounding box, rounded to 1 m). Layout::counts holds the
/// census of the input as delivered (city/layout/census.h) and "repaired.*", "skipped.*", "height.*"; Layout::notes
/// names every feature that was repaired or skipped, the first 20 of a kind.
///
/// Errors (one line; file, and line or feature): not readable, not JSON, no format that is known, no usable footprint,
/// streets in another CRS, or none near the footprints.
Result<Layout> importCity(const std::filesystem::path& path, const ImportOptions& options = {});

/// The same from a text; `name` stands for the file in messages. Reads no file but ImportOptions::streets.
Result<Layout> parseCity(std::string_view text, std::string_view name, const ImportOptions& options = {});

} // namespace helio
