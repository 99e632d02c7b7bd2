// SPDX-License-Identifier: Apache-2.0
#include "city/layout/cityjson.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "city/layout/import.h"

using namespace helio;

namespace {

// A box 10 x 6 x 9 m by vertices 0 to 7 (0 to 3 at the bottom, counter-clockwise from above) in millimetres.
const std::string kBoxVertices = "[0,0,0],[10000,0,0],[10000,6000,0],[0,6000,0],"
                                 "[0,0,9000],[10000,0,9000],[10000,6000,9000],[0,6000,9000]";
const std::string kFloor = "[[0,3,2,1]]", kRoof = "[[4,5,6,7]]",
                  kWalls = "[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]";
const std::string kShell = kFloor + "," + kRoof + "," + kWalls;
const std::string kTransform = R"("transform":{"scale":[0.001,0.001,0.001],"translate":[90000,436000,2.5]},)";

std::string solid(const std::string& lod, const std::string& more = "")
{
    return R"({"type":"Solid","lod":)" + lod + more + R"(,"boundaries":[[)" + kShell + "]]}";
}

std::string building(const std::string& id, const std::string& geometry, const std::string& more = "")
{
    return "\"" + id + R"(":{"type":"Building")" + more + R"(,"geometry":[)" + geometry + "]}";
}

std::string city(const std::string& objects, const std::string& vertices = kBoxVertices,
                 const std::string& head = R"("version":"2.0",)" + kTransform)
{
    return R"({"type":"CityJSON",)" + head + R"("CityObjects":{)" + objects + R"(},"vertices":[)" + vertices + "]}";
}

GeoFile read(const std::string& text, bool lod2 = false)
{
    Result<GeoFile> file = readCityJson(text, "a.city.json", lod2);
    EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().message);
    return file.ok() ? std::move(*file) : GeoFile{};
}

bool hasNote(const GeoFile& file, const std::string& begin, const std::string& words)
{
    for (const std::string& note : file.notes)
        if (note.starts_with(begin) && note.find(words) != std::string::npos) return true;
    for (const std::string& note : file.notes) ADD_FAILURE() << note;
    return false;
}

double footprintArea(const GeoFeature& feature)
{
    double sum = 0.0;
    for (const Polygon2& polygon : feature.polygons) {
        sum += signedArea(polygon.outer);
        for (const Ring2& hole : polygon.holes) sum += signedArea(hole);
    }
    return sum;
}

// The box of the tests: 60 m2 counter-clockwise, its lower left corner where the transform puts it, 9 m high.
void expectBox(const GeoFeature& feature, const glm::dvec2& corner = {90000.0, 436000.0})
{
    ASSERT_EQ(feature.polygons.size(), 1u) << feature.id;
    EXPECT_NEAR(footprintArea(feature), 60.0, 1e-6) << feature.id;
    glm::dvec2 low = feature.polygons[0].outer[0];
    for (const glm::dvec2& point : feature.polygons[0].outer) low = glm::min(low, point);
    EXPECT_NEAR(glm::distance(low, corner), 0.0, 1e-6) << feature.id;
    ASSERT_TRUE(feature.height) << feature.id;
    EXPECT_NEAR(*feature.height, 9.0, 1e-9) << feature.id;
}

struct FaceSums
{
    u32 walls = 0, roofs = 0;
    double wallArea = 0.0, roofArea = 0.0;
    glm::dvec3 vector{0.0}; ///< m2: less the floor for a closed building
    double volume = 0.0;    ///< m3, for faces over the plane z = 0
};

FaceSums sumsOf(const GeoFeature& feature)
{
    FaceSums sums;
    for (const GivenFace& face : feature.faces) {
        const bool isWall = face.kind == GivenKind::Wall;
        ++(isWall ? sums.walls : sums.roofs);
        (isWall ? sums.wallArea : sums.roofArea) += area(face.polygon);
        sums.vector += vectorArea(face.polygon);
        const glm::dvec3 corner(feature.polygons.at(0).outer.at(0), 0.0);
        sums.volume += glm::dot(centroid(face.polygon) - corner, vectorArea(face.polygon)) / 3.0;
    }
    return sums;
}

