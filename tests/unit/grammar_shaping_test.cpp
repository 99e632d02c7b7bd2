// SPDX-License-Identifier: Apache-2.0
// Operations that make or change geometry, and what rules can ask about it.
#include <algorithm>

#include "city/grammar/cleanup.h"
#include "city/grammar/program.h"
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

const Footprint kBox = boxFootprint(10, 8, 6);
const Ring2 kL = {{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}};

double value(const std::string& operations, const std::string& expression, const Footprint& footprint = kBox)
{
    const Derivation d = mustDerive("Lot --> " + operations + " report(\"k\", " + expression + ") A.", {footprint});
    const auto found = d.reports.find("k");
    return found == d.reports.end() ? NAN : found->second;
}

void expectBounds(const Derivation& d, glm::dvec3 low, glm::dvec3 high)
{
    ASSERT_EQ(leavesOf(d, "A").size(), 1u);
    expectNear(boundsOf(d, *leavesOf(d, "A")[0]).first, low);
    expectNear(boundsOf(d, *leavesOf(d, "A")[0]).second, high);
}

TEST(GrammarShaping, PrimitivesFillTheScope)
{
    // A regular octagon in an ellipse with half axes 5 and 4: 8 / 2 sin(45) x 20 m2.
    const double octagon = 4 * std::sin(M_PI / 4) * 20;
    const Derivation cylinder = mustDerive("Lot --> s('1, 6, '1) primitiveCylinder(8) A.", {kBox});
    EXPECT_NEAR(enclosedVolume(cylinder), octagon * 6, 1e-9);
    expectBounds(cylinder, {0, 0, 0}, {10, 8, 6});
    EXPECT_NEAR(enclosedVolume(mustDerive("Lot --> s('1, 6, '1) primitiveCone(8) A.", {kBox})), octagon * 2, 1e-9);
    EXPECT_NEAR(totalArea(mustDerive("Lot --> primitiveDisk(8) A.", {kBox})), octagon, 1e-9);
    // Sizes of 0 follow the mean of the others: 9 m.
    EXPECT_NEAR(enclosedVolume(mustDerive("Lot --> primitiveCube() A.", {kBox})), 10 * 8 * 9, 1e-9);
    EXPECT_NEAR(enclosedVolume(mustDerive("Lot --> s(0, 5, 0) primitiveCube() A.", {kBox})), 125, 1e-9);
    EXPECT_NEAR(enclosedVolume(mustDerive("Lot --> s(0, 0, 0) primitiveCube() A.", {kBox})), 1, 1e-9);
    EXPECT_EQ(leavesOf(mustDerive("Lot --> primitiveCylinder() A.", {kBox}), "A")[0]->polygonCount, 18u);
}

TEST(GrammarShaping, PrimitivesWithSizesStandInTheMiddleOfTheFloor)
{
    const Derivation cube = mustDerive("Lot --> primitiveCube(2, 3, 4) A.", {kBox});
    EXPECT_NEAR(enclosedVolume(cube), 24, 1e-9);
    expectBounds(cube, {4, 2, 0}, {6, 6, 3});
    const Derivation sphere = mustDerive("Lot --> primitiveSphere(4, 2, 3) A.", {kBox}); // an octahedron
    EXPECT_NEAR(enclosedVolume(sphere), 4.0 / 3 * 27, 1e-9);
    expectBounds(sphere, {2, 1, 0}, {8, 7, 6});
    const Derivation disk = mustDerive("Lot --> primitiveDisk(4, 2) A.", {kBox}); // a square on its corner
    EXPECT_NEAR(totalArea(disk), 8, 1e-9);
    expectBounds(disk, {3, 2, 0}, {7, 6, 0});
    // On a wall the quad lies in the wall and looks as it does.
    const Derivation quad =
        mustDerive("Lot --> extrude(6) comp(f) { front : primitiveQuad(4, 2) A. | all : NIL }", {kBox});
    expectBounds(quad, {3, 0, 2}, {7, 0, 4});
    expectNear(unitNormal(quad.shapes.polygons[0]), {0, -1, 0});
    const Derivation side = mustDerive("Lot --> rotateScope(0, 0, 90) primitiveQuad() A.", {kBox}); // flat along x
    EXPECT_NEAR(totalArea(side), 80, 1e-9);
    EXPECT_NEAR(std::abs(unitNormal(side.shapes.polygons[0]).z), 1, 1e-9);
    EXPECT_NE(errorOf("Lot --> primitiveCylinder(2) A.").find("3 to 256"), std::string::npos);
    EXPECT_NE(errorOf("Lot --> primitiveCylinder(1e9) A.").find("3 to 256"), std::string::npos);
    EXPECT_NE(errorOf("Lot --> primitiveCylinder(8, 1) A.").find("takes no numbers, 1 or 3"), std::string::npos);
    EXPECT_NE(errorOf("Lot --> primitiveCone(8, 1, 0) A.").find("above 0"), std::string::npos);
}

