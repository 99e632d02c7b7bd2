// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "city/model/join_polygons.h"

using namespace helio;

namespace {

const glm::dvec3 kUp(0, 0, 1);

Polygon3 rect(double x0, double y0, double x1, double y1)
{
    return {{{x0, y0, 5}, {x1, y0, 5}, {x1, y1, 5}, {x0, y1, 5}}, {}};
}

double total(const std::vector<Polygon3>& polygons)
{
    double sum = 0.0;
    for (const Polygon3& polygon : polygons) sum += vectorArea(polygon).z;
    return sum;
}

} // namespace

TEST(JoinPolygons, StripsAroundAWindowAreOneRingWithAHole)
{
    // Two piers as high as the wall, a strip below the window and one above it: corners lie inside the piers' edges.
    const std::vector<Polygon3> strips{rect(0, 0, 1, 3), rect(1, 0, 2, 1), rect(1, 2, 2, 3), rect(2, 0, 3, 3)};
    const std::vector<Polygon3> joined = joinPolygons(strips, kUp);
    ASSERT_EQ(joined.size(), 1u);
    EXPECT_EQ(joined[0].outer.size(), 4u);
    ASSERT_EQ(joined[0].holes.size(), 1u);
    EXPECT_EQ(joined[0].holes[0].size(), 4u);
    EXPECT_NEAR(total(joined), 8.0, 1e-12);
    EXPECT_LT(vectorArea(joined[0].holes[0]).z, 0.0) << "holes run clockwise";

    std::vector<Polygon3> bay(strips);
    bay.push_back(rect(1, 1, 2, 2));
    const std::vector<Polygon3> whole = joinPolygons(bay, kUp);
    ASSERT_EQ(whole.size(), 1u);
    EXPECT_EQ(whole[0].outer.size(), 4u);
    EXPECT_TRUE(whole[0].holes.empty());
}

TEST(JoinPolygons, WhatTouchesInACornerStaysApart)
{
    const std::vector<Polygon3> joined = joinPolygons(std::vector{rect(0, 0, 1, 1), rect(1, 1, 2, 2)}, kUp);
    ASSERT_EQ(joined.size(), 2u);
    EXPECT_EQ(joined[0].outer.size(), 4u);
    EXPECT_EQ(joined[1].outer.size(), 4u);
}

TEST(JoinPolygons, OverlappingPolygonsComeBackAsTheyAre)
{
    const std::vector<Polygon3> joined = joinPolygons(std::vector{rect(0, 0, 2, 2), rect(1, 0, 3, 2)}, kUp);
    EXPECT_EQ(joined.size(), 2u);
    EXPECT_NEAR(total(joined), 8.0, 1e-12);
}

TEST(JoinPolygons, ACutThroughAUGivesThreeParts)
{
    // A U of 3 x 3 m with a notch of 1 x 2 m from above, and a hole in its left leg that the cut goes through.
    Polygon3 u{{{0, 0, 5}, {3, 0, 5}, {3, 3, 5}, {2, 3, 5}, {2, 1, 5}, {1, 1, 5}, {1, 3, 5}, {0, 3, 5}}, {}};
    u.holes.push_back({{0.25, 1.75, 5}, {0.25, 2.25, 5}, {0.75, 2.25, 5}, {0.75, 1.75, 5}});
    const std::vector<Polygon3> above = clipPolygon(u, {0, 1, 0}, 2.0), below = clipPolygon(u, {0, -1, 0}, -2.0);
    ASSERT_EQ(above.size(), 2u);
    ASSERT_EQ(below.size(), 1u);
    EXPECT_NEAR(total(above), 2.0 - 0.125, 1e-12);
    EXPECT_NEAR(total(below), 5.0 - 0.125, 1e-12);
    EXPECT_TRUE(above[0].holes.empty() && above[1].holes.empty() && below[0].holes.empty())
        << "the hole became a notch on both sides";
}

TEST(JoinPolygons, StripsKeepTheAreaOfAGable)
{
    const std::vector<Polygon3> gable{{{{0, 0, 0}, {8, 0, 0}, {8, 0, 4}, {4, 0, 9}, {0, 0, 4}}, {}}};
    const std::vector<std::vector<Polygon3>> strips = cutIntoStrips(gable, {0, 0, 1}, 3);
    ASSERT_EQ(strips.size(), 3u);
    double sum = 0.0;
    for (const std::vector<Polygon3>& strip : strips)
        for (const Polygon3& part : strip) sum += area(part);
    EXPECT_NEAR(sum, 8 * 4 + 0.5 * 8 * 5, 1e-12);
    EXPECT_NEAR(area(strips[0].at(0)), 24.0, 1e-12);
    // The top third is a triangle 3 m high; 5 m of rise go with 8 m of width.
    EXPECT_NEAR(area(strips[2].at(0)), 0.5 * 3 * (8.0 * 3 / 5), 1e-12);
}
