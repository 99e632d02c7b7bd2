// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "city/geometry/straight_skeleton.h"
#include "tests/unit/geometry_roof_support.h"

namespace helio {

namespace {

constexpr RoofPitch k45{false, 45.0};

Polygon2 rectangle(double width, double depth)
{
    return {{{0, 0}, {width, 0}, {width, depth}, {0, depth}}, {}};
}
const Polygon2 kL{{{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}}, {}};
const Polygon2 kCourtyard{{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{3, 3}, {3, 7}, {7, 7}, {7, 3}}}};

void expectSound(const Roof& roof)
{
    EXPECT_EQ(solidProblem(roof), "");
    EXPECT_EQ(roof.fallback, RoofFallback::None) << roof.reason;
    EXPECT_EQ(roof.reason, "");
}

/// Every slope has the angle, by its normal.
void expectPitch(const Roof& roof, double degrees)
{
    for (const RoofFace& face : roof.faces) {
        if (face.part != RoofPart::Slope) continue;
        EXPECT_NEAR(unitNormal(face.polygon).z, std::cos(degrees * std::numbers::pi / 180.0), 1e-6);
    }
}

/// Base edges under the gables.
std::vector<u32> gableEdges(const Roof& roof)
{
    std::vector<u32> edges;
    for (const RoofFace& face : roof.faces)
        if (face.part == RoofPart::Gable) edges.push_back(face.edge);
    std::sort(edges.begin(), edges.end());
    return edges;
}

Roof gable(const Polygon2& base, u32 index = kNoIndex)
{
    return gableRoof(base, k45, 0.0, 0.0, false, index);
}

} // namespace

TEST(HipRoof, SquareIsPyramid)
{
    const Roof roof = hipRoof(rectangle(6, 6), {false, 30.0}, 0.0);
    expectSound(roof);
    expectPitch(roof, 30.0);
    EXPECT_EQ(roof.faces.size(), 5u);
    const double height = 3.0 * std::tan(std::numbers::pi / 6.0);
    EXPECT_NEAR(highest(roof), height, 1e-9);
    EXPECT_NEAR(volume(roof), 36.0 * height / 3.0, 1e-9);
}

TEST(HipRoof, RectangleIsPrismAndTwoHalfPyramids)
{
    const Roof roof = hipRoof(rectangle(10, 4), k45, 0.0);
    expectSound(roof);
    expectPitch(roof, 45.0);
    // Ridge 6 m at 2 m: prism 6 * 4 * 2 / 2, pyramid 4 * 4 * 2 / 3.
    EXPECT_NEAR(volume(roof), 24.0 + 32.0 / 3.0, 1e-9);
    for (u32 e = 0; e < 4; ++e) EXPECT_EQ(roof.faces[e].edge, e);
    EXPECT_EQ(roof.faces[4].edge, kNoIndex);
    EXPECT_EQ(roof.faces[4].part, RoofPart::Bottom);
}

TEST(HipRoof, HeightOfTheHighestPoint)
{
    const Roof roof = hipRoof(kL, {true, 3.0}, 0.5);
    expectSound(roof);
    EXPECT_NEAR(highest(roof), 3.0, 1e-9);
    // The front moves 0.5 m to the walls and 2 m more to the ridge: the slope is 3 / 2.
    EXPECT_NEAR(lowest(roof), -0.5 * 1.5, 1e-9);
}

TEST(HipRoof, OverhangKeepsThePlanes)
{
    const Roof roof = hipRoof(rectangle(10, 4), k45, 0.35);
    expectSound(roof);
    EXPECT_NEAR(highest(roof), 2.0, 1e-9);
    EXPECT_NEAR(lowest(roof), -0.35, 1e-9);
    EXPECT_NEAR(volume(roof), 6.0 * 4.7 * 2.35 / 2.0 + 4.7 * 4.7 * 2.35 / 3.0, 1e-9);
}