TEST(GrammarShaping, BuiltinNamesArePrimitives)
{
    DeriveOptions none;
    none.jobs = 1;
    const Derivation d = mustDerive(
        "Lot --> s('1, 6, '1) i(\"builtin:cube\") A.\nOther --> s('1, 6, '1) i(\"builtin:cylinder8:notex\") A.", {kBox},
        none);
    EXPECT_NEAR(enclosedVolume(d), 480, 1e-9);
    EXPECT_EQ(leavesOf(d, "A")[0]->asset, kNoIndex);
}

TEST(GrammarShaping, MirrorAndReverse)
{
    const Footprint l = footprintOf(kL, 6);
    // Half of the L: 44 m2 in the west, 20 in the east.
    const std::string halves = " split(x) { '0.5 : A. | ~1 : B. }";
    EXPECT_NEAR(areaOf(mustDerive("Lot -->" + halves, {l}), "A"), 44, 1e-9);
    const Derivation mirrored = mustDerive("Lot --> mirror(true, false, false)" + halves, {l});
    EXPECT_NEAR(areaOf(mirrored, "A"), 20, 1e-9);
    expectNear(unitNormal(mirrored.shapes.polygons[0]), {0, 0, 1});
    EXPECT_NEAR(enclosedVolume(mustDerive("Lot --> extrude(6) mirror(true, false, false) A.", {l})), 64 * 6, 1e-9);
    EXPECT_NEAR(enclosedVolume(mustDerive("Lot --> extrude(6) mirror(true, true, false) A.", {l})), 64 * 6, 1e-9);
    EXPECT_NEAR(enclosedVolume(mustDerive("Lot --> extrude(6) reverseNormals() A.", {l})), -64 * 6, 1e-9);
    EXPECT_NEAR(enclosedVolume(mustDerive("Lot --> extrude(6) reverseNormals() reverseNormals A.", {l})), 64 * 6, 1e-9);
    EXPECT_NE(errorOf("Lot --> i(\"a.glb\") reverseNormals() A.").find("belongs before i(..)"), std::string::npos);
}

TEST(GrammarShaping, CleanupGeometry)
{
    const Footprint straight = footprintOf({{0, 0}, {5, 0}, {10, 0}, {10, 8}, {0, 8}}, 6);
    EXPECT_EQ(value("", "geometry.nEdges", straight), 5);
    EXPECT_EQ(value("cleanupGeometry(vertices, 0)", "geometry.nEdges", straight), 4);
    // A bend of 0.57 degrees: 10 degrees x 0.1 reaches it, 10 x 0.05 does not.
    const Footprint bent = footprintOf({{0, 0}, {5, 0.05}, {10, 0}, {10, 8}, {0, 8}}, 6);
    EXPECT_EQ(value("cleanupGeometry(all, 0.05)", "geometry.nEdges", bent), 5);
    EXPECT_EQ(value("cleanupGeometry(all, 0.2)", "geometry.nEdges", bent), 4);
    const Footprint shortEdge = footprintOf({{0, 0}, {10, 0}, {10, 0.05}, {10, 8}, {0, 8}}, 6);
    EXPECT_EQ(value("cleanupGeometry(vertices, 0.1)", "geometry.nEdges", shortEdge), 4);
    // Walls keep their neighbours: the numbers of the footprint's edges survive.
    Footprint neighbour = straight;
    cover(neighbour, 3, 6); // the north side
    const Derivation d = mustDerive("Lot --> cleanupGeometry(all, 0) extrude(6) comp(f) { side : case inside(inter) : "
                                    "Blank. else : Free. | all : NIL }",
                                    {neighbour});
    EXPECT_NEAR(areaOf(d, "Blank"), 60, 1e-9);
    EXPECT_EQ(leavesOf(d, "Free").size(), 3u);
    EXPECT_NE(errorOf("Lot --> cleanupGeometry(all, 2) A.").find("from 0 to 1"), std::string::npos);
}

