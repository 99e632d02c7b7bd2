// SPDX-License-Identifier: Apache-2.0
// Roof operations on footprints whose roofs are known by hand, and cuts through many roofs.
#include "city/base/hash.h"
#include "city/geometry/roof.h"
#include "city/grammar/clip.h"
#include "tests/unit/grammar_solids.h"
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

const Ring2 kL = {{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}}; // 64 m2

/// Sum of the level parts of faces that look up, m2.
double upward(const Derivation& d)
{
    double sum = 0.0;
    for (const Polygon3& polygon : d.shapes.polygons) sum += std::max(0.0, vectorArea(polygon).z);
    return sum;
}

double heightOf(const Derivation& d)
{
    double high = -INFINITY;
    for (const Polygon3& polygon : d.shapes.polygons)
        for (const glm::dvec3& p : polygon.outer) high = std::max(high, p.z);
    return high;
}

TEST(GrammarRoof, HipOverABox)
{
    // 10 x 6 m at 45 degrees: the ridge lies 3 m up and is 4 m long. Volume: a prism of 6 * 3 / 2 * 4 and two half
    // pyramids that make one of 6 x 6 x 3: 36 + 36.
    const auto d = mustDerive("Lot --> roofHip(45) Roof.", {boxFootprint(10, 6, 6)});
    EXPECT_NEAR(heightOf(d), 3, 1e-3);
    EXPECT_NEAR(enclosedVolume(d), 72, 1e-2);
    EXPECT_NEAR(upward(d), 60, 1e-2);
    EXPECT_NEAR(totalArea(d), 60 + 60 * std::sqrt(2.0), 1e-2);
    EXPECT_EQ(d.counts.roofs.roofs, 1u);
    EXPECT_EQ(d.counts.roofs.parts + d.counts.roofs.flat, 0u);
    EXPECT_NEAR(heightOf(mustDerive("Lot --> roofHip(byHeight, 2) Roof.", {boxFootprint(10, 6, 6)})), 2, 1e-3);
}

TEST(GrammarRoof, ScopeHasYInTheDirectionOfTheRoof)
{
    auto d = mustDerive(R"(
Lot --> extrude(5) comp(f) { top : Top | all : NIL }
Top --> roofHip(45) report("sx", scope.sx) report("sy", scope.sy) report("sz", scope.sz) Roof.
)",
                        {boxFootprint(10, 6, 5)});
    EXPECT_NEAR(d.reports["sx"], 10, 1e-3);
    EXPECT_NEAR(d.reports["sy"], 3, 1e-3);
    EXPECT_NEAR(d.reports["sz"], 6, 1e-3);
    EXPECT_NEAR(heightOf(d), 8, 1e-3);
    // On a wall the roof grows out of the wall.
    d = mustDerive(R"(
Lot --> extrude(6) comp(f) { front : roofPyramid(byHeight, 2) report("sy", scope.sy) Bay. | all : NIL }
)",
                   {boxFootprint(6, 8, 6)});
    EXPECT_NEAR(d.reports["sy"], 2, 1e-3);
    double south = 0.0;
    for (const Polygon3& polygon : d.shapes.polygons)
        for (const glm::dvec3& p : polygon.outer) south = std::min(south, p.y);
    EXPECT_NEAR(south, -2, 1e-3);
}

TEST(GrammarRoof, GableShedAndPyramid)
{
    // 10 x 6 m: the ridge runs along the 10 m, 3 m up at 45 degrees; gables of 6 * 3 / 2 = 9 m2 at the short ends.
    auto d = mustDerive("Lot --> roofGable(45) comp(f) { bottom : NIL | vertical : G. | all : S. }",
                        {boxFootprint(10, 6, 6)});
    EXPECT_NEAR(areaOf(d, "G"), 18, 1e-2);
    EXPECT_NEAR(areaOf(d, "S"), 60 * std::sqrt(2.0), 1e-2);
    // Overhangs are measured down the slope: 0.5 at the eaves, 0.25 at the gables.
    d = mustDerive("Lot --> roofGable(45, 0.5, 0.25) comp(f) { bottom : NIL | vertical : G. | all : S. }",
                   {boxFootprint(10, 6, 6)});
    EXPECT_NEAR(areaOf(d, "S"), 2 * (3 * std::sqrt(2.0) + 0.5) * 10.5, 1e-2);
    // Shed: rises from the front, 6 m * tan(30).
    d = mustDerive("Lot --> roofShed(30) Roof.", {boxFootprint(10, 6, 6)});
    EXPECT_NEAR(heightOf(d), 6 * std::tan(M_PI / 6), 1e-3);
    EXPECT_NEAR(enclosedVolume(d), 10 * 6 * 6 * std::tan(M_PI / 6) / 2, 1e-2);
    // Rising from the right side instead: 10 m * tan(30).
    d = mustDerive("Lot --> roofShed(30, 1) Roof.", {boxFootprint(10, 6, 6)});
    EXPECT_NEAR(heightOf(d), 10 * std::tan(M_PI / 6), 1e-3);
    d = mustDerive("Lot --> roofPyramid(byHeight, 5) Roof.", {boxFootprint(6, 6, 6)});
    EXPECT_NEAR(enclosedVolume(d), 36 * 5 / 3.0, 1e-2);
}