TEST(CityJson, EveryVersionGivesTheSameBuilding)
{
    const std::string metres = "[90000,436000,2.5],[90010,436000,2.5],[90010,436006,2.5],[90000,436006,2.5],"
                               "[90000,436000,11.5],[90010,436000,11.5],[90010,436006,11.5],[90000,436006,11.5]";
    const std::string urn = R"("metadata":{"referenceSystem":"urn:ogc:def:crs:EPSG::28992"},)";
    const std::string url = R"("metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/28992"},)";
    const std::string files[] = {
        city(building("a", solid("1")), metres, R"("version":"1.0",)" + urn),
        city(building("a", solid("1")), kBoxVertices, R"("version":"1.0",)" + urn + kTransform),
        city(building("a", solid(R"("1.2")")), kBoxVertices, R"("version":"1.1",)" + url + kTransform),
        city(building("a", solid(R"("1")")), kBoxVertices, R"("version":"2.0",)" + url + kTransform),
    };
    for (const std::string& text : files) {
        EXPECT_TRUE(isCityJson(text));
        const GeoFile file = read(text);
        ASSERT_EQ(file.features.size(), 1u);
        EXPECT_EQ(file.features[0].id, "a");
        EXPECT_EQ(file.crs, "EPSG:28992");
        expectBox(file.features[0]);
        EXPECT_TRUE(file.features[0].faces.empty());
        EXPECT_TRUE(file.notes.empty());
    }
}

TEST(CityJson, SequenceHasVerticesInEveryLine)
{
    const std::string header =
        R"({"type":"CityJSON","version":"2.0",)" + kTransform + R"("CityObjects":{},"vertices":[]})";
    const auto feature = [](const std::string& id, const std::string& vertices) {
        return R"({"type":"CityJSONFeature","id":")" + id + R"(","CityObjects":{)" + building(id, solid(R"("1")")) +
               R"(},"vertices":[)" + vertices + "]}";
    };
    std::string moved = kBoxVertices;
    for (size_t at = 0; (at = moved.find("10000,", at)) != std::string::npos; at += 6) moved.replace(at, 6, "20000,");
    for (size_t at = 0; (at = moved.find("[0,", at)) != std::string::npos; at += 3) moved.replace(at, 3, "[10000,");
    for (const std::string end : {"\n", "\r\n", "\n\n"}) {
        const std::string text = header + end + feature("b", kBoxVertices) + end + feature("a", moved) + end;
        EXPECT_TRUE(isCityJson(text));
        const GeoFile file = read(text);
        ASSERT_EQ(file.features.size(), 2u);
        EXPECT_EQ(file.features[0].id, "b"); // in the order of the lines
        expectBox(file.features[0]);
        expectBox(file.features[1], {90010.0, 436000.0});
    }
}

TEST(CityJson, KindOfGeometryDoesNotMatter)
{
    const std::string surfaces[] = {
        R"({"type":"MultiSurface","lod":"1","boundaries":[)" + kShell + "]}",
        R"({"type":"CompositeSurface","lod":"1","boundaries":[)" + kShell + "]}",
        R"({"type":"Solid","lod":"1","boundaries":[[)" + kShell + "],[" + kFloor + "]]}",
        R"({"type":"MultiSolid","lod":"1","boundaries":[[[)" + kShell + "]]]}",
        R"({"type":"CompositeSolid","lod":"1","boundaries":[[[)" + kShell + "]]]}",
    };
    for (const std::string& geometry : surfaces) {
        const GeoFile file = read(city(building("a", geometry)));
        ASSERT_EQ(file.features.size(), 1u) << geometry;
        expectBox(file.features[0]);
    }
}

