// SPDX-License-Identifier: Apache-2.0
#include "city/layout/projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

using namespace helio;

namespace {

TEST(TransverseMercator, AgreesWithPublishedValues)
{
    // PROJ's regression tests (test/gie/builtins.gie, tmerc and utm zone 30, both on GRS 80; the ellipsoid of WGS 84
    // differs from it by 0.1 mm in the semi-minor axis).
    const glm::dvec2 p = TransverseMercator({0.0, 0.0}).forward({1.0, 2.0});
    EXPECT_NEAR(p.x, 222650.796797586, 1e-4);
    EXPECT_NEAR(p.y, 110642.229411933, 1e-4);
    const TransverseMercator zone30({0.0, -3.0}, 0.9996);
    const glm::dvec2 q = zone30.forward({1.0, 2.0});
    EXPECT_NEAR(q.x + 5e5, 1057002.405491298, 1e-4);
    EXPECT_NEAR(q.y, 110955.141175949, 1e-4);
    // Karney, GeographicLib's UTMUPS example: Baghdad in zone 38n.
    const glm::dvec2 baghdad = TransverseMercator({0.0, 45.0}, 0.9996).forward({33.3, 44.4});
    EXPECT_NEAR(baghdad.x + 5e5, 444140.54, 0.005);
    EXPECT_NEAR(baghdad.y, 3684706.36, 0.005);
}

TEST(TransverseMercator, KeepsTheMeridianArcAndTheScaleOnIt)
{
    // From the equator to the pole: 10,001,965.7293 m on WGS 84.
    const TransverseMercator equator({0.0, 9.0});
    EXPECT_NEAR(equator.forward({90.0, 9.0}).y, 10001965.7293, 1e-4);
    // One arc second north at 50 degrees, radius of curvature a (1 - e2) / (1 - e2 sin2)^1.5.
    const double e2 = 0.0066943799901413165, s = std::sin(50.0 * std::numbers::pi / 180.0);
    const double radius = 6378137.0 * (1.0 - e2) / std::pow(1.0 - e2 * s * s, 1.5);
    const TransverseMercator prague({50.0, 14.0});
    const double second = std::numbers::pi / 180.0 / 3600.0;
    EXPECT_NEAR(prague.forward({50.0 + 1.0 / 3600.0, 14.0}).y, radius * second, 1e-4);
    EXPECT_NEAR(prague.forward({50.0, 14.0 + 1.0 / 3600.0}).x,
                6378137.0 / std::sqrt(1.0 - e2 * s * s) * std::cos(50.0 * std::numbers::pi / 180.0) * second, 1e-4);
    EXPECT_EQ(prague.forward({50.0, 14.0}), glm::dvec2(0.0));
}

TEST(TransverseMercator, ComesBack)
{
    for (const double latitude : {-80.0, -33.9, 0.0, 43.7, 78.0}) {
        const TransverseMercator projection({latitude, 179.5}); // the far side of the date line included
        for (const double north : {-0.4, 0.0, 0.3}) {
            for (const double east : {-0.9, 0.0, 1.2}) {
                const GeoPoint point{latitude + north, 179.5 + east};
                const GeoPoint back = projection.inverse(projection.forward(point));
                EXPECT_NEAR(back.latitudeDeg, point.latitudeDeg, 1e-12);
                EXPECT_NEAR(std::remainder(back.longitudeDeg - point.longitudeDeg, 360.0), 0.0, 1e-12);
                EXPECT_LT(std::abs(projection.forward(point).x), 150000.0);
            }
        }
    }
}

TEST(Crs, TellsDegreesFromMetres)
{
    for (const char* name : {"EPSG:4326", "urn:ogc:def:crs:OGC:1.3:CRS84", "urn:ogc:def:crs:EPSG::4258"})
        EXPECT_TRUE(isGeographicCrs(name)) << name;
    for (const char* name : {"", "EPSG:28992 (RD New) + NAP", "EPSG:32632"})
        EXPECT_FALSE(isGeographicCrs(name)) << name;
}

TEST(Crs, PlacesUtmCoordinates)
{
    for (const char* name :
         {"EPSG:32638", "urn:ogc:def:crs:EPSG::32638", "http://www.opengis.net/def/crs/EPSG/0/32638"}) {
        const auto baghdad = placeOfUtm(name, {444140.54, 3684706.36, 0.0});
        ASSERT_TRUE(baghdad) << name;
        EXPECT_NEAR(baghdad->latitudeDeg, 33.3, 1e-7);
        EXPECT_NEAR(baghdad->longitudeDeg, 44.4, 1e-7);
    }
    const auto south = placeOfUtm("EPSG:32738", {444140.54, 1e7 - 3684706.36, 0.0});
    ASSERT_TRUE(south);
    EXPECT_NEAR(south->latitudeDeg, -33.3, 1e-7);
    EXPECT_FALSE(placeOfUtm("EPSG:32638", {6625.0, 6047.0, 0.0})); // shifted: no easting of a zone
    EXPECT_FALSE(placeOfUtm("EPSG:28992", {444140.54, 3684706.36, 0.0}));
    EXPECT_FALSE(placeOfUtm("EPSG:32661", {444140.54, 3684706.36, 0.0})); // polar
    EXPECT_FALSE(placeOfUtm("EPSG:3263", {444140.54, 3684706.36, 0.0}));
    EXPECT_FALSE(placeOfUtm("EPSG", {444140.54, 3684706.36, 0.0}));
}

TEST(Projection, NamesOfOneCrsAreTheSame)
{
    EXPECT_TRUE(isSameCrs("EPSG:32632 (UTM 32N) minus origin", "urn:ogc:def:crs:EPSG:6.9:32632"));
    EXPECT_TRUE(isSameCrs("EPSG:28992 (RD New) + NAP", "https://www.opengis.net/def/crs/EPSG/0/7415"));
    EXPECT_TRUE(isSameCrs("urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326"));
    EXPECT_TRUE(isSameCrs("a local grid", "a local grid"));
    EXPECT_FALSE(isSameCrs("EPSG:32632", "EPSG:32633"));
    EXPECT_FALSE(isSameCrs("EPSG:32632", "EPSG:4326"));
    EXPECT_FALSE(isSameCrs("a local grid", "another"));
}

} // namespace