TEST(GrammarRoof, RidgeTiles)
{
    const char* rules = R"(
Lot --> roofGable(45) Roof
Roof --> Ridge comp(f) { bottom : NIL | all : Slope. }
Ridge --> comp(e) { ridge : report("ridge", scope.sx) RidgeTile | eave : report("eave", scope.sx) NIL | all : NIL }
RidgeTile --> s('1, 0.12, 0.25) t(0, -0.04, -0.125) primitiveCube() Tile.
)";
    auto d = mustDerive(rules, {boxFootprint(10, 6, 6)});
    EXPECT_NEAR(d.reports["ridge"], 10, 1e-3);
    EXPECT_NEAR(d.reports["eave"], 20, 1e-3);
    ASSERT_EQ(leavesOf(d, "Tile").size(), 1u);
    const auto [low, high] = boundsOf(d, *leavesOf(d, "Tile")[0]);
    expectNear(high, {10, 3.125, 3.08}, 1e-3); // lies on the ridge, a third of it sunk
    expectNear(low, {0, 2.875, 2.96}, 1e-3);
    // A hip roof over an L: hips, one valley, two ridges.
    d = mustDerive("Lot --> roofHip(45) comp(e) { ridge : report(\"r\", 1) NIL | hip : report(\"h\", 1) NIL | valley : "
                   "report(\"v\", 1) NIL | eave : report(\"e\", 1) NIL | all : report(\"x\", 1) NIL }",
                   {footprintOf(kL, 6)});
    EXPECT_EQ(d.reports["e"], 6.0);
    EXPECT_EQ(d.reports["v"], 1.0);
    EXPECT_EQ(d.reports["r"], 2.0);
    EXPECT_EQ(d.reports["h"], 5.0); // one at each convex corner, and none left over
    EXPECT_EQ(d.reports["x"], 0.0);
}

TEST(GrammarRoof, MansardCutsAtAtticHeight)
{
    // 72 degrees up to 3 m: the level top is smaller by 3 / tan(72) on every side. With a court of 8 x 8 m the top has
    // a hole that is larger by the same.
    const double in = 3 / std::tan(72 * M_PI / 180);
    const char* rules = R"(
Lot --> extrude(12) comp(f) { top : Base | all : NIL }
Base --> roofHip(byAngle, 72) split(y) { 3 : Attic | ~1 : NIL }
Attic --> comp(f) { bottom : NIL | top : Top. | all : Slope. }
)";
    auto d = mustDerive(rules, {boxFootprint(18, 14, 12)});
    ASSERT_EQ(leavesOf(d, "Top").size(), 1u);
    EXPECT_NEAR(areaOf(d, "Top"), (18 - 2 * in) * (14 - 2 * in), 1e-2);
    EXPECT_EQ(leavesOf(d, "Slope").size(), 4u);
    d = mustDerive(rules,
                   {footprintOf({{0, 0}, {24, 0}, {24, 24}, {0, 24}}, 12, {{{8, 8}, {8, 16}, {16, 16}, {16, 8}}})});
    ASSERT_EQ(leavesOf(d, "Top").size(), 1u);
    EXPECT_EQ(d.shapes.polygons[leavesOf(d, "Top")[0]->polygonBegin].holes.size(), 1u);
    EXPECT_NEAR(areaOf(d, "Top"), std::pow(24 - 2 * in, 2) - std::pow(8 + 2 * in, 2), 2e-2);
    EXPECT_EQ(leavesOf(d, "Slope").size(), 8u);
}

