// SPDX-License-Identifier: Apache-2.0
// Buildings that the input models by their surfaces.
#include "city/grammar/limits.h"
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

/// A box of 10 x 8 x 6 m with a gabled roof of 3 m, ridge along x, in the world at (100, 50, 2): four walls (the gable
/// ends with their triangles), two roofs, the ground.
Footprint gabledHouse()
{
    Footprint house = boxFootprint(10, 8, 9);
    house.base = 2;
    for (glm::dvec2& p : house.outline.outer) p += glm::dvec2(100, 50);
    const auto add = [&](GivenKind kind, Ring3 ring) {
        for (glm::dvec3& p : ring) p += glm::dvec3(100, 50, 2);
        house.faces.push_back({{std::move(ring), {}}, kind});
    };
    add(GivenKind::Wall, {{10, 0, 0}, {10, 0, 6}, {0, 0, 6}, {0, 0, 0}}); // starts at its right side
    add(GivenKind::Wall, {{10, 0, 0}, {10, 8, 0}, {10, 8, 6}, {10, 4, 9}, {10, 0, 6}});
    add(GivenKind::Wall, {{10, 8, 0}, {0, 8, 0}, {0, 8, 6}, {10, 8, 6}});
    add(GivenKind::Wall, {{0, 8, 0}, {0, 0, 0}, {0, 0, 6}, {0, 4, 9}, {0, 8, 6}});
    add(GivenKind::Roof, {{0, 0, 6}, {10, 0, 6}, {10, 4, 9}, {0, 4, 9}});
    add(GivenKind::Roof, {{10, 8, 6}, {0, 8, 6}, {0, 4, 9}, {10, 4, 9}});
    add(GivenKind::Ground, {{0, 0, 0}, {0, 8, 0}, {10, 8, 0}, {10, 0, 0}});
    return house;
}

TEST(GrammarFaces, RulesRunOnEachSurface)
{
    const Derivation d = mustDerive(
        "Lot --> X.\nWallSurface --> report(\"wall\", scope.sx) report(\"high\", scope.sy) split(y) { 3 : Low. | ~1 : "
        "High. }\nRoofSurface --> report(\"roof\", geometry.area) report(\"deep\", scope.sz) Tiles.\nGroundSurface --> "
        "NIL",
        {gabledHouse()});
    EXPECT_TRUE(d.warnings.empty()) << d.warnings[0];
    EXPECT_NEAR(d.reports.at("wall"), 10 + 8 + 10 + 8, 1e-9); // x along the lowest edge
    EXPECT_NEAR(d.reports.at("high"), 6 + 9 + 6 + 9, 1e-9);
    EXPECT_NEAR(d.reports.at("roof"), 2 * 10 * 5, 1e-9); // slopes of 4 and 3 m: 5 m
    EXPECT_NEAR(d.reports.at("deep"), 0, 1e-9);
    EXPECT_NEAR(areaOf(d, "Low"), 3 * 36, 1e-9);
    EXPECT_NEAR(areaOf(d, "High"), 3 * 36 + 2 * 0.5 * 8 * 3, 1e-9);
    EXPECT_EQ(leavesOf(d, "X").size(), 0u);
    expectNear(boundsOf(d, *leavesOf(d, "Low")[0]).first, {100, 50, 2});
    expectNear(boundsOf(d, *leavesOf(d, "Low")[0]).second, {110, 50, 5});
    expectNear(unitNormal(d.shapes.polygons[leavesOf(d, "Low")[0]->polygonBegin]), {0, -1, 0});
    for (const Shape* leaf : leavesOf(d, "Tiles")) EXPECT_EQ(d.shapes.shapes[leaf->parent].op, ShapeOp::Component);
}

TEST(GrammarFaces, WithoutRulesTheyStayPlain)
{
    const Derivation d = mustDerive("Lot --> X.", {gabledHouse(), gabledHouse()});
    EXPECT_EQ(d.warnings.size(), 3u); // once a kind
    EXPECT_NEAR(areaOf(d, "WallSurface"), 2 * (36 * 6 + 24), 1e-9);
    EXPECT_NEAR(areaOf(d, "RoofSurface"), 2 * 100, 1e-9);
    EXPECT_EQ(d.shapes.surfaces[leavesOf(d, "WallSurface")[0]->surface].name, "render");
    EXPECT_EQ(d.shapes.surfaces[leavesOf(d, "RoofSurface")[0]->surface].name, "clay_tiles");
}

TEST(GrammarFaces, WallsKnowTheirNeighbours)
{
    Footprint house = gabledHouse();
    house.covered[1] = {{0, 8, 20}};
    const Derivation d = mustDerive("Lot --> X.\nWallSurface --> case inside(inter) : Blank. else : Free.\nRoofSurface "
                                    "--> R.\nGroundSurface --> NIL",
                                    {house});
    ASSERT_EQ(leavesOf(d, "Blank").size(), 1u);
    EXPECT_TRUE(leavesOf(d, "Blank")[0]->covered);
    expectNear(boundsOf(d, *leavesOf(d, "Blank")[0]).first, {110, 50, 2});
    EXPECT_EQ(leavesOf(d, "Free").size(), 3u);
}

TEST(GrammarFaces, BrokenSurfacesAreLeftOut)
{
    Footprint house = gabledHouse();
    house.faces[0].polygon.outer.resize(2);
    house.faces[1].polygon.outer[0].x = 1e300;
    house.faces[2].polygon.outer.clear();
    const Derivation d =
        mustDerive("Lot --> X.\nWallSurface --> W.\nRoofSurface --> R.\nGroundSurface --> NIL", {house});
    EXPECT_EQ(leavesOf(d, "W").size(), 1u);
    EXPECT_EQ(treeKey(d.shapes, u32(leavesOf(d, "W")[0] - d.shapes.shapes.data())), "3/0");
    house.outline = {};
    house.covered.clear();
    EXPECT_EQ(
        leavesOf(mustDerive("Lot --> X.\nWallSurface --> W.\nRoofSurface --> R.\nGroundSurface --> NIL", {house}), "R")
            .size(),
        2u);
}

} // namespace
} // namespace helio::test