TEST(CityJson, SurfacesBetweenSolidsAreLeftOut)
{
    // The box cut into two storeys at z = 4 m by vertices 8 to 11.
    const std::string vertices = kBoxVertices + ",[0,0,4000],[10000,0,4000],[10000,6000,4000],[0,6000,4000]";
    const std::string low = kFloor + ",[[8,9,10,11]],[[0,1,9,8]],[[1,2,10,9]],[[2,3,11,10]],[[3,0,8,11]]";
    const std::string high = "[[8,11,10,9]]," + kRoof + ",[[8,9,5,4]],[[9,10,6,5]],[[10,11,7,6]],[[11,8,4,7]]";
    const std::string geometry =
        R"({"type":"CompositeSolid","lod":"2","boundaries":[[[)" + low + "]],[[" + high + "]]]}";
    const GeoFile file = read(city(building("a", geometry), vertices), true);
    ASSERT_EQ(file.features.size(), 1u);
    expectBox(file.features[0]);
    const FaceSums sums = sumsOf(file.features[0]);
    EXPECT_EQ(sums.walls, 8u);
    EXPECT_EQ(sums.roofs, 1u);
    EXPECT_NEAR(sums.volume, 540.0, 1e-6);
}

// A gabled house: eaves at 9 m, the ridge (vertices 8, 9) along x at 11 m. South slope, north slope, two gables.
const std::string kGableVertices = kBoxVertices + ",[0,3000,11000],[10000,3000,11000]";
const std::string kGableShell = kFloor + ",[[4,5,9,8]],[[6,7,8,9]],[[0,1,5,4]],[[2,3,7,6]],[[1,2,6,9,5]],[[3,0,4,8,7]]";

void expectGable(const GeoFile& file, const std::string& what)
{
    ASSERT_EQ(file.features.size(), 1u) << what;
    const GeoFeature& feature = file.features[0];
    ASSERT_EQ(feature.polygons.size(), 1u) << what;
    EXPECT_NEAR(footprintArea(feature), 60.0, 1e-6) << what;
    ASSERT_TRUE(feature.height) << what;
    EXPECT_NEAR(*feature.height, 11.0, 1e-9) << what;
    const FaceSums sums = sumsOf(feature);
    EXPECT_EQ(sums.walls, 4u) << what;
    EXPECT_EQ(sums.roofs, 2u) << what;
    EXPECT_NEAR(sums.wallArea, 2 * 90.0 + 2 * (54.0 + 6.0), 1e-6) << what;
    EXPECT_NEAR(sums.roofArea, 2 * 10.0 * std::sqrt(13.0), 1e-6) << what;
    EXPECT_NEAR(glm::distance(sums.vector, {0.0, 0.0, 60.0}), 0.0, 1e-6) << what;
    EXPECT_NEAR(sums.volume, 60.0 * 9.0 + 60.0, 1e-5) << what;
    for (const GivenFace& face : feature.faces)
        for (const glm::dvec3& corner : face.polygon.outer) {
            EXPECT_TRUE(corner.x >= 90000.0 - 1e-6 && corner.x <= 90010.0 + 1e-6) << what;
            EXPECT_TRUE(corner.z >= -1e-9 && corner.z <= 11.0 + 1e-9) << what; // above the ground at 2.5 m
        }
}

TEST(CityJson, Lod2FacesBySemanticsAndByNormal)
{
    const std::string semantics = R"(,"semantics":{"surfaces":[{"type":"WallSurface"},{"type":"GroundSurface"},)"
                                  R"({"type":"RoofSurface"}],"values":[[1,2,2,0,0,0,0]]})";
    for (const std::string& more :
         {std::string(), semantics, std::string(R"(,"semantics":{"surfaces":[],"values":[null]})")}) {
        const std::string geometry =
            R"({"type":"Solid","lod":"2.2")" + more + R"(,"boundaries":[[)" + kGableShell + "]]}";
        expectGable(read(city(building("a", geometry), kGableVertices), true), geometry);
        EXPECT_TRUE(read(city(building("a", geometry), kGableVertices), false).features.at(0).faces.empty());
    }
    // Semantics decide, not the normal: the south slope is called a wall.
    const std::string odd = R"({"type":"MultiSurface","lod":"2","semantics":{"surfaces":[{"type":"WallSurface"}],)"
                            R"("values":[null,0]},"boundaries":[)" +
                            kGableShell + "]}";
    EXPECT_EQ(sumsOf(read(city(building("a", odd), kGableVertices), true).features.at(0)).walls, 5u);
}

