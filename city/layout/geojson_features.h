// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string_view>

#include "city/base/result.h"
#include "city/model/footprint.h"

// What stands in a GeoJSON file, before any repair. Internal to city/layout.
namespace helio {

struct GeoFeature
{
    std::string id;                              ///< `id`, else properties.id, else "#" and the number of the feature
    std::vector<Polygon2> polygons;              ///< as drawn but for the closing corner, in the file's coordinates
    u32 openRings = 0;                           ///< rings whose last corner was not the first one again
    std::optional<double> height;                ///< m, from properties.height; > 0
    std::optional<double> levels;                ///< from properties.levels or building:levels; > 0
    std::map<std::string, Attribute> attributes; ///< the other scalar properties
    bool isPart = false;                         ///< the file says that it is a part of a building
    std::vector<GivenFace> faces;                ///< walls and roofs that the file models, in its coordinates
};

struct GeoFile
{
    std::vector<GeoFeature> features; ///< those with polygons
    std::vector<Ring2> streets;       ///< LineStrings: open lines of two points or more, in the file's coordinates
    glm::dvec3 origin{0.0};           ///< metadata.origin
    std::string crs;                  ///< metadata.crs, else the name in `crs`
    bool metric = false;              ///< the file states that its coordinates are metres
    std::vector<std::string> notes;   ///< one line for a feature that is skipped or whose height cannot be read
};

/// Reads the text of a GeoJSON file (FeatureCollection, Feature, geometry or GeometryCollection): Polygon and
/// MultiPolygon make features, LineString and MultiLineString streets. `name` stands for the file. Errors: not JSON
/// (with line and byte), not GeoJSON.
Result<GeoFile> readGeoFeatures(std::string_view text, std::string_view name);

} // namespace helio
