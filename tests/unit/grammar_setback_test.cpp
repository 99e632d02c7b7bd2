// SPDX-License-Identifier: Apache-2.0
// setback, shapeL/U/O, offset and innerRectangle on lots whose parts are known by hand.
#include "tests/unit/grammar_solids.h"
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

// Offsets are rounded to a tenth of a millimetre.
constexpr double kGrid = 2e-3;

const Ring2 kL = {{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}}; // 64 m2

TEST(GrammarSetback, FrontStripAndRemainder)
{
    const auto d =
        mustDerive("Lot --> setback(3) { street.front : Garden. | remainder : House. }", {boxFootprint(10, 20, 6)});
    EXPECT_NEAR(areaOf(d, "Garden"), 30, kGrid);
    EXPECT_NEAR(areaOf(d, "House"), 170, kGrid);
    EXPECT_NEAR(boundsOf(d, *leavesOf(d, "House")[0]).first.y, 3, 1e-4);
    EXPECT_NEAR(totalArea(d), 200, kGrid); // nothing is lost, nothing counts twice
}

TEST(GrammarSetback, SeveralSelectorsAndCombining)
{
    // Front and left of a box meet in a corner of 2 x 2 m: front 10 x 2 and left 8 x 2 without it, or shared.
    auto d = mustDerive("Lot --> setback(2) { front : F. | left : L. | remainder : R. }", {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(areaOf(d, "F") + areaOf(d, "L"), 20 + 16 - 4, kGrid);
    EXPECT_NEAR(areaOf(d, "R"), 8 * 6, kGrid);
    d = mustDerive("Lot --> setback(2) { all = Rim. | remainder = R. }", {boxFootprint(10, 8, 6)});
    ASSERT_EQ(leavesOf(d, "Rim").size(), 1u);
    EXPECT_NEAR(areaOf(d, "Rim"), 80 - 6 * 4, kGrid);
    EXPECT_NEAR(areaOf(d, "R"), 24, kGrid);
    d = mustDerive("Lot --> setback(2) { all : Rim. | remainder : NIL }", {boxFootprint(10, 8, 6)});
    EXPECT_EQ(leavesOf(d, "Rim").size(), 4u);
    // Wider than the lot: no remainder.
    d = mustDerive("Lot --> setback(30) { front : F. | remainder : R. }", {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(areaOf(d, "F"), 80, kGrid);
    EXPECT_TRUE(leavesOf(d, "R").empty());
    d = mustDerive("Lot --> setback(0) { front : F. | remainder : R. }", {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(areaOf(d, "R"), 80, kGrid);
}

TEST(GrammarSetback, PerEdgeDistances)
{
    // A tenth of each edge's own length: 1 m along the front, 0.8 m along the right side.
    const auto d = mustDerive("Lot --> setbackPerEdge(0.1 * scope.sx) { front : F. | right : S. | remainder : R. }",
                              {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(areaOf(d, "R"), 7.0 * 9.2, kGrid);
}

TEST(GrammarSetback, PartyWallsStayKnown)
{
    // A row-house lot of 6 x 12 m; neighbours cover both long sides up to 8 m.
    Footprint footprint = boxFootprint(6, 12, 6);
    footprint.covered = {{}, {{0, 12, 8}}, {}, {{0, 12, 8}}};
    const char* rules = R"(
Lot --> setback(3) { front : NIL | remainder : House }
House --> extrude(6) comp(f) { top : NIL | bottom : NIL | all : Wall }
Wall --> case touches(inter) : report("covered", geometry.area()) Party. else : report("free", geometry.area()) Free.
)";
    auto d = mustDerive(rules, {footprint});
    EXPECT_NEAR(d.reports["covered"], 2 * 9 * 6, 1e-2);
    EXPECT_NEAR(d.reports["free"], 2 * 6 * 6, 1e-2);
    // The same through a split of the lot.
    d = mustDerive(R"(
Lot --> split(z) { ~1 : House | 3 : NIL }
House --> extrude(6) comp(f) { top : NIL | bottom : NIL | all : Wall }
Wall --> case touches(inter) : report("covered", geometry.area()) Party. else : report("free", geometry.area()) Free.
)",
                   {footprint});
    EXPECT_NEAR(d.reports["covered"], 2 * 9 * 6, 1e-2);
    EXPECT_NEAR(d.reports["free"], 2 * 6 * 6, 1e-2);
}

TEST(GrammarSetback, Wings)
{
    const std::vector<Footprint> lot = {boxFootprint(20, 30, 6)};
    // L: 20 x 8 along the front, 5 m along the left over the other 22 m.
    auto d = mustDerive("Lot --> shapeL(8, 5) { shape : S. | remainder : R. }", lot);
    ASSERT_EQ(leavesOf(d, "S").size(), 1u);
    EXPECT_NEAR(areaOf(d, "S"), 20 * 8 + 22 * 5, kGrid);
    EXPECT_NEAR(areaOf(d, "R"), 15 * 22, kGrid);
    EXPECT_NEAR(boundsOf(d, *leavesOf(d, "R")[0]).first.x, 5, 1e-4); // left is where x is small
    d = mustDerive("Lot --> shapeU(8, 4, 5) { shape : S. | remainder : R. }", lot);
    EXPECT_NEAR(areaOf(d, "R"), 11 * 22, kGrid);
    EXPECT_NEAR(areaOf(d, "S"), 600 - 11 * 22, kGrid);
    d = mustDerive("Lot --> shapeO(8, 4, 6, 5) { shape : S. | remainder : R. }", lot);
    ASSERT_EQ(leavesOf(d, "S").size(), 1u);
    EXPECT_EQ(d.shapes.polygons[leavesOf(d, "S")[0]->polygonBegin].holes.size(), 1u);
    EXPECT_NEAR(areaOf(d, "R"), 11 * 16, kGrid);
    // An O-shaped house has a court.
    d = mustDerive("Lot --> shapeO(8, 4, 6, 5) { shape : extrude(10) comp(f) { side : W. | top : T. | bottom : NIL } }",
                   lot);
    EXPECT_NEAR(areaOf(d, "W"), 10 * (2 * 50 + 2 * (11 + 16)), 2e-2);
}

TEST(GrammarSetback, Offsets)
{
    const std::vector<Footprint> lot = {boxFootprint(10, 8, 6)}, l = {footprintOf(kL, 6)};
    EXPECT_NEAR(totalArea(mustDerive("Lot --> offset(-1, inside) X.", lot)), 8 * 6, kGrid);
    EXPECT_NEAR(totalArea(mustDerive("Lot --> offset(-1, border) X.", lot)), 80 - 48, kGrid);
    EXPECT_NEAR(totalArea(mustDerive("Lot --> offset(-1) X.", lot)), 80, kGrid);
    EXPECT_NEAR(totalArea(mustDerive("Lot --> offset(1, inside) X.", lot)), 12 * 10, kGrid);
    EXPECT_NEAR(totalArea(mustDerive("Lot --> offset(1, border) X.", lot)), 120 - 80, kGrid);
    EXPECT_NEAR(totalArea(mustDerive("Lot --> offset(1) X.", lot)), 120, kGrid);
    // The L shrinks to arms of 8 x 2 and 2 x 6 m.
    EXPECT_NEAR(totalArea(mustDerive("Lot --> offset(-1, inside) X.", l)), 16 + 12, kGrid);
    // A lot with a court: the court grows.
    const std::vector<Footprint> court = {
        footprintOf({{0, 0}, {10, 0}, {10, 10}, {0, 10}}, 6, {{{3, 3}, {3, 7}, {7, 7}, {7, 3}}})};
    EXPECT_NEAR(totalArea(mustDerive("Lot --> offset(-1, inside) X.", court)), 64 - 36, kGrid);
    // What is left fits the scope; comp tells border from inside.
    auto d = mustDerive("Lot --> offset(-1, inside) report(\"sx\", scope.sx) report(\"sz\", scope.sz) X.", lot);
    EXPECT_NEAR(d.reports["sx"], 8, 1e-4);
    EXPECT_NEAR(d.reports["sz"], 6, 1e-4);
    d = mustDerive("Lot --> offset(-1) comp(f) { inside : I. | border : B. }", lot);
    EXPECT_NEAR(areaOf(d, "I"), 48, kGrid);
    EXPECT_NEAR(areaOf(d, "B"), 32, kGrid);
    // Nothing is left of a lot that is too narrow.
    d = mustDerive("Lot --> offset(-5, inside) X.", lot);
    EXPECT_TRUE(leavesOf(d, "X").empty());
    ASSERT_FALSE(d.warnings.empty());
    EXPECT_NE(d.warnings[0].find("too small"), std::string::npos);
}

TEST(GrammarSetback, InnerRectangles)
{
    // The largest rectangle in the L is one of its arms, 10 x 4 m.
    auto d = mustDerive("Lot --> innerRectangle(scope) { shape : S. | remainder : R. }", {footprintOf(kL, 6)});
    EXPECT_NEAR(areaOf(d, "S"), 40, 0.5);
    EXPECT_NEAR(areaOf(d, "S") + areaOf(d, "R"), 64, kGrid);
    d = mustDerive("Lot --> innerRect S.", {footprintOf(kL, 6)});
    EXPECT_NEAR(areaOf(d, "S"), 40, 0.5);
    // A square on its corner, first edge at 45 degrees to the others' axes: along an edge all of it fits.
    const double h = std::sqrt(50.0);
    const std::vector<Footprint> diamond = {footprintOf({{0, 0}, {h, 0}, {h, h}, {0, h}}, 6)};
    d = mustDerive("Lot --> innerRectangle(edge) { shape : S. | remainder : R. }", diamond);
    EXPECT_NEAR(areaOf(d, "S"), 50, 0.1);
    EXPECT_NE(errorOf("Lot --> innerRectangle(scope) { front : S. }").find("shape and remainder"), std::string::npos);
}

TEST(GrammarSetback, SolidsAreRefused)
{
    for (const char* op : {"setback(1) { all : X. }", "offset(-1)", "shapeL(1, 1) { shape : X. }", "roofHip(30)"})
        EXPECT_NE(errorOf(std::string("Lot --> extrude(3) ") + op).find("needs a face"), std::string::npos) << op;
}

} // namespace
} // namespace helio::test