// The roof stands on a top face whose area is smaller than that of its slopes: nothing is counted twice.
TEST(GrammarRoof, SlopesAreNotCountedAgainstTheFaceBelow)
{
    const auto d = mustDerive("attr pitch = 40\nLot --> extrude(5) comp(f) { top : Top | all : W. }\n"
                              "Top --> roofHip(pitch) comp(f) { bottom : NIL | all : Slope. }",
                              {boxFootprint(10, 6, 5)});
    EXPECT_TRUE(d.warnings.empty()) << d.warnings[0];
    EXPECT_NEAR(areaOf(d, "Slope"), 60 / std::cos(40 * M_PI / 180), 1e-2);
}

TEST(GrammarRoof, BadAngles)
{
    const auto d = mustDerive("Lot --> roofHip(0) Roof.", {boxFootprint(10, 6, 6)});
    ASSERT_FALSE(d.warnings.empty());
    EXPECT_NE(d.warnings[0].find("between 0 and 90"), std::string::npos);
    EXPECT_NEAR(totalArea(d), 60, 1e-9);
    EXPECT_NE(errorOf("Lot --> roofHip(byAngle)").find("roofHip"), std::string::npos);
    EXPECT_NE(errorOf("Lot --> roofHip(byMagic, 3)").find("byMagic"), std::string::npos);
    EXPECT_NE(errorOf("Lot --> roofRidge(30)").find("roofGable"), std::string::npos);
}

/// The faces of a roof as a solid, y up.
cga::Geometry solidOf(const Roof& roof)
{
    cga::Geometry solid;
    solid.closed = true;
    const auto turn = [](const Ring3& ring) {
        Ring3 result;
        for (const glm::dvec3& p : ring) result.emplace_back(p.x, p.z, -p.y);
        return result;
    };
    for (const RoofFace& face : roof.faces) {
        cga::Face& turned = solid.faces.emplace_back();
        turned.polygon.outer = turn(face.polygon.outer);
        for (const Ring3& hole : face.polygon.holes) turned.polygon.holes.push_back(turn(hole));
    }
    return solid;
}

// Roofs over random stars, cut at many heights and across: both parts are closed edge by edge and add up.
TEST(GrammarRoof, CutsThroughManyRoofsAreClosed)
{
    Random random(11);
    size_t cuts = 0;
    for (int round = 0; round < 60; ++round) {
        Polygon2 base;
        const int n = 3 + int(random.uniform() * 12);
        for (int k = 0; k < n; ++k) {
            const double angle = 2 * M_PI * (k + 0.3 * random.uniform()) / n, r = 5 + 6 * random.uniform();
            base.outer.emplace_back(r * std::cos(angle), r * std::sin(angle));
        }
        if (round % 3 == 0) base.holes = {{{-1, -1}, {-1, 1}, {1, 1}, {1, -1}}};
        const RoofPitch pitch{false, 20 + 50 * random.uniform()};
        for (const Roof& roof : {hipRoof(base, pitch, 0.0), gableRoof(base, pitch, 0.0, 0.0, false, kNoIndex)}) {
            const cga::Geometry solid = solidOf(roof);
            ASSERT_EQ(cga::openEdges(solid), 0u) << "round " << round;
            const auto [low, high] = cga::bounds(solid);
            for (const int axis : {0, 1, 2})
                for (const double share : {0.1, 0.37, 0.5, 0.9}) {
                    const double at = low[axis] + share * (high[axis] - low[axis]);
                    const cga::Geometry below = cga::clipSlab(solid, axis, low[axis], at),
                                        above = cga::clipSlab(solid, axis, at, high[axis]);
                    EXPECT_EQ(cga::openEdges(below), 0u) << "round " << round << " axis " << axis << " at " << at;
                    EXPECT_EQ(cga::openEdges(above), 0u) << "round " << round << " axis " << axis << " at " << at;
                    EXPECT_NEAR(cga::volume(below) + cga::volume(above), cga::volume(solid), 1e-6 * cga::volume(solid));
                    ++cuts;
                }
        }
    }
    EXPECT_EQ(cuts, 60u * 2 * 12);
}

} // namespace
} // namespace helio::test
