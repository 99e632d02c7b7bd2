// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace helio {

/// A place on the WGS 84 ellipsoid, degrees; north and east positive.
struct GeoPoint
{
    double latitudeDeg = 0.0, longitudeDeg = 0.0;
};

/// Transverse Mercator on the WGS 84 ellipsoid around a centre: x east, y north of it, m. Krueger's series to the sixth
/// order of the third flattening, as Karney gives it ("Transverse Mercator with an accuracy of a few nanometers",
/// J. Geodesy 85, 2011, eqs. 7-12, 35, 36): below 1 micrometre within 3000 km of the central meridian.
class TransverseMercator
{
public:
    /// |latitude| <= 90; `scale` on the central meridian, > 0.
    explicit TransverseMercator(const GeoPoint& centre, double scale = 1.0);
    glm::dvec2 forward(const GeoPoint& point) const;
    GeoPoint inverse(const glm::dvec2& point) const;
    const GeoPoint& centre() const { return centre_; }

private:
    GeoPoint centre_;
    double radius_;          ///< scale times the rectifying radius, m
    double northOffset_ = 0; ///< of the centre above the equator, m
};

/// True if the name of a CRS is one whose coordinates are longitude and latitude (EPSG 4326, 4258, 4979, CRS84).
bool isGeographicCrs(std::string_view crs);

/// True if the names of two CRSs mean the same coordinates on the ground, as far as names tell: both geographic, or of
/// the same EPSG code however it is written ("EPSG:32632 (UTM 32N)", "urn:ogc:def:crs:EPSG::32632"; 7415, which adds
/// heights to 28992, is the same as that), or, without a code, the same text.
bool isSameCrs(std::string_view a, std::string_view b);

/// Where a point with UTM coordinates lies, if `crs` names a UTM zone on WGS 84 (EPSG:326zz, 327zz) and the coordinates
/// are those of a zone (easting 100-900 km, northing 0-10,000 km).
std::optional<GeoPoint> placeOfUtm(std::string_view crs, const glm::dvec3& point);

} // namespace helio
