// SPDX-License-Identifier: Apache-2.0
// Leaves on walls that a neighbour covers in part: a free and a covered shape each.
#include <glm/common.hpp>

#include "city/grammar/occlusion.h"
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

double coveredArea(const Derivation& d, bool covered)
{
    double sum = 0.0;
    for (const Shape& shape : d.shapes.shapes)
        if (shape.polygonCount > 0 && shape.covered == covered) sum += areaOf(d, shape);
    return sum;
}

TEST(GrammarCovered, PlainWallBesideALowerNeighbour)
{
    // A side of 8 x 9 m beside a neighbour of 5 m: 40 m2 of it see nothing.
    Footprint box = boxFootprint(10, 8, 9);
    cover(box, 1, 5);
    const Derivation d = mustDerive("Lot --> extrude(9) comp(f) { right : Wall. | all : NIL }", {box});
    const auto leaves = leavesOf(d, "Wall");
    ASSERT_EQ(leaves.size(), 2u);
    EXPECT_FALSE(leaves[0]->covered);
    EXPECT_TRUE(leaves[1]->covered);
    EXPECT_NEAR(areaOf(d, *leaves[0]), 8 * 4, 1e-9);
    EXPECT_NEAR(areaOf(d, *leaves[1]), 8 * 5, 1e-9);
    expectNear(boundsOf(d, *leaves[0]).first, {10, 0, 5});
    expectNear(boundsOf(d, *leaves[1]).second, {10, 8, 5});
    for (const Shape* leaf : leaves) expectNear(unitNormal(d.shapes.polygons[leaf->polygonBegin]), {1, 0, 0});
    // The node of the leaf stays, with both below it.
    const u32 first = u32(leaves[0] - d.shapes.shapes.data());
    EXPECT_EQ(treeKey(d.shapes, first), "0/0");
    EXPECT_EQ(treeKey(d.shapes, first + 1), "0/1");
    EXPECT_EQ(leaves[0]->parent, leaves[1]->parent);
    EXPECT_EQ(d.shapes.shapes[leaves[0]->parent].op, ShapeOp::Component);
    EXPECT_EQ(d.shapes.shapes[leaves[0]->parent].polygonCount, 0u);
    EXPECT_EQ(leaves[0]->surface, leaves[1]->surface);
    EXPECT_EQ(d.counts.coveredLeaves, 1u);
    EXPECT_TRUE(d.warnings.empty()) << d.warnings[0];
}

TEST(GrammarCovered, SpansAreMerged)
{
    const auto covered = [](std::vector<CoveredSpan> spans) {
        Footprint box = boxFootprint(10, 8, 6);
        box.covered[0] = std::move(spans);
        const Derivation d = mustDerive("Lot --> extrude(6) comp(f) { front : Wall. | all : NIL }", {box});
        const double hidden = coveredArea(d, true);
        EXPECT_NEAR(hidden + coveredArea(d, false), 60, 1e-9);
        return hidden;
    };
    EXPECT_NEAR(covered({{1, 4, 3}, {3, 6, 5}}), 2 * 3 + 3 * 5, 1e-9); // they overlap
    EXPECT_NEAR(covered({{3, 6, 5}, {1, 4, 3}}), 2 * 3 + 3 * 5, 1e-9);
    EXPECT_NEAR(covered({{1, 2, 3}, {5, 7, 9}}), 1 * 3 + 2 * 6, 1e-9); // with a gap; higher than the wall
    EXPECT_NEAR(covered({{-3, 2, 3}, {9, 30, 4}}), 2 * 3 + 1 * 4, 1e-9);
    // Up to a centimetre makes no cut.
    EXPECT_EQ(covered({{0, 0.009, 6}}), 0.0);
    EXPECT_EQ(covered({{0, 10, 0.009}}), 0.0);
    EXPECT_NEAR(covered({{0, 9.992, 5.993}}), 60, 1e-9);
    EXPECT_NEAR(covered({{0, 5, 3}, {5.004, 10, 3}}), 30, 1e-9);
    EXPECT_NEAR(covered({{0, 0.02, 6}}), 0.02 * 6, 1e-9);
    EXPECT_NEAR(covered({{0, 10, 5.98}}), 59.8, 1e-9);
}