TEST(CityJson, FacesThatLookInwardAreTurned)
{
    // One wall against its neighbours, then all faces.
    const std::string oneWall = kFloor + ",[[4,5,9,8]],[[6,7,8,9]],[[4,5,1,0]],[[2,3,7,6]],[[1,2,6,9,5]],[[3,0,4,8,7]]";
    const std::string all = "[[1,2,3,0]],[[8,9,5,4]],[[9,8,7,6]],[[4,5,1,0]],[[6,7,3,2]],[[5,9,6,2,1]],[[7,8,4,0,3]]";
    for (const std::string& shell : {oneWall, all}) {
        const std::string semantics = R"("semantics":{"surfaces":[{"type":"WallSurface"},{"type":"GroundSurface"},)"
                                      R"({"type":"RoofSurface"}],"values":[1,2,2,0,0,0,0]},)";
        const std::string geometry =
            R"({"type":"MultiSurface","lod":"2",)" + semantics + R"("boundaries":[)" + shell + "]}";
        const GeoFile file = read(city(building("a", geometry), kGableVertices), true);
        expectGable(file, shell);
        EXPECT_TRUE(hasNote(file, "LoD 2:", shell == all ? "7 turned outward" : "1 turned outward"));
    }
}

TEST(CityJson, BentFacesAreSplitAndFlatOnesDropped)
{
    // The roof's corner 6 is 0.5 m higher: two triangles. Surface [0,1,1] has no area, [2,3] no corners.
    std::string vertices = kBoxVertices;
    vertices.replace(vertices.find("[10000,6000,9000]"), 17, "[10000,6000,9500]");
    const std::string geometry = R"({"type":"Solid","lod":"2","boundaries":[[)" + kShell + ",[[0,1,1]],[[2,3]]]]}";
    const GeoFile file = read(city(building("a", geometry), vertices), true);
    ASSERT_EQ(file.features.size(), 1u);
    const FaceSums sums = sumsOf(file.features[0]);
    EXPECT_EQ(sums.walls, 4u);
    EXPECT_EQ(sums.roofs, 2u);
    EXPECT_NEAR(glm::distance(sums.vector, {0.0, 0.0, 60.0}), 0.0, 1e-6);
    EXPECT_TRUE(hasNote(file, "LoD 2:", "2 faces without area dropped, 1 bent ones split"));
    EXPECT_NEAR(*file.features[0].height, 9.5, 1e-9);
}

TEST(CityJson, CourtyardsStayHoles)
{
    // A ring 10 x 10 around a court 4 x 4, LoD 0: the height is an attribute.
    const std::string vertices = "[0,0,0],[10000,0,0],[10000,10000,0],[0,10000,0],"
                                 "[3000,3000,0],[7000,3000,0],[7000,7000,0],[3000,7000,0]";
    for (const std::string ring : {"[0,1,2,3],[4,7,6,5]", "[0,3,2,1],[4,5,6,7]"}) {
        const std::string geometry = R"({"type":"MultiSurface","lod":"0","boundaries":[[)" + ring + "]]}";
        const GeoFile file =
            read(city(building("a", geometry, R"(,"attributes":{"measuredHeight":12.5})"), vertices), true);
        ASSERT_EQ(file.features.size(), 1u);
        ASSERT_EQ(file.features[0].polygons.size(), 1u);
        ASSERT_EQ(file.features[0].polygons[0].holes.size(), 1u);
        EXPECT_NEAR(signedArea(file.features[0].polygons[0].outer), 100.0, 1e-6);
        EXPECT_NEAR(signedArea(file.features[0].polygons[0].holes[0]), -16.0, 1e-6);
        EXPECT_EQ(file.features[0].height, 12.5);
        EXPECT_TRUE(file.features[0].faces.empty()); // nothing stands on it
    }
    // A wall with a hole in it keeps the hole, whatever its direction.
    const std::string wall = kBoxVertices + ",[4000,0,1000],[6000,0,1000],[6000,0,3000],[4000,0,3000]";
    for (const std::string hole : {"[8,11,10,9]", "[8,9,10,11]"}) {
        const std::string geometry = R"({"type":"Solid","lod":"2","boundaries":[[)" + kFloor + "," + kRoof +
                                     ",[[0,1,5,4]," + hole + "],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]]}";
        const GeoFile file = read(city(building("a", geometry), wall), true);
        EXPECT_NEAR(sumsOf(file.features.at(0)).wallArea, 2 * 90.0 + 2 * 54.0 - 4.0, 1e-6) << hole;
    }
}