TEST(HipRoof, OverhangThatClosesACourtyard)
{
    Polygon2 base = rectangle(10, 10);
    base.holes = {{{4.8, 4.8}, {4.8, 5.2}, {5.2, 5.2}, {5.2, 4.8}}};
    const Roof roof = hipRoof(base, k45, 0.35);
    expectSound(roof);
    EXPECT_EQ(roof.faces.size(), 5u); // the hip over the whole square
    EXPECT_NEAR(highest(roof), 5.0, 1e-9);
}

TEST(HipRoof, OverhangOfASharpCorner)
{
    const Roof roof = hipRoof({{{0, 0}, {20, 0}, {20, 2}}, {}}, k45, 0.5);
    expectSound(roof);
    double farthest = 0.0;
    for (const RoofFace& face : roof.faces)
        for (const glm::dvec3& p : face.polygon.outer) farthest = std::min(farthest, p.x);
    EXPECT_GT(farthest, -2.0) << "the miter of 5.7 degrees would reach 10 m out";
}

TEST(HipRoof, CourtyardHasAnInnerSlope)
{
    const Roof roof = hipRoof(kCourtyard, k45, 0.0);
    expectSound(roof);
    expectPitch(roof, 45.0);
    EXPECT_EQ(roof.faces.size(), 9u);
    EXPECT_NEAR(highest(roof), 1.5, 1e-9);
    // The section is a triangle 3 wide and 1.5 high; its centroid runs along the square of side 7.
    EXPECT_NEAR(volume(roof), 3.0 * 1.5 / 2.0 * 28.0, 1e-9);
    EXPECT_EQ(roof.faces[8].polygon.holes.size(), 1u);
}

TEST(GableRoof, RectangleOverItsShortEnds)
{
    const Roof roof = gable(rectangle(10, 4));
    expectSound(roof);
    expectPitch(roof, 45.0);
    EXPECT_EQ(gableEdges(roof), (std::vector<u32>{1, 3}));
    EXPECT_NEAR(volume(roof), 40.0 * 2.0 / 2.0, 1e-9);
    for (const RoofFace& face : roof.faces) {
        if (face.part != RoofPart::Gable) continue;
        EXPECT_NEAR(area(face.polygon), 4.0, 1e-9);
    }
}

TEST(GableRoof, IndexTurnsTheRidge)
{
    for (const u32 index : {0u, 2u, 4u})
        EXPECT_EQ(gableEdges(gable(rectangle(10, 4), index)), (std::vector<u32>{1, 3}));
    for (const u32 index : {1u, 3u}) {
        const Roof roof = gable(rectangle(10, 4), index);
        expectSound(roof);
        EXPECT_EQ(gableEdges(roof), (std::vector<u32>{0, 2}));
        EXPECT_NEAR(highest(roof), 5.0, 1e-9);
        EXPECT_NEAR(volume(roof), 40.0 * 5.0 / 2.0, 1e-9);
    }
    EXPECT_EQ(gableEdges(gable(kL, 0)), gableEdges(gable(kL))) << "only on four-sided bases";
}

TEST(GableRoof, OverhangsAreBeyondEavesAndGables)
{
    const Roof roof = gableRoof(rectangle(10, 4), k45, 0.5, 1.0, false, kNoIndex);
    expectSound(roof);
    EXPECT_NEAR(highest(roof), 2.0, 1e-9);
    EXPECT_NEAR(lowest(roof), -0.5, 1e-9);
    EXPECT_NEAR(volume(roof), 12.0 * 5.0 * 2.5 / 2.0, 1e-9);
    for (const RoofFace& face : roof.faces) {
        if (face.part != RoofPart::Gable) continue;
        EXPECT_NEAR(std::abs(face.polygon.outer[0].x - 5.0), 6.0, 1e-9) << "1 m beyond the ends";
    }
}