TEST(GrammarCovered, ConcaveFacesAndHoles)
{
    // A U of 10 x 6 m with a notch of x 4..6, y 2..6 and a hole of x 1..2, y 1..3: 60 - 8 - 2 = 50 m2.
    using namespace cga;
    Footprint box = boxFootprint(10, 8, 6);
    Face face;
    face.polygon.outer = {{0, 0, 0}, {10, 0, 0}, {10, 6, 0}, {6, 6, 0}, {6, 2, 0}, {4, 2, 0}, {4, 6, 0}, {0, 6, 0}};
    face.polygon.holes = {{{1, 1, 0}, {1, 3, 0}, {2, 3, 0}, {2, 1, 0}}};
    ASSERT_NEAR(area(face.polygon), 50, 1e-12);
    const Scope front{{0, 0, 0}, glm::dmat3(1.0), {10, 6, 0}};
    box.covered[0] = {{1.5, 7, 4}};
    Geometry open, hidden;
    Occlusion(box).divide(front, face, 0, open, hidden);
    // 5.5 x 4, less 2 x 2 of the notch and 0.5 x 2 of the hole.
    EXPECT_NEAR(area(hidden), 22 - 4 - 1, 1e-9);
    EXPECT_NEAR(area(open), 50 - 17, 1e-9);
    for (const Geometry* part : {&open, &hidden})
        for (const Face& piece : part->faces) {
            expectNear(unitNormal(piece.polygon), {0, 0, 1});
            const glm::dvec3 middle = centroid(piece.polygon);
            EXPECT_EQ(middle.x > 1.5 && middle.x < 7 && middle.y < 4, part == &hidden) << middle.x << " " << middle.y;
        }
    // On another edge, or before the wall, nothing is covered.
    open = hidden = {};
    Occlusion(box).divide(front, face, 1, open, hidden);
    Occlusion(box).divide({{0, 0, 0.06}, glm::dmat3(1.0), {10, 6, 0}}, face, 0, open, hidden);
    EXPECT_TRUE(hidden.faces.empty());
    EXPECT_EQ(open.faces.size(), 2u);
}

TEST(GrammarCovered, SolidsWithoutFacesOfTheirOwn)
{
    Footprint box = boxFootprint(10, 8, 6);
    box.covered[0] = {{0, 10, 3}};
    box.covered[3] = {{2, 5, 10}}; // from y = 6 down to y = 3
    const Derivation d = mustDerive("Lot --> extrude(6) Mass.", {box});
    ASSERT_EQ(leavesOf(d, "Mass").size(), 2u);
    EXPECT_NEAR(areaOf(d, *leavesOf(d, "Mass")[1]), 10 * 3 + 3 * 6, 1e-9);
    EXPECT_NEAR(totalArea(d), 2 * 80 + 36 * 6, 1e-9);
    EXPECT_NEAR(enclosedVolume(d), 480, 1e-9);
    const auto [low, high] = boundsOf(d, *leavesOf(d, "Mass")[1]);
    expectNear(low, {0, 0, 0});
    expectNear(high, {10, 6, 6});
    // What a rule builds on a wall stands out of it and stays whole.
    box.covered[0] = {{0, 5, 6}};
    const Derivation sill = mustDerive("Lot --> extrude(6) comp(f) { front : extrude(0.3) Sill. | all : NIL }", {box});
    ASSERT_EQ(leavesOf(sill, "Sill").size(), 1u);
    EXPECT_FALSE(leavesOf(sill, "Sill")[0]->covered);
}

TEST(GrammarCovered, GivenGable)
{
    // A gable of 8 m, 6 m at its eaves and 9 m at its ridge, beside a neighbour of 7 m: the top of 1 / 3 of the height
    // of the triangle over 2 / 3 of its width stays free, and no other part.
    Footprint house = boxFootprint(10, 8, 9);
    house.covered[1] = {{-0.001, 8.001, 7}};
    house.faces.push_back({{{{10, 0, 0}, {10, 8, 0}, {10, 8, 6}, {10, 4, 9}, {10, 0, 6}}, {}}, GivenKind::Wall});
    const Derivation d = mustDerive("Lot --> X.\nWallSurface --> Wall.", {house});
    const double top = 0.5 * (8.0 * 2 / 3) * 2;
    EXPECT_NEAR(coveredArea(d, false), top, 1e-9);
    EXPECT_NEAR(coveredArea(d, true), 8 * 6 + 0.5 * 8 * 3 - top, 1e-9);
}

} // namespace
} // namespace helio::test
