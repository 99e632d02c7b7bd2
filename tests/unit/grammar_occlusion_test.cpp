// SPDX-License-Identifier: Apache-2.0
// What rules know of the walls that neighbours cover, and what becomes of openings there.
#include "city/grammar/occlusion.h"
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

/// Answers on the south wall of a 10 x 8 x 12 m box, per piece that the rules cut, in their order: T touches, O
/// overlaps, I inside, - none.
std::string answers(std::vector<CoveredSpan> spans, const std::string& pieces)
{
    Footprint box = boxFootprint(10, 8, 12);
    box.covered[0] = std::move(spans);
    const Derivation d = mustDerive("Lot --> extrude(12) comp(f) { front : " + pieces +
                                        " | all : NIL }\nQ --> case inside(inter) && touches(inter) : I. case "
                                        "overlaps(inter) && touches(inter) : O. case touches(inter) || "
                                        "overlaps(inter) || inside(inter) : X. else : N.",
                                    {box});
    std::string text;
    for (const Shape& shape : d.shapes.shapes) {
        const std::string& name = d.shapes.names[shape.name];
        const bool half = shape.parent != kNoIndex && d.shapes.shapes[shape.parent].name == shape.name;
        if (!half && (name == "I" || name == "O" || name == "X" || name == "N")) text += name == "N" ? "-" : name;
    }
    return text;
}

TEST(GrammarOcclusion, TouchesOverlapsInside)
{
    const std::string bays = "split(x) { 2.5 : Q }*", floors = "split(y) { 3 : Q }*";
    EXPECT_EQ(answers({}, bays), "----");
    EXPECT_EQ(answers({{0, 10, 12}}, bays), "IIII");
    EXPECT_EQ(answers({{0, 5, 12}}, bays), "II--"); // the border of two bays: no contact of the third
    EXPECT_EQ(answers({{0, 5.005, 12}}, bays), "II--");
    EXPECT_EQ(answers({{0, 5.02, 12}}, bays), "IIO-");
    EXPECT_EQ(answers({{0, 4.98, 12}}, bays), "IO--");
    EXPECT_EQ(answers({{0, 4.995, 12}}, bays), "II--");
    EXPECT_EQ(answers({{0, 10, 7}}, floors), "IIO-");
    EXPECT_EQ(answers({{0, 10, 6}}, floors), "II--");
    EXPECT_EQ(answers({{2, 10, 6}}, floors), "OO--");
    // Two neighbours side by side, and one in front of another, cover together.
    EXPECT_EQ(answers({{0, 4, 12}, {4, 10, 12}}, bays), "IIII");
    EXPECT_EQ(answers({{0, 6, 12}, {3, 10, 3}}, bays), "IIOO");
    EXPECT_EQ(answers({{4, 10, 12}, {0, 6, 3}}, floors), "IOOO");
    EXPECT_EQ(answers({{5, 4, 12}, {1, 2, 0}}, bays), "----"); // spans without extent
}

TEST(GrammarOcclusion, OutlinesDecideNotTheirBoxes)
{
    // A gable of 10 m with its top at 6 m over the middle, against a neighbour of 3 m at its left: its corner touches.
    using namespace cga;
    Footprint box = boxFootprint(10, 8, 6);
    box.covered[0] = {{0, 2, 6}};
    Geometry gable;
    gable.faces.emplace_back().polygon.outer = {{0, 0, 0}, {10, 0, 0}, {5, 6, 0}};
    const Scope front{{0, 0, 0}, glm::dmat3(1.0), {10, 6, 0}};
    EXPECT_TRUE(Occlusion(box).touches(front, gable, 0));
    EXPECT_TRUE(Occlusion(box).touches(front, gable, kNoIndex));
    EXPECT_FALSE(Occlusion(box).touches(front, gable, 1));
    EXPECT_FALSE(Occlusion(box).inside(front, gable, 0));
    // Two steps under the slopes' ends, and one in the middle, leave parts of it open; a wall of 6 m does not.
    box.covered[0] = {{0, 2, 2.5}, {2, 8, 6}, {8, 10, 2.5}};
    EXPECT_TRUE(Occlusion(box).inside(front, gable, 0)); // the slopes pass (2, 2.4) and (8, 2.4)
    box.covered[0] = {{0, 2, 2.3}, {2, 8, 6}, {8, 10, 2.5}};
    EXPECT_FALSE(Occlusion(box).inside(front, gable, 0));
    // The box of the triangle reaches into the span, the triangle does not.
    gable.faces[0].polygon.outer = {{0, 3, 0}, {10, 3, 0}, {5, 9, 0}};
    box.covered[0] = {{0, 10, 2.5}};
    EXPECT_FALSE(Occlusion(box).touches(front, gable, 0));
    gable.faces[0].polygon.outer = {{0, 0, 0}, {10, 0, 0}, {10, 9, 0}};
    box.covered[0] = {{0, 5, 9}};
    EXPECT_TRUE(Occlusion(box).touches(front, gable, 0));
    gable.faces[0].polygon.outer = {{4.5, 0, 0}, {10, 0, 0}, {10, 9, 0}};
    gable.faces[0].polygon.holes = {{{4.51, 0.001, 0}, {4.9, 0.5, 0}, {9, 0.5, 0}}};
    EXPECT_TRUE(Occlusion(box).touches(front, gable, 0));
}

