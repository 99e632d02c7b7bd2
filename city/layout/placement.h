// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/layout/geojson_features.h"
#include "city/layout/import.h"
#include "city/layout/import_notes.h"
#include "city/layout/projection.h"

// From a file's coordinates to those of a layout. Internal to city/layout.
namespace helio {

/// What a file holds of a city, in metres around Layout::origin, within half of kGridLimit.
struct PlacedCity
{
    std::vector<GeoFeature> features;
    std::vector<Ring2> streets; ///< those that come within 100 m of the features' bounding box
    glm::dvec3 origin{0.0};
    std::string crs;
    std::optional<GeoPoint> place; ///< of the origin
};

/// True if the file's coordinates are longitude and latitude: by its CRS; where it states neither a CRS nor metres, if
/// more than half of the features lie within +-180 and +-90 and are smaller than 0.05.
bool isInDegrees(const GeoFile& file);

/// Leaves out features by ImportOptions::bbox and limit, and those that cannot be of this city (coordinates that are
/// not finite or beyond 1e7 m, of the other kind of CRS, more than 50 km from the median one; over 20,000 corners, or
/// edges that meet in over 10,000 places), with a note each. Longitudes and latitudes are projected
/// (TransverseMercator, centred on the bounding box of what is left); of metres the centre of the bounding box, rounded
/// to 1 m, is subtracted. Features on both sides of the antimeridian
/// come together. Without a feature left, or with ImportOptions::streets and no line left: an error that tells why.
Result<PlacedCity> placeCity(GeoFile file, std::string_view name, const ImportOptions& options, ImportNotes& notes);

} // namespace helio