TEST(CityJson, GroundOfSeveralPiecesIsUnited)
{
    // Two floors of 6 x 5 m side by side without semantics, and a soffit at 6 m that is no ground.
    const std::string vertices = kBoxVertices + ",[5000,0,0],[5000,6000,0],[10000,0,6000],[12000,0,6000],"
                                                "[12000,6000,6000],[10000,6000,6000]";
    const std::string floors = "[[0,3,9,8]],[[8,9,2,1]],[[10,13,12,11]]";
    const std::string geometry =
        R"({"type":"Solid","lod":"2","boundaries":[[)" + floors + "," + kRoof + "," + kWalls + "]]}";
    const GeoFile file = read(city(building("a", geometry), vertices), true);
    ASSERT_EQ(file.features.size(), 1u);
    expectBox(file.features[0]);
    EXPECT_EQ(sumsOf(file.features[0]).roofs, 2u); // the roof and the soffit

    // No floor at all: what the roof covers.
    const std::string open = R"({"type":"Solid","lod":"1","boundaries":[[[[4,5,6]],[[4,6,7]],)" + kWalls + "]]}";
    const GeoFile roofOnly = read(city(building("a", open)));
    ASSERT_EQ(roofOnly.features.size(), 1u);
    expectBox(roofOnly.features[0]);
    EXPECT_TRUE(hasNote(roofOnly, "1 buildings without a floor", "outline of the roof"));
}

TEST(CityJson, GroundOfTrianglesIsOneOutline)
{
    // 12 x 12 squares of 1 m, their inner corners moved by up to 0.4 m, each of two triangles.
    std::string vertices, surfaces;
    for (int y = 0; y <= 12; ++y)
        for (int x = 0; x <= 12; ++x) {
            const bool isInner = x > 0 && y > 0 && x < 12 && y < 12;
            const int dx = isInner ? (x * 7 + y * 13) % 9 * 100 - 400 : 0,
                      dy = isInner ? (x * 11 + y * 5) % 9 * 100 - 400 : 0;
            vertices += concat(vertices.empty() ? "" : ",", "[", 1000 * x + dx, ",", 1000 * y + dy, ",0]");
        }
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 12; ++x) {
            const int a = 13 * y + x, b = a + 1, c = a + 14, d = a + 13;
            surfaces += concat(surfaces.empty() ? "" : ",", "[[", a, ",", b, ",", c, "]],[[", a, ",", c, ",", d, "]]");
        }
    const std::string geometry = R"({"type":"MultiSurface","lod":"1","boundaries":[)" + surfaces + "]}";
    const GeoFile file = read(city(building("a", geometry), vertices));
    ASSERT_EQ(file.features.size(), 1u);
    EXPECT_EQ(file.features[0].polygons.size(), 1u);
    EXPECT_NEAR(footprintArea(file.features[0]), 144.0, 1e-6);
}

TEST(CityJson, TheHighestLodBelowThreeIsTaken)
{
    const auto flat = [](const std::string& lod, const std::string& ring) {
        return R"({"type":"MultiSurface","lod":")" + lod + R"(","boundaries":[[)" + ring + "]]}";
    };
    // The triangle of LoD 0 has 30 m2, as has the one of LoD 3; the box 60.
    const std::string triangle = "[0,1,2]";
    const GeoFile file =
        read(city(building("a", flat("0", triangle) + "," + solid(R"("2.2")") + "," + flat("3", triangle))), true);
    expectBox(file.features.at(0));
    EXPECT_EQ(file.features[0].faces.size(), 5u);
    EXPECT_TRUE(read(city(building("a", solid(R"("1.3")"))), true).features.at(0).faces.empty());
    const GeoFile above = read(city(building("a", flat("0", "[0,1,99]") + "," + flat("3", triangle))));
    EXPECT_NEAR(footprintArea(above.features.at(0)), 30.0, 1e-6);
}

