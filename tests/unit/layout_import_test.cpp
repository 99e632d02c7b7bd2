// SPDX-License-Identifier: Apache-2.0
#include "city/layout/import.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <iomanip>
#include <numbers>
#include <sstream>

using namespace helio;

namespace {

// A feature with one ring, closed here.
std::string ring(const std::string& id, const Ring2& corners, const std::string& properties = "")
{
    std::ostringstream out;
    out << std::setprecision(17) << R"({"type":"Feature","id":")" << id << R"(","properties":{)" << properties
        << R"(},"geometry":{"type":"Polygon","coordinates":[[)";
    for (const glm::dvec2& p : corners) out << "[" << p.x << "," << p.y << "],";
    out << "[" << corners[0].x << "," << corners[0].y << "]]]}}";
    return out.str();
}

std::string box(const std::string& id, double x, double y, double w, double h, const std::string& properties = "")
{
    return ring(id, {{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}}, properties);
}

std::string line(const std::string& coordinates, const std::string& type = "LineString")
{
    return R"({"type":"Feature","properties":{},"geometry":{"type":")" + type + R"(","coordinates":)" + coordinates +
           "}}";
}

std::string collection(const std::vector<std::string>& features, const std::string& head = "")
{
    std::string text = R"({"type":"FeatureCollection",)" + head + R"("features":[)";
    for (size_t i = 0; i < features.size(); ++i) text += (i ? ",\n" : "\n") + features[i];
    return text + "]}";
}

Layout parse(const std::string& text, const ImportOptions& options = {})
{
    Result<Layout> layout = parseCity(text, "city.geojson", options);
    EXPECT_TRUE(layout.ok()) << (layout.ok() ? "" : layout.error().message);
    return layout.ok() ? std::move(*layout) : Layout{};
}

std::string idsOf(const Layout& layout)
{
    std::vector<std::string> ids;
    for (const Footprint& footprint : layout.footprints) ids.push_back(footprint.id);
    std::sort(ids.begin(), ids.end());
    std::string text;
    for (const std::string& id : ids) text += (text.empty() ? "" : " ") + id;
    return text;
}

const Footprint& byId(const Layout& layout, const std::string& id)
{
    for (const Footprint& footprint : layout.footprints)
        if (footprint.id == id) return footprint;
    ADD_FAILURE() << "no footprint " << id;
    static const Footprint none;
    return none;
}

u32 countOf(const Layout& layout, const std::string& name)
{
    const auto place = layout.counts.find(name);
    return place == layout.counts.end() ? 0 : place->second;
}

bool hasNote(const Layout& layout, const std::string& words)
{
    return std::any_of(layout.notes.begin(), layout.notes.end(),
                       [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

TEST(Import, SelectsByBoxAndLimitInTheFilesOwnCoordinates)
{
    std::vector<std::string> features;
    for (int i = 0; i < 6; ++i) features.push_back(box(std::to_string(i), 5000.0 + 20.0 * i, 3000.0, 10, 10));
    const std::string text = collection(features, R"("metadata":{"origin":[100000,200000]},)");
    // Centroids at 5005, 5025, ...: the box holds those of 1, 2 and 3, though it cuts 3 and only reaches into 0.
    const ImportOptions inBox{.bbox = Box2{{5008, 2990}, {5066, 3020}}};
    EXPECT_EQ(idsOf(parse(text, inBox)), "1 2 3");
    EXPECT_EQ(idsOf(parse(text, {.limit = 2})), "0 1");
    ImportOptions both = inBox;
    both.limit = 2;
    EXPECT_EQ(idsOf(parse(text, both)), "1 2");
    EXPECT_EQ(countOf(parse(text, both), "polygons"), 2u);
    const Result<Layout> none = parseCity(text, "city.geojson", {.bbox = Box2{{0, 0}, {1, 1}}});
    ASSERT_FALSE(none.ok());
    EXPECT_NE(none.error().message.find("bounding box"), std::string::npos);
}

// The longest free edge is the front unless the file's own first edge shall be; a clockwise ring keeps it when it
// turns.
TEST(Import, ChoosesTheFrontOrKeepsTheFirstEdge)
{
    const Ring2 turning = {{18, 0}, {18, 14}, {0, 14}, {0, 0}}, clockwise = {{18, 14}, {18, 0}, {0, 0}, {0, 14}};
    for (const Ring2& given : {turning, clockwise}) {
        const std::string city = collection({ring("a", given, R"("height":9)")});
        const auto frontOf = [](const Layout& layout) {
            const Ring2& outer = layout.footprints.at(0).outline.outer;
            return outer[1] - outer[0];
        };
        EXPECT_NEAR(glm::length(frontOf(parse(city))), 18.0, 1e-9);
        ImportOptions options;
        options.keepFirstEdge = true;
        const glm::dvec2 front = frontOf(parse(city, options));
        EXPECT_NEAR(front.x, 0.0, 1e-9);
        EXPECT_NEAR(front.y, 14.0, 1e-9);
    }
}

TEST(Import, BoxGoesByTheCentroidOfAConcaveFootprint)
{
    // An L whose bounding box is centred on (10, 10) and whose centroid is (7, 7): 20 x 8 and 8 x 12, by hand
    // (160 * 10 + 96 * 4) / 256 = 7.75.
    const std::string text = collection({ring("L", {{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 20}, {0, 20}})});
    EXPECT_EQ(idsOf(parse(text, {.bbox = Box2{{7.7, 7.7}, {7.8, 7.8}}})), "L");
    EXPECT_FALSE(parseCity(text, "x", {.bbox = Box2{{9, 9}, {11, 11}}}).ok());
}

TEST(Import, ProjectsLongitudeAndLatitude)
{
    // Two houses in Monaco, 100 m apart on a parallel. Metres a degree from the radii of curvature of the ellipsoid:
    // a (1 - e2) / w3 along the meridian, a cos(latitude) / w along the parallel, w = sqrt(1 - e2 sin2(latitude)).
    const double lat = 43.73, lon = 7.42, radian = std::numbers::pi / 180.0, e2 = 0.0066943799901413165;
    const double w = std::sqrt(1.0 - e2 * std::pow(std::sin(lat * radian), 2.0));
    const double north = radian * 6378137.0 * (1.0 - e2) / (w * w * w);
    const double east = radian * 6378137.0 * std::cos(lat * radian) / w;
    const double dLat = 20.0 / north, dLon = 10.0 / east;
    const std::string text = collection({box("a", lon, lat, dLon, dLat), box("b", lon + 10 * dLon, lat, dLon, dLat)});
    const Layout layout = parse(text);
    ASSERT_EQ(layout.footprints.size(), 2u);
    for (const Footprint& footprint : layout.footprints) EXPECT_NEAR(area(footprint.outline), 200.0, 0.02);
    ASSERT_TRUE(layout.latitudeDeg && layout.longitudeDeg);
    EXPECT_NEAR(*layout.latitudeDeg, lat + dLat / 2, 1e-9);
    EXPECT_NEAR(*layout.longitudeDeg, lon + 5.5 * dLon, 1e-9);
    EXPECT_EQ(layout.origin, glm::dvec3(0.0));
    EXPECT_TRUE(layout.crs.starts_with("+proj=tmerc +lat_0=43.73")) << layout.crs;
    const Box2 a = boxOf(byId(layout, "a").outline.outer), b = boxOf(byId(layout, "b").outline.outer);
    EXPECT_NEAR(b.low.x - a.low.x, 100.0, 0.01);
    EXPECT_NEAR(a.low.x, -b.high.x, 1e-6);
    EXPECT_NEAR(a.low.y, -a.high.y, 1e-3);
    // A stated CRS decides where the numbers do not: the same, larger than any house in degrees would be.
    const std::string crs = R"("crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:OGC:1.3:CRS84"}},)";
    EXPECT_NEAR(area(parse(collection({box("a", lon, lat, 0.06, 0.001)}, crs)).footprints.at(0).outline),
                0.06 * east * 0.001 * north, 30.0);
    // The box is in degrees too, and streets follow.
    const Layout one = parse(collection({box("a", lon, lat, dLon, dLat), box("b", lon + 10 * dLon, lat, dLon, dLat),
                                         line("[[7.4195,43.7299],[7.4215,43.7299]]")}),
                             {.bbox = Box2{{lon, lat}, {lon + 2 * dLon, lat + dLat}}});
    EXPECT_EQ(idsOf(one), "a");
    ASSERT_EQ(one.streets.size(), 1u);
    EXPECT_NEAR(one.streets[0][0].y, -10.0 - 0.0001 * north, 0.01);
    EXPECT_TRUE(one.footprints[0].onStreet.at(0));
}

// Fiji, 16.8 S: two houses 0.0015 degrees apart with the antimeridian between them, and one that stands on it, drawn
// once as RFC 7946 has longitudes and once beyond.
TEST(Import, ACityMayLieOnTheAntimeridian)
{
    const double lat = -16.8, radian = std::numbers::pi / 180.0, e2 = 0.0066943799901413165;
    const double east =
        radian * 6378137.0 * std::cos(lat * radian) / std::sqrt(1.0 - e2 * std::pow(std::sin(lat * radian), 2.0));
    const std::string crs = R"("crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:OGC:1.3:CRS84"}},)";
    const std::string across =
        ring("X", {{179.9999, lat}, {-179.9999, lat}, {-179.9999, lat + 0.0002}, {179.9999, lat + 0.0002}});
    for (const bool turned : {false, true}) {
        std::vector<std::string> features = {box("E", 179.9990, lat, 0.0002, 0.0002),
                                             box("W", -179.9995, lat, 0.0002, 0.0002), across};
        if (turned) std::reverse(features.begin(), features.end());
        features.push_back(line("[[179.9985,-16.80005],[-179.9985,-16.80005]]"));
        const Layout layout = parse(collection(features, crs));
        ASSERT_EQ(idsOf(layout), "E W X");
        const Box2 e = boxOf(byId(layout, "E").outline.outer), w = boxOf(byId(layout, "W").outline.outer);
        EXPECT_NEAR(w.low.x - e.low.x, 0.0015 * east, 0.01);
        EXPECT_NEAR(area(byId(layout, "X").outline), area(byId(layout, "E").outline), 0.01);
        ASSERT_TRUE(layout.longitudeDeg);
        EXPECT_NEAR(*layout.longitudeDeg, 179.99985, 1e-9); // of 179.9990 to 180.0007
        ASSERT_EQ(layout.streets.size(), 1u);
        EXPECT_NEAR(layout.streets[0][1].x - layout.streets[0][0].x, 0.003 * east, 0.01);
    }
    // Alone it has no neighbours to go by.
    EXPECT_NEAR(area(parse(collection({across}, crs)).footprints.at(0).outline),
                area(parse(collection({box("E", 179.9990, lat, 0.0002, 0.0002)}, crs)).footprints.at(0).outline), 0.01);
}

TEST(Import, IdsAreUniqueInOrder)
{
    // Two of one id, one that has the id the second would get, and a bow tie of two pieces of 20 m2 in the middle.
    const Layout layout =
        parse(collection({box("x", 0, 0, 10, 10), box("x", 20, 0, 10, 10), box("x.2", 40, 0, 10, 10),
                          ring("bow", {{60, 0}, {70, 8}, {70, 0}, {60, 8}}), box("bow.2", 80, 0, 10, 10)}));
    EXPECT_EQ(idsOf(layout), "bow bow.2 bow.2.2 x x.2 x.3");
    EXPECT_NEAR(boxOf(byId(layout, "x.3").outline.outer).low.x - boxOf(byId(layout, "x").outline.outer).low.x, 20.0,
                1e-9);
    EXPECT_EQ(countOf(layout, "repaired.renamed"), 2u);
    EXPECT_TRUE(hasNote(layout, "x is now x.3"));
    EXPECT_EQ(countOf(parse(collection({box("x", 0, 0, 10, 10), box("y", 20, 0, 10, 10)})), "repaired.renamed"), 0u);
}

TEST(Import, TellsOfStreetsThatAreNotOfTheCity)
{
    const std::string near = line("[[-10,-5],[20,-5]]"), far = line("[[5000,0],[5100,0]]"),
                      house = box("a", 0, 0, 10, 8);
    const Layout some = parse(collection({house, near, far}));
    EXPECT_EQ(some.streets.size(), 1u);
    EXPECT_EQ(countOf(some, "skipped.far_streets"), 1u);
    EXPECT_TRUE(hasNote(some, "1 of 2 lines"));

    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "helio_import_far_streets.geojson";
    const auto failure = [&](const std::string& streetHead, const std::string& cityHead) {
        std::ofstream(path) << collection({far}, streetHead);
        const Result<Layout> layout = parseCity(collection({house}, cityHead), "city", {.streets = path});
        return layout.ok() ? std::string("none") : layout.error().message;
    };
    EXPECT_EQ(failure("", "").find(path.string() + ": none of its 1 lines"), 0u) << failure("", "");
    const std::string utm = R"("metadata":{"crs":"EPSG:32632 (UTM 32N) minus origin"},)";
    const std::string krovak = R"("metadata":{"crs":"EPSG:5514"},)";
    EXPECT_NE(failure(utm, krovak).find("give both in one CRS"), std::string::npos) << failure(utm, krovak);
    std::ofstream(path) << collection({near}, R"("crs":{"properties":{"name":"urn:ogc:def:crs:EPSG::32632"}},)");
    EXPECT_EQ(parse(collection({house}, utm), {.streets = path}).streets.size(), 1u);
    std::filesystem::remove(path);
}

TEST(Import, MetresNearTheOriginAreNoDegrees)
{
    const Layout layout = parse(collection({box("a", 7.4, 43.7, 10, 8)}));
    EXPECT_NEAR(area(layout.footprints.at(0).outline), 80.0, 1e-9);
    EXPECT_FALSE(layout.latitudeDeg);
    // Where the file says metres, a speck is one and the rest of the city as it is.
    const Layout metric = parse(
        collection({box("a", 7, 43, 10, 8), box("speck", 1.0, 1.0, 0.01, 0.01)}, R"("metadata":{"units":"metre"},)"));
    EXPECT_EQ(idsOf(metric), "a");
    EXPECT_EQ(countOf(metric, "skipped.degrees"), 1u);
}

TEST(Import, KnowsWhereAUtmCityLies)
{
    const Layout layout =
        parse(collection({box("a", 134, 19, 10, 10)}, R"("metadata":{"crs":"EPSG:32632","origin":[373000,4844000]},)"));
    ASSERT_TRUE(layout.latitudeDeg);
    // PROJ has 7.4246 E, 43.7384 N at 373139.337, 4844024.125 in zone 32; 0.35 m are 5e-6 degrees.
    EXPECT_NEAR(*layout.latitudeDeg, 43.7384, 5e-6);
    EXPECT_NEAR(*layout.longitudeDeg, 7.4246, 5e-6);
}

TEST(Import, GivesTheSameCityFarFromTheOrigin)
{
    const auto city = [](double x, double y) {
        return parse(
            collection({box("a", x, y, 10, 10, R"("height":12)"), box("b", x + 10, y, 10.125, 7, R"("height":9)"),
                        ring("c", {{x, y + 10}, {x + 9, y + 10.25}, {x + 4, y + 30}})}));
    };
    const Layout near = city(0, 0), far = city(90900, 435700);
    EXPECT_EQ(far.origin - near.origin, glm::dvec3(90900, 435700, 0));
    ASSERT_EQ(near.footprints.size(), far.footprints.size());
    for (size_t f = 0; f < near.footprints.size(); ++f) // binary fractions: nothing is rounded
        EXPECT_EQ(near.footprints[f].outline.outer, far.footprints[f].outline.outer);
    EXPECT_EQ(near.counts, far.counts);
}

TEST(Import, TakesStreetsFromTheFileAndFromAnother)
{
    const std::string house = box("a", 1000, 1000, 10, 8);
    const std::string frame = R"("metadata":{"origin":[500,0]},)", other = R"("metadata":{"origin":[0,0]},)";
    const Layout own = parse(collection({line("[[[980,990],[1030,990]],[[0,0],[1,1]]]", "MultiLineString"), house}));
    ASSERT_EQ(own.streets.size(), 1u); // the second lies a kilometre away
    EXPECT_EQ(own.streets[0][1] - own.streets[0][0], glm::dvec2(50, 0));
    EXPECT_TRUE(own.footprints.at(0).onStreet.at(0));
    EXPECT_EQ(own.footprints[0].outline.outer[0], glm::dvec2(-5, -4));

    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "helio_import_streets.geojson";
    std::ofstream(path) << collection({line("[[1525,960],[1525,1050]]")}, other); // east of the house, 15 m
    const Layout given = parse(collection({house}, frame), {.streets = path});
    ASSERT_EQ(given.streets.size(), 1u);
    EXPECT_EQ(given.footprints.at(0).outline.outer[0], glm::dvec2(5, -4)); // the short side, for it faces the street
    std::ofstream(path) << collection({house});
    const Result<Layout> none = parseCity(collection({house}), "city", {.streets = path});
    ASSERT_FALSE(none.ok());
    EXPECT_TRUE(none.error().message.starts_with(path.string() + ": no streets"));
    std::ofstream(path) << collection({line("[[7.4,43.7],[7.5,43.7]]")},
                                      R"("crs":{"properties":{"name":"urn:ogc:def:crs:OGC:1.3:CRS84"}},)");
    EXPECT_FALSE(parseCity(collection({house}, R"("metadata":{"crs":"EPSG:32632"},)"), "city", {.streets = path}).ok());
    std::filesystem::remove(path);
    EXPECT_FALSE(parseCity(collection({house}), "city", {.streets = path}).ok());
    EXPECT_TRUE(parse(collection({house})).footprints[0].onStreet.empty());
}

TEST(Import, PartsReplaceTheirOutline)
{
    // "whole" is divided among a podium and a tower; from "half" a part takes 40 of 100 m2; "loose" touches nothing,
    // and "no" says that it is no part.
    const Layout layout = parse(collection(
        {box("whole", 0, 0, 20, 10, R"("height":30)"), box("podium", 0, 0, 15, 10, R"("part":true,"height":8)"),
         box("tower", 15, 0, 5, 10, R"("building:part":"yes")"), box("half", 40, 0, 10, 10, R"("height":9)"),
         box("wing", 40, 0, 4, 10, R"("building:part":"yes","levels":1)"),
         box("loose", 60, 0, 10, 10, R"("part":true,"height":5)"),
         box("no", 80, 0, 10, 10, R"("building:part":"no","height":5)")}));
    EXPECT_EQ(idsOf(layout), "half loose no podium tower wing");
    EXPECT_EQ(byId(layout, "tower").height, 30.0); // its outline's, for want of an own
    EXPECT_NEAR(area(byId(layout, "half").outline), 60.0, 1e-6);
    EXPECT_EQ(byId(layout, "half").height, 9.0);
    EXPECT_DOUBLE_EQ(byId(layout, "wing").height, 4.2);
    EXPECT_EQ(countOf(layout, "repaired.replaced_by_parts"), 1u);
    EXPECT_EQ(countOf(layout, "repaired.cut_by_parts"), 1u);
    EXPECT_EQ(countOf(layout, "repaired.overlap_cut"), 0u);
    EXPECT_EQ(countOf(layout, "overlapping_pairs(>0.5m2)"), 3u); // as delivered
}

TEST(Import, AStackOfPartsBecomesATowerOnItsPodium)
{
    const Layout layout =
        parse(collection({box("outline", 0, 0, 20, 20), box("low", 0, 0, 20, 20, R"("part":true,"height":10)"),
                          box("high", 5, 5, 10, 10, R"("part":true,"height":40)")}));
    EXPECT_EQ(idsOf(layout), "high low");
    EXPECT_NEAR(area(byId(layout, "low").outline), 300.0, 1e-6);
    EXPECT_EQ(byId(layout, "low").outline.holes.size(), 1u);
    EXPECT_EQ(byId(layout, "low").covered.size(), 8u);
    for (size_t edge = 4; edge < 8; ++edge) EXPECT_EQ(byId(layout, "low").covered[edge].at(0).height, 40.0);
}

TEST(Import, NamesTwentyOfAKindAndCountsTheRest)
{
    std::vector<std::string> features;
    for (int i = 0; i < 30; ++i) // 25 bow ties of two triangles with 20 m2 each, and 5 good ones drawn clockwise
        features.push_back(i < 25
                               ? ring("bow" + std::to_string(i),
                                      {{i * 20.0, 0}, {i * 20.0 + 10, 8}, {i * 20.0 + 10, 0}, {i * 20.0, 8}})
                               : ring("back" + std::to_string(i), {{i * 20.0, 0}, {i * 20.0, 8}, {i * 20.0 + 8, 8}}));
    const Layout layout = parse(collection(features));
    EXPECT_EQ(layout.footprints.size(), 55u);
    EXPECT_EQ(countOf(layout, "repaired.united"), 25u);
    EXPECT_EQ(countOf(layout, "invalid"), 25u);
    EXPECT_EQ(countOf(layout, "clockwise_outer"), 5u);
    u32 bows = 0;
    bool isSummed = false;
    for (const std::string& note : layout.notes) {
        bows += note.starts_with("feature bow");
        EXPECT_FALSE(note.starts_with("feature back")) << note; // turning a ring round is too ordinary for a line
        isSummed = isSummed || (note.starts_with("repaired.united: 25 features"));
    }
    EXPECT_EQ(bows, 20u);
    EXPECT_TRUE(isSummed);
}

TEST(Import, TellsTheFormatByContent)
{
    EXPECT_FALSE(parseCity(R"({"type":"CityJSON","version":"9.9"})", "x.json", {}).ok());
    const Result<Layout> topology = parseCity(R"({"type":"Topology","objects":{}})", "x.json", {});
    ASSERT_FALSE(topology.ok());
    EXPECT_NE(topology.error().message.find("Topology"), std::string::npos);
    const std::string cube =
        R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[1000,2000,0]},)"
        R"("vertices":[[0,0,0],[10,0,0],[10,8,0],[0,8,0],[0,0,6],[10,0,6],[10,8,6],[0,8,6]],)"
        R"("CityObjects":{"house":{"type":"Building","geometry":[{"type":"Solid","lod":"1","boundaries":)"
        R"([[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]]}]}}})";
    const Layout layout = parse(cube);
    ASSERT_EQ(layout.footprints.size(), 1u);
    EXPECT_NEAR(area(layout.footprints[0].outline), 80.0, 1e-9);
    EXPECT_EQ(layout.footprints[0].height, 6.0);
}

} // namespace