TEST(GrammarOcclusion, SolidsLotsAndMovedShapes)
{
    Footprint box = boxFootprint(10, 8, 6);
    box.covered[1] = {{2, 4, 5}};
    const auto asks = [&](const std::string& operations, const std::string& query) {
        const Derivation d =
            mustDerive("Lot --> " + operations + " Q\nQ --> case " + query + "(inter) : Yes. else : No.", {box});
        return !leavesOf(d, "Yes").empty();
    };
    EXPECT_TRUE(asks("", "touches")); // the lot: along its edge
    EXPECT_FALSE(asks("", "inside"));
    EXPECT_TRUE(asks("extrude(6)", "touches"));
    EXPECT_FALSE(asks("extrude(6)", "inside"));
    EXPECT_FALSE(asks("extrude(6) s('0.5, '1, '1)", "touches")); // it ends before the wall
    EXPECT_FALSE(asks("extrude(6) t(0.2, 0, 0)", "touches"));
    EXPECT_FALSE(asks("extrude(6) t(0, 5.2, 0)", "touches"));
    // A hole's edges count behind the outer ones.
    Footprint court = footprintOf({{0, 0}, {10, 0}, {10, 10}, {0, 10}}, 6, {{{3, 3}, {3, 7}, {7, 7}, {7, 3}}});
    cover(court, 5, 6); // the hole's second edge, y = 7
    const Derivation d = mustDerive(
        "Lot --> extrude(6) comp(f) { side : case touches(inter) : Blank. else : NIL | all : NIL }", {court});
    ASSERT_EQ(leavesOf(d, "Blank").size(), 1u);
    expectNear(boundsOf(d, *leavesOf(d, "Blank")[0]).first, {3, 7, 0});
    EXPECT_EQ(errorOf("Lot --> case touches(intra) : A. else : B.").substr(0, 11), "t.cga:1:22:");
}

TEST(GrammarOcclusion, OpeningsOnCoveredPartsAreDropped)
{
    const std::string rules =
        "Lot --> extrude(6) comp(f) { front : split(x) { 2 : Window }* | all : NIL }\n"
        "Window --> color(\"#ff0000\") Pane Rail\nPane --> s('1, '1, 0.2) t(0, 0, -0.2) i(\"w.glb\") Glass.\n"
        "Rail --> s('1, 1, 0.5) i(\"r.glb\") Iron.";
    Footprint box = boxFootprint(10, 8, 6);
    box.covered[0] = {{0, 4.5, 3.5}}; // the middles of the first two of five bays (1 and 3 m, 3 m high)
    const Derivation d = mustDerive(rules, {box});
    EXPECT_EQ(d.counts.droppedOpenings, 4u);
    double blank = 0, covered = 0;
    u32 windows = 0;
    for (const Shape* leaf : leavesOf(d, "Glass")) {
        EXPECT_EQ(d.shapes.surfaces[leaf->surface].rho.r, 0.95);
        if (leaf->asset != kNoIndex) {
            ++windows;
            EXPECT_NEAR(areaOf(d, *leaf), 12, 1e-9); // whole, although the third bay is covered in part
            EXPECT_FALSE(leaf->covered);
            continue;
        }
        EXPECT_EQ(leaf->placement, AssetPlacement::None);
        (leaf->covered ? covered : blank) += areaOf(d, *leaf);
    }
    EXPECT_NEAR(covered, 2 * 2 * 3.5, 1e-9);
    EXPECT_NEAR(blank, 2 * 2 * 2.5, 1e-9);
    EXPECT_EQ(windows, 3u);
    EXPECT_EQ(leavesOf(d, "Iron").size(), 3u); // what stands in front goes too
    EXPECT_NEAR(totalArea(d), 60, 1e-9);
    EXPECT_TRUE(d.warnings.empty()) << d.warnings[0];
    // A neighbour below the middle of the openings leaves them.
    box.covered[0] = {{0, 10, 2.9}};
    EXPECT_EQ(mustDerive(rules, {box}).counts.droppedOpenings, 0u);
}

TEST(GrammarOcclusion, LeavesBehindANeighbourAreCovered)
{
    Footprint box = boxFootprint(10, 8, 6);
    box.covered[0] = {{0, 4, 6}, {4, 10, 3}};
    const Derivation d = mustDerive(
        "Lot --> extrude(6) comp(f) { front : split(x) { ~2 : split(y) { ~3 : A. }* }* | side : B. | all : C. }",
        {box});
    double covered = 0;
    for (const Shape& shape : d.shapes.shapes)
        if (shape.covered) {
            EXPECT_EQ(d.shapes.names[shape.name], "A");
            covered += areaOf(d, shape);
        }
    EXPECT_NEAR(covered, 4 * 6 + 6 * 3, 1e-9);
    EXPECT_EQ(d.counts.coveredLeaves, 4u + 3u);
}

} // namespace
} // namespace helio::test