TEST(CityJson, PartsStandForTheirBuilding)
{
    const std::string flat = R"({"type":"MultiSurface","lod":"0","boundaries":[[[0,1,2,3]]]})";
    const std::string parts =
        R"("p1":{"type":"BuildingPart","parents":["a"],"attributes":{"use":"shop"},"geometry":[)" + solid(R"("1")") +
        R"(]},"p2":{"type":"BuildingPart","parents":["a"],"geometry":[)" + solid(R"("1")") + "]}";
    const std::string attributes =
        R"(,"attributes":{"use":"home","year":1930,"listed":true,"address":{"x":1}},"children":["p1","p2"])";
    for (const std::string& own : {std::string(), flat}) {
        const GeoFile file = read(city(building("a", own, attributes) + "," + parts));
        ASSERT_EQ(file.features.size(), 2u);
        EXPECT_EQ(file.features[0].id, "p1");
        EXPECT_EQ(file.features[1].id, "p2");
        EXPECT_EQ(file.features[0].attributes.at("use"), Attribute("shop"));
        EXPECT_EQ(file.features[1].attributes.at("use"), Attribute("home"));
        EXPECT_EQ(file.features[1].attributes.at("year"), Attribute(1930.0));
        EXPECT_EQ(file.features[1].attributes.at("listed"), Attribute(true));
        EXPECT_FALSE(file.features[1].attributes.contains("address"));
        EXPECT_TRUE(file.notes.empty());
    }
    EXPECT_EQ(read(city(building("a", solid(R"("1")"), attributes) + "," + parts)).features.size(), 3u);
    // Parents in a circle end.
    const std::string circle = R"("a":{"type":"BuildingPart","parents":["b"],"geometry":[)" + solid(R"("1")") +
                               R"(]},"b":{"type":"BuildingPart","parents":["a"],"geometry":[)" + solid(R"("1")") + "]}";
    EXPECT_EQ(read(city(circle)).features.size(), 2u);
}

// A whole of 20 x 10 m and 20 m, of which the file also gives the two halves, 20 m and 8 m high.
TEST(CityJson, PartsReplaceAWholeThatHasItsOwnGeometry)
{
    std::string objects, vertices;
    u32 first = 0;
    const auto add = [&](const std::string& head, double x0, double x1, double top) {
        for (const double z : {0.0, top})
            vertices += concat(first + vertices.size() > 0 ? "," : "", "[", x0, ",0,", z, "],[", x1, ",0,", z, "],[",
                               x1, ",10,", z, "],[", x0, ",10,", z, "]");
        const auto face = [&](u32 a, u32 b, u32 c, u32 d) {
            return concat("[[", first + a, ",", first + b, ",", first + c, ",", first + d, "]]");
        };
        objects += concat(first ? "," : "", head, R"(,"geometry":[{"type":"Solid","lod":"1","boundaries":[[)",
                          face(0, 3, 2, 1), ",", face(4, 5, 6, 7), ",", face(0, 1, 5, 4), ",", face(1, 2, 6, 5), ",",
                          face(2, 3, 7, 6), ",", face(3, 0, 4, 7), "]]}]}");
        first += 8;
    };
    add(R"("B":{"type":"Building","children":["P1","P2"])", 0, 20, 20);
    add(R"("P1":{"type":"BuildingPart","parents":["B"])", 0, 10, 20);
    add(R"("P2":{"type":"BuildingPart","parents":["B"])", 10, 20, 8);
    const Result<Layout> layout = parseCity(city(objects, vertices, R"("version":"2.0",)"), "parts.city.json");
    ASSERT_TRUE(layout.ok()) << layout.error().message;
    ASSERT_EQ(layout->footprints.size(), 2u);
    std::map<std::string, double> heights;
    for (const Footprint& footprint : layout->footprints) {
        heights[footprint.id] = footprint.height;
        EXPECT_NEAR(area(footprint.outline), 100.0, 1e-6) << footprint.id;
    }
    EXPECT_EQ(heights, (std::map<std::string, double>{{"P1", 20.0}, {"P2", 8.0}}));
    EXPECT_EQ(layout->counts.at("repaired.replaced_by_parts"), 1u);
}

