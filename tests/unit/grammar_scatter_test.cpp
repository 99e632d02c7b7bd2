// SPDX-License-Identifier: Apache-2.0
// taper, and points that scatter draws.
#include <algorithm>

#include "city/grammar/limits.h"
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

/// What the scattered shapes of a rule report: their number, and the sums of their places and of the squares.
struct Points
{
    double count = 0, x = 0, y = 0, z = 0, xx = 0;
};

/// x along the front, y up, z from the front into the lot.
Points scatterOn(const std::string& before, const std::string& arguments, const Footprint& lot, u64 seed = 0)
{
    DeriveOptions options = unitAssets();
    options.seed = seed;
    const Derivation d = mustDerive("Lot --> " + before + " scatter(" + arguments +
                                        ") { P }\nP --> report(\"n\", 1) s(0.002, 0.002, 0.002) center(xyz) "
                                        "primitiveCube() X.",
                                    {lot}, options);
    Points points;
    for (const Shape* leaf : leavesOf(d, "X")) {
        const auto [low, high] = boundsOf(d, *leaf);
        const glm::dvec3 p = 0.5 * (low + high);
        points.count += 1;
        points.x += p.x;
        points.y += p.z;
        points.z += p.y;
        points.xx += p.x * p.x;
    }
    EXPECT_EQ(points.count, d.reports.count("n") ? d.reports.at("n") : 0.0);
    return points;
}

