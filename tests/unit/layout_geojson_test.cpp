// SPDX-License-Identifier: Apache-2.0
#include "city/layout/import.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <iomanip>
#include <sstream>

using namespace helio;

namespace {

// A feature: a square of `size` metres with its lower left corner at x, y.
std::string square(const std::string& id, double x, double y, double size, const std::string& properties = "")
{
    std::ostringstream out;
    out << std::setprecision(17) << R"({"type":"Feature","id":")" << id << R"(","properties":{)" << properties
        << R"(},"geometry":{"type":"Polygon","coordinates":[[)";
    const double corners[5][2] = {{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}, {x, y}};
    for (int i = 0; i < 5; ++i) out << (i ? "," : "") << "[" << corners[i][0] << "," << corners[i][1] << "]";
    out << "]]}}";
    return out.str();
}

std::string collection(const std::vector<std::string>& features, const std::string& head = "")
{
    std::string text = R"({"type":"FeatureCollection",)" + head + R"("features":[)";
    for (size_t i = 0; i < features.size(); ++i) text += (i ? ",\n" : "\n") + features[i];
    return text + "]}";
}

std::string geometry(const std::string& coordinates, const std::string& type = "Polygon")
{
    return R"({"type":"Feature","id":"x","properties":{},"geometry":{"type":")" + type + R"(","coordinates":)" +
           coordinates + "}}";
}

Layout parse(const std::string& text, const ImportOptions& options = {})
{
    Result<Layout> layout = parseCity(text, "city.geojson", options);
    EXPECT_TRUE(layout.ok()) << (layout.ok() ? "" : layout.error().message);
    return layout.ok() ? std::move(*layout) : Layout{};
}

std::string errorOf(const std::string& text)
{
    const Result<Layout> layout = parseCity(text, "city.geojson");
    EXPECT_FALSE(layout.ok());
    const std::string message = layout.ok() ? "" : layout.error().message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_TRUE(message.starts_with("city.geojson:")) << message;
    return message;
}

bool hasNote(const Layout& layout, const std::string& id, const std::string& words)
{
    for (const std::string& note : layout.notes)
        if (note.starts_with("feature " + id + ":") && note.find(words) != std::string::npos) return true;
    return false;
}

const Footprint& byId(const Layout& layout, const std::string& id)
{
    for (const Footprint& footprint : layout.footprints)
        if (footprint.id == id) return footprint;
    ADD_FAILURE() << "no footprint " << id;
    static const Footprint none;
    return none;
}

TEST(GeoJson, ReadsPolygonsWithHolesAndSubtractsTheOrigin)
{
    const std::string ring = "[[100,200],[130,200],[130,220],[100,220],[100,200]]";
    const std::string hole = "[[110,205],[120,205],[120,215],[110,215],[110,205]]";
    const Layout layout = parse(collection({geometry("[" + ring + "," + hole + "]")},
                                           R"("metadata":{"origin":[1000,2000],"crs":"EPSG:32632 minus origin"},)"));
    ASSERT_EQ(layout.footprints.size(), 1u);
    EXPECT_EQ(layout.origin, glm::dvec3(1115.0, 2210.0, 0.0));
    EXPECT_EQ(layout.crs, "EPSG:32632 minus origin");
    const Polygon2& outline = layout.footprints[0].outline;
    EXPECT_EQ(signedArea(outline.outer), 600.0);
    EXPECT_EQ(signedArea(outline.holes.at(0)), -100.0); // the file's hole runs counter-clockwise
    EXPECT_EQ(outline.outer[0], glm::dvec2(-15.0, -10.0));
    EXPECT_EQ(layout.footprints[0].covered.size(), 8u);
}

TEST(GeoJson, KeepsAMicrometreFarFromTheOrigin)
{
    const double x = 5e5 + 0.123456, y = 4.5e6 + 0.654321;
    const Layout layout = parse(collection({square("a", x, y, 1.000001), square("b", x + 3.0, y, 1.5)}));
    ASSERT_EQ(layout.footprints.size(), 2u);
    const Ring2& ring = byId(layout, "a").outline.outer;
    ASSERT_EQ(ring.size(), 4u);
    for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(glm::distance(ring[i], ring[(i + 1) % 4]), 1.000001, 2e-9);
    const glm::dvec2 back = ring[0] + glm::dvec2(layout.origin);
    EXPECT_NEAR(back.x, x, 2e-9);
    EXPECT_NEAR(back.y, y, 2e-9);
    EXPECT_LT(glm::length(ring[0]), 10.0);
}

TEST(GeoJson, ReadsEveryFormOfContainer)
{
    const std::string square1 = "[[[0,0],[10,0],[10,10],[0,10],[0,0]]]",
                      square2 = "[[[20,0],[30,0],[30,10],[20,10],[20,0]]]";
    const std::string multi = R"({"type":"MultiPolygon","coordinates":[)" + square1 + "," + square2 + "]}";
    const std::string feature = R"({"type":"Feature","id":7,"properties":{"height":9},"geometry":)" + multi + "}";
    const std::string bag = R"({"type":"GeometryCollection","geometries":[)" + multi + "]}";
    for (const std::string& text : {collection({feature}), feature, multi, bag}) {
        const Layout layout = parse(text);
        ASSERT_EQ(layout.footprints.size(), 2u) << text;
        EXPECT_EQ(area(layout.footprints[0].outline), 100.0);
        EXPECT_NE(layout.footprints[0].id, layout.footprints[1].id);
    }
    EXPECT_EQ(parse(feature).footprints[1].id, "7.2");
    EXPECT_EQ(parse(feature).footprints[1].height, 9.0);
}

TEST(GeoJson, TakesHeightsInOrder)
{
    const std::vector<std::string> features = {square("high", 0, 0, 10, R"("height":21.5,"levels":3)"),
                                               square("text", 20, 0, 10, R"("height":"12 m")"),
                                               square("levels", 40, 0, 10, R"("levels":"5")"),
                                               square("near", 60, 0, 10),
                                               square("far", 500, 0, 10),
                                               square("zero", 500, 50, 10, R"("height":0,"levels":2)"),
                                               square("odd", 700, 0, 10, R"("height":"ca. 12")"),
                                               square("minus", 700, 90, 10, R"("height":-3)"),
                                               square("diagonal", 15, 45, 10, R"("height":14)")};
    const Layout layout =
        parse(collection(features), {.defaultHeight = 8.0, .storeyHeight = 3.2, .neighbourRadius = 50.0});
    EXPECT_EQ(byId(layout, "high").height, 21.5);
    EXPECT_EQ(byId(layout, "text").height, 12.0);
    EXPECT_DOUBLE_EQ(byId(layout, "levels").height, 17.0);
    EXPECT_DOUBLE_EQ(byId(layout, "near").height,
                     17.0); // within 50 m: 12 and 17, the upper median; "diagonal" is 64 m away
    EXPECT_DOUBLE_EQ(byId(layout, "zero").height, 7.4);
    EXPECT_DOUBLE_EQ(byId(layout, "far").height, 7.4);
    EXPECT_EQ(byId(layout, "odd").height, 8.0);
    EXPECT_EQ(byId(layout, "minus").height, 8.0);
    EXPECT_TRUE(hasNote(layout, "zero", "height 0"));
    EXPECT_TRUE(hasNote(layout, "odd", "ca. 12"));
    EXPECT_TRUE(hasNote(layout, "minus", "-3"));
    EXPECT_TRUE(hasNote(layout, "text", "read as 12"));
    EXPECT_FALSE(hasNote(layout, "high", ""));
    EXPECT_EQ(layout.counts.at("height.given"), 3u); // high, text, diagonal
    EXPECT_EQ(layout.counts.at("height.levels"), 2u);
    EXPECT_EQ(layout.counts.at("height.neighbours"), 2u);
    EXPECT_EQ(layout.counts.at("height.default"), 2u);
    EXPECT_EQ(layout.counts.at("missing_height"), 6u); // as delivered: no usable `height`
}

TEST(GeoJson, KeepsScalarPropertiesAsAttributes)
{
    const Layout layout = parse(collection(
        {square("a", 0, 0, 10, R"("height":10,"use":"shop","flat":true,"year":1912,"tags":[1],"none":null)")}));
    const auto& attributes = layout.footprints.at(0).attributes;
    EXPECT_EQ(attributes.size(), 3u);
    EXPECT_EQ(attributes.at("use"), Attribute(std::string("shop")));
    EXPECT_EQ(attributes.at("flat"), Attribute(true));
    EXPECT_EQ(attributes.at("year"), Attribute(1912.0));
}

TEST(GeoJson, RepairsOrSkipsEachBadFeatureWithItsName)
{
    const std::string bad =
        R"({"type":"Feature","id":"bow","properties":{},"geometry":{"type":"Polygon","coordinates":)"
        R"([[[100,0],[110,8],[110,0],[100,8],[100,0]]]}})";
    const std::string open =
        R"({"type":"Feature","id":"open","properties":{},"geometry":{"type":"Polygon","coordinates":)"
        R"([[[200,0],[210,0],[210,8],[200,8]]]}})";
    const auto broken = [](const std::string& id, const std::string& shape) {
        return R"({"type":"Feature","id":")" + id + R"(","properties":{},"geometry":)" + shape + "}";
    };
    const Layout layout = parse(collection({
        square("fine", 0, 0, 10),
        bad,
        open,
        square("degrees", 7.4201, 43.7301, 0.0002),
        square("huge", 1e12, 0, 10),
        square("away", 2.6e6, 1.2e6, 10),
        square("tiny", 50, 50, 0.7),
        broken("line", R"({"type":"LineString","coordinates":[[0,0],[1,1]]})"),
        broken("null", "null"),
        broken("word", R"({"type":"Polygon","coordinates":[[["a",0],[1,0],[1,1]]]})"),
        broken("flat", R"({"type":"Polygon","coordinates":[1,2,3]})"),
        broken("empty", R"({"type":"Polygon","coordinates":[]})"),
        broken("hollow", R"({"type":"Polygon","coordinates":[[]]})"),
        broken("two", R"({"type":"Polygon","coordinates":[[[0,0],[5,0],[0,0]]]})"),
        "17",
    }));
    ASSERT_EQ(layout.footprints.size(), 4u);
    EXPECT_NEAR(area(byId(layout, "bow").outline) + area(byId(layout, "bow.2").outline), 40.0, 1e-6);
    EXPECT_EQ(area(byId(layout, "open").outline), 80.0);
    EXPECT_TRUE(hasNote(layout, "bow", "crossing"));
    EXPECT_TRUE(hasNote(layout, "open", "closed"));
    for (const char* id : {"degrees", "huge", "away", "tiny", "null", "word", "flat", "empty", "hollow", "two", "#14"})
        EXPECT_TRUE(hasNote(layout, id, "skipped")) << id;
    EXPECT_FALSE(hasNote(layout, "fine", ""));
    EXPECT_EQ(layout.streets.size(), 1u); // a line is no footprint but a street
}

TEST(GeoJson, RefusesWhatIsNoCity)
{
    // Byte 12 is the o, the first one that does not belong to "null".
    EXPECT_NE(errorOf("{\n\"type\": nonsense}").find("city.geojson:2: byte 12: not JSON"), std::string::npos);
    EXPECT_NE(errorOf("").find("not JSON"), std::string::npos);
    EXPECT_NE(errorOf(R"({"type":"Polygon","coordinates":[[[0,NaN]]]})").find("not JSON"), std::string::npos);
    EXPECT_NE(errorOf(R"({"type":"Polygon","coordinates":[[[0,1e999]]]})").find("1e999"), std::string::npos);
    EXPECT_NE(errorOf("[1,2]").find("no JSON object"), std::string::npos);
    EXPECT_NE(errorOf(R"({"type":"FeatureCollection","features":5})").find("features"), std::string::npos);
    EXPECT_NE(errorOf(collection({})).find("no footprint"), std::string::npos);
    EXPECT_NE(errorOf(collection({square("a", 2e7, 0, 10)})).find("1e7"), std::string::npos);
}

TEST(GeoJson, DeepNestingIsAnError)
{
    const auto nested = [](size_t levels) {
        return collection(
            {square("a", 0, 0, 10, R"("height":)" + std::string(levels, '[') + std::string(levels, ']'))});
    };
    // Root, features, feature and properties come before it: 60 levels are the last ones that are read.
    EXPECT_TRUE(hasNote(parse(nested(60)), "a", "height an array is not usable"));
    const size_t tooMuch = nested(61).find("[[[[") + 60;
    EXPECT_TRUE(errorOf(nested(61)).starts_with(concat("city.geojson:2: byte ", tooMuch, ": nests deeper than 64 ")));
    EXPECT_NE(errorOf(nested(1000000)).find("deeper"), std::string::npos);
    EXPECT_NE(errorOf(std::string(1000000, '[')).find("deeper"), std::string::npos);
    EXPECT_TRUE(hasNote(parse(collection({square("a", 0, 0, 10, R"("height":{"m":3})")})), "a", "height an object is"));
}

TEST(GeoJson, AMissingHeightIsTheOptionWhereNoNeighboursAreAskedFor)
{
    const std::string text = collection({square("low", 0, 0, 10, R"("height":6)"), square("none", 20, 0, 10)});
    EXPECT_EQ(byId(parse(text, {.defaultHeight = 30.0, .neighbourRadius = 0.0}), "none").height, 30.0);
    EXPECT_EQ(byId(parse(text, {.defaultHeight = 30.0}), "none").height, 6.0);
}

TEST(GeoJson, ReadsFilesAndNamesThemInErrors)
{
    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "helio_layout_test.geojson";
    std::ofstream(path) << collection({square("a", 0, 0, 10)});
    EXPECT_EQ(importCity(path)->footprints.size(), 1u);
    std::filesystem::remove(path);
    EXPECT_TRUE(importCity(path).error().message.starts_with(path.string() + ": "));
}

TEST(GeoJson, DropsEqualFootprintsAndCutsOverlaps)
{
    const std::string again =
        R"({"type":"Feature","id":"again","properties":{"height":30},"geometry":{"type":"Polygon",)"
        R"("coordinates":[[[10,10],[10,0],[0,0],[0,10],[10,10]]]}})"; // other start, other direction
    const Layout layout = parse(collection({square("a", 0, 0, 10, R"("height":20)"), again,
                                            square("low", 8, 0, 10, R"("height":5)"),     // 2 x 10 inside a
                                            square("beside", 18, 0, 10, R"("height":5)"), // touches low
                                            square("under", 2, 2, 5, R"("height":5)")})); // wholly inside a
    EXPECT_EQ(layout.footprints.size(), 3u);
    EXPECT_EQ(byId(layout, "a").height, 30.0);
    EXPECT_EQ(area(byId(layout, "a").outline), 100.0);
    EXPECT_NEAR(area(byId(layout, "low").outline), 80.0, 1e-6);
    EXPECT_TRUE(hasNote(layout, "again", "feature a"));
    EXPECT_TRUE(hasNote(layout, "low", "20.0 m2"));
    EXPECT_TRUE(hasNote(layout, "under", "dropped"));
    EXPECT_FALSE(hasNote(layout, "beside", ""));
}

} // namespace