TEST(CityJson, HeightIsMeasuredOnTheGeometry)
{
    // measuredHeight is above sea level in some files: the box is 9 m high whatever it says.
    const GeoFile box = read(city(building("a", solid(R"("1")"), R"(,"attributes":{"measuredHeight":11.5})")));
    EXPECT_NEAR(box.features.at(0).height.value_or(0.0), 9.0, 1e-9);
    EXPECT_EQ(box.features[0].attributes.at("measuredHeight"), Attribute(11.5));
    const std::string flat = R"({"type":"MultiSurface","lod":"0","boundaries":[[[0,1,2,3]]]})";
    const GeoFile storeys = read(city(building("a", flat, R"(,"attributes":{"storeysAboveGround":3,"height":-4})")));
    EXPECT_FALSE(storeys.features.at(0).height);
    EXPECT_EQ(storeys.features[0].levels, 3.0);
}

TEST(CityJson, OtherObjectsAndTemplatesAreCounted)
{
    const std::string others =
        R"("r1":{"type":"Road","geometry":[]},"r2":{"type":"Road"},"w":{"type":"WaterBody"},"x":7,)";
    const std::string instance = R"({"type":"GeometryInstance","template":0,"boundaries":[0]})";
    const GeoFile file = read(city(others + building("a", solid(R"("1")")) + "," + building("t", instance)));
    ASSERT_EQ(file.features.size(), 1u);
    EXPECT_TRUE(hasNote(file, "4 city objects that are no buildings", "Road 2, WaterBody 1, without a type 1"));
    EXPECT_TRUE(hasNote(file, "1 geometry templates are not supported", "of t"));
    EXPECT_TRUE(hasNote(file, "feature t:", "skipped"));
}

TEST(CityJson, BadGeometryIsSkippedByName)
{
    const auto surface = [](const std::string& boundaries) {
        return R"({"type":"MultiSurface","lod":"1","boundaries":)" + boundaries + "}";
    };
    const struct
    {
        std::string geometry, words;
    } cases[] = {
        {surface("[[[0,1,2,8]]]"), "index 8 is none of 8 vertices"},
        {surface("[[[0,1,2,-1]]]"), "index -1 is none of 8"},
        {surface("[[[0,1,2.5]]]"), "index 2.5 is none"},
        {surface("[[[0,1,99999999999999999999]]]"), "is none of 8"},
        {surface("[[[0,1,[2]]]]"), "is none of 8"},
        {surface("[[[0,1,\"2\"]]]"), "is none of 8"},
        {surface("[[7]]"), "no array of indices"},
        {surface("[[]]"), "without rings"},
        {surface("7"), "not nested arrays"},
        {surface("{}"), "not nested arrays"},
        {surface("[]"), "no surface has an area"},
        {surface("[[[0,0,0]]]"), "no surface has an area"},
        {surface("[[[0,1,5,4]]]"), "no surface has an area seen from above"},
        {R"({"type":"Solid","lod":"1","boundaries":[[[0,1,2,3]]]})", "no array of indices"},
        {R"({"type":"Solid","lod":"1"})", "no surface has an area"},
        {R"({"type":"MultiPoint","lod":"1","boundaries":[0,1]})", "no surfaces"},
        {"7", "no surfaces"},
        {"", "no surfaces"},
    };
    for (const auto& [geometry, words] : cases) {
        const GeoFile file = read(city(building("bad", geometry) + "," + building("good", solid(R"("1")"))), true);
        ASSERT_EQ(file.features.size(), 1u) << geometry;
        EXPECT_EQ(file.features[0].id, "good");
        EXPECT_TRUE(hasNote(file, "feature bad:", words)) << geometry;
    }
    // A bad wall does not cost the building.
    const GeoFile file = read(city(building("a", surface("[" + kShell + ",[[0,1,77]]]"))));
    expectBox(file.features.at(0));
    EXPECT_TRUE(hasNote(file, "feature a:", "1 surfaces not usable (index 77"));
}