TEST(GrammarShaping, CleanupJoinsCoplanarFaces)
{
    using namespace cga;
    // Eight unit squares around a missing one, in y = 0, seen from above.
    Geometry ring;
    for (int x = 0; x < 3; ++x)
        for (int z = 0; z < 3; ++z)
            if (x != 1 || z != 1)
                ring.faces.emplace_back().polygon.outer = {{x, 0, z + 1}, {x + 1, 0, z + 1}, {x + 1, 0, z}, {x, 0, z}};
    const Geometry joined = cleaned(ring, kCleanVertices | kCleanEdges, 0.0);
    ASSERT_EQ(joined.faces.size(), 1u);
    EXPECT_EQ(joined.faces[0].polygon.outer.size(), 4u);
    ASSERT_EQ(joined.faces[0].polygon.holes.size(), 1u);
    EXPECT_EQ(joined.faces[0].polygon.holes[0].size(), 4u);
    EXPECT_NEAR(area(joined), 8, 1e-12);
    expectNear(unitNormal(joined.faces[0].polygon), {0, 1, 0});
    // Faces that only touch in a corner, and faces at an angle, stay.
    Geometry apart;
    apart.faces.push_back(ring.faces[0]);
    apart.faces.push_back(ring.faces[0]);
    for (glm::dvec3& p : apart.faces[1].polygon.outer) p += glm::dvec3(1, 0, 1);
    EXPECT_EQ(cleaned(apart, kCleanVertices | kCleanEdges, 0.0).faces.size(), 2u);
    // A face that is there twice, and one without area.
    Geometry twice;
    twice.faces = {ring.faces[0], ring.faces[0], ring.faces[1]};
    twice.faces[2].polygon.outer[2].z = twice.faces[2].polygon.outer[3].z = twice.faces[2].polygon.outer[0].z - 1e-12;
    EXPECT_EQ(cleaned(twice, kCleanVertices | kCleanFaces, 0.0).faces.size(), 1u);
}

TEST(GrammarShaping, DeleteHoles)
{
    const Footprint court = footprintOf({{0, 0}, {10, 0}, {10, 10}, {0, 10}}, 6, {{{3, 3}, {3, 7}, {7, 7}, {7, 3}}});
    EXPECT_NEAR(value("", "geometry.area", court), 84, 1e-9);
    EXPECT_EQ(value("", "geometry.nHoles", court), 1);
    EXPECT_NEAR(value("deleteHoles()", "geometry.area", court), 100, 1e-9);
    EXPECT_NEAR(value("deleteHoles() extrude(6)", "geometry.volume", court), 600, 1e-9);
    const auto solid = deriveText("Lot --> extrude(6) deleteHoles() A.", {court});
    ASSERT_FALSE(solid.ok());
    EXPECT_NE(solid.error().message.find("before extrude"), std::string::npos);
}

TEST(GrammarShaping, GeometryPredicates)
{
    EXPECT_EQ(value("extrude(6)", "geometry.nVertices"), 8);
    EXPECT_EQ(value("extrude(6)", "geometry.nEdges"), 12);
    EXPECT_EQ(value("extrude(6)", "geometry.isClosedSurface"), 1);
    EXPECT_EQ(value("", "geometry.isClosedSurface"), 0);
    EXPECT_EQ(value("extrude(6)", "geometry.isOriented"), 1);
    EXPECT_EQ(value("extrude(6)", "geometry.boundaryLength"), 0);
    EXPECT_EQ(value("", "geometry.boundaryLength"), 36);
    EXPECT_EQ(value("", "geometry.isPlanar"), 1);
    EXPECT_EQ(value("", "geometry.isRectangular"), 1);
    EXPECT_EQ(value("", "geometry.isConcave", footprintOf(kL, 6)), 1);
    EXPECT_NE(errorOf("Lot --> report(\"k\", geometry.du(0, 0)) A.").find("not supported"), std::string::npos);
}

