// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "city/layout/courts.h"
#include "city/layout/shared_walls.h"

using namespace helio;

namespace {

Footprint box(double x, double y, double width, double depth, double height)
{
    Footprint footprint;
    footprint.outline.outer = {{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}};
    footprint.height = height;
    return footprint;
}

using Heights = std::vector<double>;

TEST(SharedWalls, CoverUpToTheNeighboursHeight)
{
    // b stands along the whole right side of a, at a gap of 0.2 m; c is 0.4 m above a.
    Layout layout;
    layout.footprints = {box(0, 0, 10, 10, 20), box(10.2, 0, 10, 10, 15), box(0, 10.4, 10, 10, 30)};
    findSharedWalls(layout);
    EXPECT_EQ(layout.footprints[0].coveredHeight, (Heights{0, 15, 0, 0}));
    EXPECT_EQ(layout.footprints[1].coveredHeight, (Heights{0, 0, 0, 20}));
    EXPECT_EQ(layout.footprints[2].coveredHeight, (Heights{0, 0, 0, 0}));
}

TEST(SharedWalls, NeedHalfOfTheLength)
{
    Layout layout; // the neighbour on the right is 4.9 m deep, the one on the left 5.1 m
    layout.footprints = {box(0, 0, 10, 10, 20), box(10, 0, 10, 4.9, 15), box(-10, 0, 10, 5.1, 12)};
    findSharedWalls(layout);
    EXPECT_EQ(layout.footprints[0].coveredHeight, (Heights{0, 0, 0, 12}));
    EXPECT_EQ(layout.footprints[1].coveredHeight[3], 20.0);
    EXPECT_EQ(layout.footprints[2].coveredHeight[1], 20.0);
}

TEST(SharedWalls, AddUpOverSeveralNeighbours)
{
    Layout layout; // 1 m at height 30, 4 m at 18, 5 m at 9: half of 10 m is covered up to 18
    layout.footprints = {box(0, 0, 10, 10, 25), box(10, 0, 5, 1, 30), box(10, 1, 5, 4, 18), box(10, 5, 5, 5, 9)};
    findSharedWalls(layout);
    EXPECT_EQ(layout.footprints[0].coveredHeight[1], 18.0);
}

TEST(SharedWalls, CoverHolesToo)
{
    Layout layout; // a house fills the court of another one
    layout.footprints = {box(0, 0, 30, 30, 20), box(10, 10, 10, 10, 8)};
    layout.footprints[0].outline.holes = {{{10, 10}, {10, 20}, {20, 20}, {20, 10}}};
    findSharedWalls(layout);
    EXPECT_EQ(layout.footprints[0].coveredHeight, (Heights{0, 0, 0, 0, 8, 8, 8, 8}));
    EXPECT_EQ(layout.footprints[1].coveredHeight, (Heights{20, 20, 20, 20}));
}

TEST(Fronts, AreTheLongestFreeEdge)
{
    Layout layout; // the long side of the first house is a party wall
    layout.footprints = {box(0, 0, 20, 8, 15), box(0, 8, 20, 8, 15)};
    findSharedWalls(layout);
    chooseFronts(layout);
    EXPECT_EQ(layout.footprints[0].outline.outer[0], glm::dvec2(0, 0));
    EXPECT_EQ(layout.footprints[1].outline.outer[0], glm::dvec2(20, 16));
    EXPECT_EQ(layout.footprints[1].coveredHeight, (Heights{0, 0, 15, 0}));
}

TEST(Fronts, PreferTheStreetToTheCourt)
{
    // Four houses around a court; the southern one tapers, its side on the court is the longer one.
    Layout layout;
    layout.footprints = {box(0, 0, 40, 10, 15), box(0, 10, 10, 20, 15), box(30, 10, 10, 20, 15),
                         box(0, 30, 40, 10, 15)};
    Footprint& south = layout.footprints[0];
    south.outline.outer = {{12, 0}, {28, 0}, {30, 10}, {10, 10}};
    findSharedWalls(layout);
    chooseFronts(layout);
    EXPECT_EQ(south.outline.outer[0], glm::dvec2(12, 0));
    EXPECT_EQ(layout.footprints[3].outline.outer[0], glm::dvec2(40, 40));
}

TEST(Courts, LieInsideClosedRings)
{
    Layout layout; // 20 x 20 m inside, with a passage of 2 m in the south
    layout.footprints = {box(0, 0, 19, 10, 15), box(21, 0, 19, 10, 15), box(0, 10, 10, 20, 15), box(30, 10, 10, 20, 15),
                         box(0, 30, 40, 10, 15)};
    const PolygonIndex closed(enclosedCourts(layout.footprints));
    EXPECT_TRUE(closed.contains({20, 20}));
    EXPECT_TRUE(closed.contains({10.5, 29.5}));
    EXPECT_FALSE(closed.contains({20, -1}));
    EXPECT_FALSE(closed.contains({45, 20}));
    layout.footprints.erase(layout.footprints.begin()); // now it opens to the street
    const PolygonIndex open(enclosedCourts(layout.footprints));
    EXPECT_FALSE(open.contains({20, 20}));
}

} // namespace