TEST(GableRoof, EveryEndOfAnLTAndCross)
{
    const Roof l = gable(kL);
    expectSound(l);
    EXPECT_EQ(gableEdges(l), (std::vector<u32>{1, 4}));
    // A trapezoid a below, b above, h deep in plan holds h * h * (a + 2 b) / 6 under 45 degrees; each gable adds 8 / 3
    // to the hip end it replaces: half a prism 4 * 2 * 2 / 2 less half a pyramid.
    const double hip = 2.0 * (4.0 * (10 + 12) / 6.0 + 4.0 * 4 / 6.0 + 4.0 * (6 + 12) / 6.0);
    EXPECT_NEAR(volume(hipRoof(kL, k45, 0.0)), hip, 1e-9);
    EXPECT_NEAR(volume(l), hip + 2.0 * 8.0 / 3.0, 1e-9);

    const Polygon2 t{{{4, 0}, {8, 0}, {8, 6}, {12, 6}, {12, 10}, {0, 10}, {0, 6}, {4, 6}}, {}};
    const Roof tee = gable(t);
    expectSound(tee);
    expectPitch(tee, 45.0);
    EXPECT_EQ(gableEdges(tee), (std::vector<u32>{0, 3, 5}));
    // Bar 12 * 4 * 2 / 2, stem prism 6 * 4 * 2 / 2 up to the bar, and its wedge over the bar's slope 2 * 2 * 2 * 2 / 6.
    EXPECT_NEAR(volume(tee), 48.0 + 24.0 + 8.0 / 3.0, 1e-9);

    const Polygon2 cross{
        {{4, 1}, {1, 1}, {1, 4}, {-1, 4}, {-1, 1}, {-4, 1}, {-4, -1}, {-1, -1}, {-1, -4}, {1, -4}, {1, -1}, {4, -1}},
        {}};
    const Roof four = gable(cross);
    expectSound(four);
    EXPECT_EQ(gableEdges(four), (std::vector<u32>{2, 5, 8, 11}));
    // Arms 4 * (3 * 2 * 1 / 2); over the middle square the higher of two prisms: 2 * 2 * 1 - a pyramid upside down.
    EXPECT_NEAR(volume(four), 12.0 + 4.0 - 4.0 / 3.0, 1e-9);
}

TEST(GableRoof, EndOfTwoEdgesGetsOneGable)
{
    // The left end has a corner in its middle: two upright faces under one ridge end, of the same height.
    const Roof roof = gable({{{0, 0}, {10, 0}, {10, 4}, {0, 4}, {0, 1}}, {}});
    expectSound(roof);
    EXPECT_EQ(gableEdges(roof), (std::vector<u32>{1, 3, 4}));
    EXPECT_NEAR(volume(roof), 40.0, 1e-9);
}

TEST(GableRoof, NoEndsMeansHip)
{
    const Roof ring = gable(kCourtyard);
    expectSound(ring);
    EXPECT_EQ(countPart(ring, RoofPart::Gable), 0u);
    EXPECT_NEAR(volume(ring), volume(hipRoof(kCourtyard, k45, 0.0)), 1e-9);
    Polygon2 octagon;
    for (u32 i = 0; i < 8; ++i) {
        const double angle = std::numbers::pi * i / 4.0;
        octagon.outer.push_back({10.0 * std::cos(angle), 10.0 * std::sin(angle)});
    }
    EXPECT_EQ(countPart(gable(octagon), RoofPart::Gable), 0u);
}

TEST(GableRoof, TriangleHasOneOnItsShortestSide)
{
    const Roof roof = gable({{{0, 0}, {12, 0}, {12, 5}}, {}});
    expectSound(roof);
    expectPitch(roof, 45.0);
    EXPECT_EQ(gableEdges(roof), (std::vector<u32>{1}));
    // The ridge ends over x = 12 where the distances to the sides of directions (12, 0) and (12, 5) are equal:
    // h = (60 - 12 h) / 13.
    EXPECT_NEAR(highest(roof), 60.0 / 25.0, 1e-9);
    EXPECT_NEAR(volume(roof), 30.0 * 2.4 / 3.0, 1e-9);
}