TEST(CityJson, BadVerticesAreSkippedByName)
{
    for (const std::string vertex : {"[1e308,0,0]", "[0,-1e12,0]", "[0,0]", "[0,0,\"1\"]", "7", "null", "[0,0,null]"}) {
        const GeoFile file =
            read(city(building("a", R"({"type":"MultiSurface","lod":"0","boundaries":[[[0,1,2]],[[0,1,8]]]})"),
                      kBoxVertices + "," + vertex));
        ASSERT_EQ(file.features.size(), 1u) << vertex;
        EXPECT_NEAR(footprintArea(file.features[0]), 30.0, 1e-6) << vertex;
        EXPECT_TRUE(hasNote(file, "feature a:", "vertex 8 is not usable")) << vertex;
    }
    const GeoFile far = read(city(building("a", R"({"type":"MultiSurface","lod":"0","boundaries":[[[0,1,8]]]})"),
                                  kBoxVertices + ",[0,100000000,0]"));
    EXPECT_TRUE(far.features.empty());
    EXPECT_TRUE(hasNote(far, "feature a:", "over 10 km"));
}

TEST(CityJson, ErrorsNameThePlace)
{
    const std::string good = city(building("a", solid(R"("1")")));
    const std::string header = R"({"type":"CityJSON","version":"2.0","CityObjects":{},"vertices":[]})";
    const struct
    {
        std::string text, words;
    } cases[] = {
        {"", "a.city.json:1: byte 0: not JSON"},
        {"{\n\"type\":\"CityJSON\",\n\"version\":}", "a.city.json:3: byte 31: not JSON"},
        {good.substr(0, good.size() - 1), "not JSON"},
        {header + "\n{\"type\":\"CityJSONFeature\",]}\n", "a.city.json:2: byte 93: not JSON"},
        {"{\"type\":\"CityJSON\",\"x\":" + std::string(100, '[') + std::string(100, ']') + "}", "nests deeper than 64"},
        {R"({"type":"CityJSON","version":"2.0","x":1e999})", "a.city.json:1: byte 0: "},
        {"[]", "instead of \"CityJSON\""},
        {R"({"type":"FeatureCollection","features":[]})", "type \"FeatureCollection\" instead of \"CityJSON\""},
        {R"({"type":"CityJSONFeature","CityObjects":{}})", "a sequence starts with its header"},
        {city("", "", R"("version":"0.9",)"), "version 0.9 is not 1.x or 2.x"},
        {city("", "", R"("metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/4979"},)"),
         "EPSG:4979 is in degrees"},
        {city("", "", R"("transform":{"scale":[1,1],"translate":[0,0,0]},)"), "transform needs"},
        {city("", "", R"("transform":{"scale":[1,1,"1"],"translate":[0,0,0]},)"), "transform needs"},
        {city("", "", R"("transform":7,)"), "transform needs"},
    };
    for (const auto& [text, words] : cases) {
        const Result<GeoFile> file = readCityJson(text, "a.city.json", true);
        ASSERT_FALSE(file.ok()) << text;
        EXPECT_TRUE(file.error().message.starts_with("a.city.json:")) << file.error().message;
        EXPECT_NE(file.error().message.find(words), std::string::npos) << file.error().message;
        EXPECT_EQ(file.error().message.find('\n'), std::string::npos) << file.error().message;
    }
    EXPECT_TRUE(hasNote(read(R"({"type":"CityJSON","version":"2.0"})"), "", "no object \"CityObjects\""));
    EXPECT_TRUE(hasNote(read(header + "\n{\"type\":\"CityJSONFeature\"}\n"), "line 2:", "no object \"CityObjects\""));
}

TEST(CityJson, IsToldFromGeoJson)
{
    EXPECT_TRUE(isCityJson(R"( {"version":"2.0","vertices":[{"type":"x"}],"type" : "CityJSON"})"));
    EXPECT_TRUE(isCityJson(R"({"CityObjects":{}})"));
    EXPECT_FALSE(isCityJson(R"({"type":"FeatureCollection","features":[{"type":"CityJSON","CityObjects":1}]})"));
    EXPECT_FALSE(isCityJson(R"({"type":"FeatureCollection","name":"CityObjects \"type\": \"CityJSON\""})"));
    for (const char* text : {"", "{", "\"", "[\"CityObjects\"", "{\"type", "{\"type\":\"City", "{}{\"CityObjects\"",
                             "}", "{\"\\", "{\"name\":\"CityObjects\"}", "{\"name\":\"type\",\"x\":\"CityJSON\"}"})
        EXPECT_FALSE(isCityJson(text)) << text;
}

} // namespace