TEST(GrammarShaping, FunctionsOfTextAndNumbers)
{
    EXPECT_EQ(value("", "int(-2.7) + int(\"3.9\") + int(true)"), -2 + 3 + 1);
    EXPECT_EQ(value("", "replace(\"a-b-c\", \"-\", \"+-\") == \"a+-b+-c\""), 1);
    EXPECT_EQ(value("", "len(replace(\"aaa\", \"a\", \"\"))"), 0);
    EXPECT_EQ(value("", "isnan(1) || isinf(1)"), 0);
    EXPECT_EQ(value("color(1, 0, 0, 0.25)", "material.opacity"), 0.25);
    EXPECT_EQ(value("set(trim.vertical, false)", "(case trim.vertical : 1 else : 2)"), 2);
    EXPECT_NE(errorOf("Lot --> report(\"k\", int(\"x\")) A.").find("int cannot read"), std::string::npos);
    EXPECT_NE(errorOf("f(s, n) = case n > 40 : s else : f(replace(s, \"a\", \"aa\"), n + 1)\nLot --> report(f(\"a\", "
                      "0), 1) A.")
                  .find("longer than"),
              std::string::npos);
}

TEST(GrammarShaping, LocalsAreEvaluatedOnceOnEntry)
{
    EXPECT_EQ(
        mustDerive("f(x) with ( y := x * 2 z := y + 1 ) = 100 * x + 10 * y + z\nLot --> report(\"k\", f(3)) A.", {kBox})
            .reports.at("k"),
        300 + 60 + 7);
    // The local of a rule is the entering shape's, drawn once.
    const Derivation d = mustDerive("Lot --> W(2)\nW(n) with ( wide := scope.sx r := rand() ) --> s('0.5, '1, '1) "
                                    "report(\"wide\", wide * n) report(\"same\", r - r) A.",
                                    {kBox});
    EXPECT_EQ(d.reports.at("wide"), 20);
    EXPECT_EQ(d.reports.at("same"), 0);
    EXPECT_EQ(value("split(x) { ~1 : W }\nW with ( a := 4 ) --> report(\"k\", a) A.\nV -->", "0"), 4);
}

TEST(GrammarShaping, PrintsAndNoticesAreFew)
{
    const auto warnings = [](const std::string& rules) { return mustDerive(rules, {kBox, kBox}).warnings; };
    EXPECT_EQ(warnings("Lot --> print(\"sx \" + scope.sx) print(\"sx \" + scope.sx) A."),
              std::vector<std::string>({"t.cga:1:9: print: sx 10", "t.cga:1:33: print: sx 10"}));
    EXPECT_EQ(warnings("Lot --> split(x) { 0.1 : print(split.index) A. }*").size(), 21u);
    EXPECT_EQ(warnings("Lot --> texture(\"a\") setupProjection(0, scope.xy, 1, 1) tileUV(0, 1, 1) A.").size(), 1u);
    ASSERT_EQ(warnings("Lot --> set(material.name, \"moonstone\") A.").size(), 1u);
    EXPECT_NE(warnings("Lot --> set(material.name, \"moonstone\") A.")[0].find("moonstone"), std::string::npos);
    // A value outside its range: the first building is named.
    Footprint tall = boxFootprint(10, 8, 40), taller = boxFootprint(10, 8, 50);
    tall.id = "tall";
    const auto range =
        mustDerive("@Range(min=3, max=14)\nattr height = 6\nLot --> report(\"h\", height) A.", {tall, taller});
    EXPECT_EQ(range.reports.at("h"), 90);
    ASSERT_EQ(range.warnings.size(), 1u);
    EXPECT_NE(range.warnings[0].find("'height' is outside its range: 40 of building 'tall'"), std::string::npos);
}

} // namespace
} // namespace helio::test