TEST(GableRoof, EvenLevelsTheRidgeOfATrapezoid)
{
    // Ends 4 and 6 wide: ridge ends at different heights, level at their mean.
    const Polygon2 base{{{0, 1}, {20, 0}, {20, 6}, {0, 5}}, {}};
    const Roof sloped = gable(base);
    const Roof level = gableRoof(base, k45, 0.0, 0.0, true, kNoIndex);
    expectSound(sloped);
    expectSound(level);
    const auto ridgeEnds = [](const Roof& roof) {
        std::vector<double> ends;
        for (const RoofFace& face : roof.faces) {
            if (face.part != RoofPart::Gable) continue;
            double z = 0.0;
            for (const glm::dvec3& p : face.polygon.outer) z = std::max(z, p.z);
            ends.push_back(z);
        }
        std::sort(ends.begin(), ends.end());
        return ends;
    };
    // The sides run at a slope of 1 : 20: the distance of the middle line is half the width times cos(atan(1 / 20)).
    const double cosine = 20.0 / std::sqrt(401.0);
    ASSERT_EQ(ridgeEnds(sloped).size(), 2u);
    EXPECT_NEAR(ridgeEnds(sloped)[0], 2.0 * cosine, 1e-9);
    EXPECT_NEAR(ridgeEnds(sloped)[1], 3.0 * cosine, 1e-9);
    ASSERT_EQ(ridgeEnds(level).size(), 2u);
    EXPECT_NEAR(ridgeEnds(level)[0], 2.5 * cosine, 1e-9);
    EXPECT_NEAR(ridgeEnds(level)[1], 2.5 * cosine, 1e-9);
    EXPECT_EQ(countPart(level, RoofPart::Slope), 4u);
    const Roof byHeight = gableRoof(base, {true, 2.0}, 0.0, 0.0, true, kNoIndex);
    EXPECT_NEAR(highest(byHeight), 2.0, 1e-9);
}

TEST(ShedRoof, OnePlaneFromAnEdge)
{
    const Roof roof = shedRoof(rectangle(10, 4), k45, 0);
    expectSound(roof);
    expectPitch(roof, 45.0);
    EXPECT_EQ(countPart(roof, RoofPart::Slope), 1u);
    EXPECT_EQ(countPart(roof, RoofPart::Gable), 3u);
    EXPECT_NEAR(volume(roof), 10.0 * 4.0 * 4.0 / 2.0, 1e-9);
    EXPECT_NEAR(volume(shedRoof(rectangle(10, 4), k45, 1)), 10.0 * 4.0 * 10.0 / 2.0, 1e-9);
    EXPECT_NEAR(volume(shedRoof(rectangle(10, 4), k45, 5)), 10.0 * 4.0 * 10.0 / 2.0, 1e-9);
    EXPECT_NEAR(highest(shedRoof(rectangle(10, 4), {true, 1.5}, 0)), 1.5, 1e-9);
}

TEST(ShedRoof, HolesAndPartsBehindTheEdge)
{
    const Roof ring = shedRoof(kCourtyard, k45, 0);
    expectSound(ring);
    EXPECT_EQ(countPart(ring, RoofPart::Gable), 3u + 4u);
    EXPECT_NEAR(volume(ring), 1000.0 / 2.0 - 16.0 * 5.0, 1e-9);
    // The edge (10, 4) - (4, 4) of the L rises to the south; the arm behind it, to y = 10, is the lowest.
    const Roof l = shedRoof(kL, k45, 2);
    expectSound(l);
    EXPECT_NEAR(lowest(l), 0.0, 1e-9);
    EXPECT_NEAR(highest(l), 10.0, 1e-9);
    EXPECT_NEAR(volume(l), 40.0 * 8.0 + 24.0 * 3.0, 1e-9);
}

TEST(PyramidRoof, ApexAboveTheMeanOfTheCorners)
{
    const Roof roof = pyramidRoof(rectangle(10, 4), k45);
    expectSound(roof);
    EXPECT_NEAR(highest(roof), 2.0, 1e-9) << "the face of the first edge has the angle";
    EXPECT_NEAR(volume(roof), 40.0 * 2.0 / 3.0, 1e-9);
    const Roof l = pyramidRoof(kL, {true, 3.0});
    expectSound(l);
    EXPECT_EQ(l.faces.size(), 7u);
    EXPECT_NEAR(volume(l), 64.0 * 3.0 / 3.0, 1e-9) << "the mean (4.67, 4.67) does not see all, the centroid does";
}