TEST(GrammarTaper, PyramidAboveTheCentroid)
{
    // Over 10 x 8 m: slopes from the long sides sqrt(4^2 + 3^2) = 5 m high, from the short ones sqrt(5^2 + 3^2).
    auto d = mustDerive("Lot --> taper(3) report(\"sy\", scope.sy) comp(f) { bottom : B. | all : S. }",
                        {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(areaOf(d, "S"), 10 * 5 + 8 * std::sqrt(34.0), 1e-9);
    EXPECT_NEAR(areaOf(d, "B"), 80, 1e-9);
    EXPECT_NEAR(enclosedVolume(d), 80.0 * 3 / 3, 1e-9);
    EXPECT_NEAR(d.reports["sy"], 3, 1e-9);
    // A triangle: its centroid is the mean of its corners, at (4, 2).
    d = mustDerive("Lot --> taper(5) X.", {footprintOf({{0, 0}, {9, 0}, {3, 6}}, 6)});
    EXPECT_NEAR(enclosedVolume(d), 27.0 * 5 / 3, 1e-9);
    double highest = 0;
    for (const Polygon3& polygon : d.shapes.polygons)
        for (const glm::dvec3& p : polygon.outer)
            if (p.z > 1e-9) {
                expectNear(p, {4, 2, 5});
                highest = p.z;
            }
    EXPECT_NEAR(highest, 5, 1e-9);
    // The centroid, not the mean of the corners, which an extra corner moves to (4, 1.6).
    d = mustDerive("Lot --> taper(3) X.", {footprintOf({{0, 0}, {4, 0}, {8, 0}, {8, 4}, {0, 4}}, 6)});
    for (const Polygon3& polygon : d.shapes.polygons)
        for (const glm::dvec3& p : polygon.outer)
            if (p.z > 1e-9) expectNear(p, {4, 2, 3});
}

TEST(GrammarTaper, DownwardsOnEachFaceAndFlat)
{
    auto d = mustDerive("Lot --> taper(-3) X.", {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(enclosedVolume(d), 80, 1e-9); // closed and looking outward, below the ground
    EXPECT_NEAR(boundsOf(d, *leavesOf(d, "X")[0]).first.z, -3, 1e-9);
    // On the walls of a box, each out of its own plane.
    d = mustDerive("Lot --> extrude(6) comp(f) { side : taper(1) X. | all : NIL }", {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(enclosedVolume(d), (60 + 48) * 2 * 1.0 / 3, 1e-9);
    // An L sees its centroid (or the mean of its corners) nowhere near its ends: a hip of the same height.
    d = mustDerive("Lot --> taper(2) report(\"sy\", scope.sy) X.",
                   {footprintOf({{0, 0}, {20, 0}, {20, 2}, {2, 2}, {2, 20}, {0, 20}}, 6)});
    EXPECT_NEAR(d.reports["sy"], 2, 1e-3);
    EXPECT_GT(enclosedVolume(d), 0.0);
    d = mustDerive("Lot --> taper(0) X.", {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(totalArea(d), 80, 1e-9);
    ASSERT_EQ(d.warnings.size(), 1u);
    EXPECT_NE(errorOf("Lot --> extrude(3) taper(1)").find("needs a face"), std::string::npos);
    EXPECT_NE(errorOf("Lot --> taper(1, 2)").find("taper(height)"), std::string::npos);
}

TEST(GrammarScatter, UniformOnSurfaces)
{
    // A lot of 10 x 8 m with an arm: 2 x 8 of 96 m2 lie at x > 10.
    const Points p =
        scatterOn("", "surface, 4000, uniform", footprintOf({{0, 0}, {18, 0}, {18, 2}, {10, 2}, {10, 8}, {0, 8}}, 6));
    EXPECT_EQ(p.count, 4000);
    EXPECT_NEAR(p.y, 0, 1e-6);
    // Mean of x: (80 x 5 + 16 x 14) / 96 = 6.5; of y: (80 x 4 + 16 x 1) / 96 = 3.5. Four standard errors: 0.28, 0.14.
    EXPECT_NEAR(p.x / p.count, 6.5, 0.28);
    EXPECT_NEAR(p.z / p.count, 3.5, 0.14);
    // On a solid by area: the roof of 80 m2 has 80 / 376 of the points on a box of 10 x 8 x 6 m; mean height 3 m.
    const Points solid = scatterOn("extrude(6)", "surface, 4000, uniform", boxFootprint(10, 8, 6));
    EXPECT_NEAR(solid.y / solid.count, 3, 0.16);
    // y stands on the face: a post of 2 m on a wall of the front sticks out of it.
    const Derivation d =
        mustDerive("Lot --> extrude(6) comp(f) { front : scatter(surface, 5, uniform) { s(0.1, 2, 0.1) "
                   "primitiveCube() X. } | all : NIL }",
                   {boxFootprint(10, 8, 6)});
    ASSERT_EQ(leavesOf(d, "X").size(), 5u);
    for (const Shape* leaf : leavesOf(d, "X")) {
        const auto [low, high] = boundsOf(d, *leaf);
        EXPECT_NEAR(high.y, 0, 1e-9);
        EXPECT_NEAR(low.y, -2, 1e-9);
    }
}

TEST(GrammarScatter, VolumesAndScopes)
{
    // A pyramid: the mean height of its volume is a quarter of its height.
    const Points inside = scatterOn("taper(8)", "volume, 3000, uniform", boxFootprint(10, 10, 6));
    EXPECT_EQ(inside.count, 3000);
    EXPECT_NEAR(inside.y / inside.count, 2, 0.12); // four standard errors of sqrt(3 / 80) x 8 m
    // Its box: half of it.
    const Points box = scatterOn("taper(8)", "scope, 3000, uniform", boxFootprint(10, 10, 6));
    EXPECT_NEAR(box.y / box.count, 4, 0.17);
    // A face has no volume: its surface.
    EXPECT_NEAR(scatterOn("", "volume, 100, uniform", boxFootprint(10, 10, 6)).y, 0, 1e-6);
}

TEST(GrammarScatter, Gaussians)
{
    const Footprint lot = boxFootprint(20, 10, 6);
    Points p = scatterOn("", "surface, 2000, gaussian", lot); // 0.16 x 20 = 3.2 m around the middle
    EXPECT_NEAR(p.x / p.count, 10, 0.3);
    EXPECT_NEAR(std::sqrt(p.xx / p.count - std::pow(p.x / p.count, 2)), 3.2, 0.25);
    p = scatterOn("", "surface, 2000, gaussian, center, 1", lot);
    EXPECT_NEAR(std::sqrt(p.xx / p.count - std::pow(p.x / p.count, 2)), 1, 0.08);
    // Around a side only half of the bell is in the lot: its mean is sqrt(2 / pi) deviations away.
    p = scatterOn("", "surface, 2000, gaussian, left, '0.1", lot);
    EXPECT_NEAR(p.x / p.count, 2 * std::sqrt(2 / M_PI), 0.11);
    p = scatterOn("", "surface, 2000, gaussian, front, 1", lot);
    EXPECT_NEAR(p.z / p.count, std::sqrt(2 / M_PI), 0.06);
    p = scatterOn("extrude(6)", "volume, 1000, gaussian, top, 0.5", lot);
    EXPECT_NEAR(p.y / p.count, 6 - 0.5 * std::sqrt(2 / M_PI), 0.04);
}

TEST(GrammarScatter, SeedsLimitsAndMistakes)
{
    const Footprint lot = boxFootprint(20, 10, 6);
    EXPECT_EQ(scatterOn("", "surface, 5, uniform", lot).x, scatterOn("", "surface, 5, uniform", lot).x);
    EXPECT_NE(scatterOn("", "surface, 5, uniform", lot).x, scatterOn("", "surface, 5, uniform", lot, 1).x);
    EXPECT_EQ(scatterOn("", "surface, 2.4, uniform", lot).count, 2);
    EXPECT_EQ(scatterOn("", "surface, -3, uniform", lot).count, 0);
    // Twice in one rule: other points; what the rule draws itself does not hang on the number of points.
    const auto drawn = [&](const char* count) {
        return mustDerive(std::string("Lot --> scatter(scope, ") + count +
                              ", uniform) { NIL } report(\"r\", rand()) X.",
                          {lot})
            .reports["r"];
    };
    EXPECT_EQ(drawn("1"), drawn("50"));
    EXPECT_NE(errorOf("Lot --> scatter(surface, 20001, uniform) { X. }").find("at most 20000"), std::string::npos);
    EXPECT_NE(errorOf("Lot --> scatter(surface, 3, gaussian, top, -1) { X. }").find("below 0"), std::string::npos);
    // A bell so wide that each draw misses the scope costs steps.
    DeriveOptions few = unitAssets();
    few.maxSteps = 100'000;
    EXPECT_TRUE(deriveText("Lot --> scatter(scope, 2000, gaussian, top, 1) { NIL }", {lot}, few).ok());
    const auto stopped = deriveText("Lot --> scatter(scope, 2000, gaussian, top, 1e9) { NIL }", {lot}, few);
    ASSERT_FALSE(stopped.ok());
    EXPECT_NE(stopped.error().message.find("100000 steps"), std::string::npos) << stopped.error().message;
    for (const char* text : {"scatter(surfaces, 3, uniform) { X. }", "scatter(surface, 3, even) { X. }",
                             "scatter(surface, 3, uniform, top) { X. }", "scatter(surface, 3, uniform)",
                             "scatter(surface, 3) { X. }", "scatter(surface, '3, uniform) { X. }"})
        EXPECT_EQ(errorOf(std::string("Lot --> ") + text).substr(0, 8), "t.cga:1:") << text;
    EXPECT_NE(errorOf("Lot --> scatter(surface, 3, uniform) { X. | Y. }").find("never closed"), std::string::npos);
}

} // namespace
} // namespace helio::test