TEST(PyramidRoof, HipWhereTheCentreDoesNotSeeAll)
{
    const Polygon2 u{{{0, 0}, {6, 0}, {6, 6}, {4, 6}, {4, 2}, {2, 2}, {2, 6}, {0, 6}}, {}};
    for (const Polygon2& base : {u, kCourtyard}) {
        const Roof roof = pyramidRoof(base, k45);
        expectSound(roof);
        EXPECT_NEAR(volume(roof), volume(hipRoof(base, k45, 0.0)), 1e-9);
    }
}

TEST(Roofs, TouchingRingsBecomeTheirUnion)
{
    // Two squares that meet in a corner: two pyramids a * a * (a / 2) / 3.
    const Polygon2 bow{{{0, 0}, {4, 0}, {4, 4}, {8, 4}, {8, 8}, {4, 8}, {4, 4}, {0, 4}}, {}};
    const Roof two = hipRoof(bow, k45, 0.0);
    EXPECT_EQ(two.fallback, RoofFallback::None) << two.reason;
    EXPECT_EQ(countPart(two, RoofPart::Bottom), 2u);
    EXPECT_NEAR(volume(two), 2.0 * std::pow(3.999, 3) / 6.0, 1e-6) << "each 0.5 mm smaller all round";
    // A hole that touches the outer ring with a corner.
    Polygon2 touching = rectangle(10, 10);
    touching.holes = {{{5, 0}, {3, 4}, {7, 4}}};
    const Roof roof = hipRoof(touching, k45, 0.0);
    EXPECT_EQ(solidProblem(roof), "");
    EXPECT_LE(roof.fallback, RoofFallback::Parts) << roof.reason;
    // Clockwise input, corners there twice.
    const Roof turned = hipRoof({{{0, 0}, {0, 6}, {6, 6}, {6, 6}, {6, 0}}, {}}, k45, 0.0);
    expectSound(turned);
    EXPECT_NEAR(volume(turned), 36.0, 1e-9);
}

TEST(Roofs, NoAreaNoRoof)
{
    for (const Polygon2& base : {Polygon2{}, Polygon2{{{0, 0}, {4, 0}}, {}}, Polygon2{{{0, 0}, {4, 0}, {8, 0}}, {}},
                                 Polygon2{{{0, 0}, {1, NAN}, {1, 1}}, {}}, Polygon2{{{0, 0}, {1e7, 0}, {1, 1}}, {}}}) {
        EXPECT_TRUE(hipRoof(base, k45, 0.3).faces.empty());
        EXPECT_TRUE(gableRoof(base, k45, 0.3, 0.3, true, 0).faces.empty());
        EXPECT_TRUE(shedRoof(base, k45, 0).faces.empty());
        EXPECT_TRUE(pyramidRoof(base, k45).faces.empty());
    }
}

TEST(Roofs, FlatWithItsReason)
{
    const auto expectFlat = [](const Roof& roof, const std::string& reason) {
        EXPECT_EQ(solidProblem(roof), "");
        EXPECT_EQ(roof.fallback, RoofFallback::Flat);
        EXPECT_EQ(roof.reason, reason);
        EXPECT_NEAR(highest(roof), 0.1, 1e-9);
    };
    for (const RoofPitch& pitch : {RoofPitch{false, 90.0}, RoofPitch{false, -5.0}, RoofPitch{true, NAN}}) {
        expectFlat(hipRoof(kCourtyard, pitch, 0.0), "the pitch is out of range");
        expectFlat(gableRoof(kL, pitch, 0.0, 0.0, false, 0), "the pitch is out of range");
        expectFlat(shedRoof(kCourtyard, pitch, 0), "the pitch is out of range");
        expectFlat(pyramidRoof(kL, pitch), "the pitch is out of range");
    }
    Polygon2 many;
    for (u32 i = 0; i < kSkeletonMaxCorners + 1; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / (kSkeletonMaxCorners + 1);
        many.outer.push_back({100.0 * std::cos(angle), 100.0 * std::sin(angle)});
    }
    expectFlat(hipRoof(many, k45, 0.0), "1201 corners, more than 1200");
}

} // namespace helio
