// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <sstream>

#include "city/layout/courts.h"
#include "city/layout/fronts.h"
#include "city/layout/shared_walls.h"
#include "city/layout/streets.h"

using namespace helio;

namespace {

Footprint box(double x, double y, double width, double depth, double height)
{
    Footprint footprint;
    footprint.outline.outer = {{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}};
    footprint.height = height;
    return footprint;
}

// The spans of an edge as "begin-end:height", separated by spaces.
std::string spans(const Footprint& footprint, size_t edge)
{
    std::ostringstream out;
    for (const CoveredSpan& span : footprint.covered.at(edge))
        out << (out.tellp() > 0 ? " " : "") << span.begin << "-" << span.end << ":" << span.height;
    return out.str();
}

TEST(SharedWalls, CoverUpToTheNeighboursHeight)
{
    // b stands along the whole right side of a, at a gap of 0.2 m; c is 0.4 m above a.
    Layout layout;
    layout.footprints = {box(0, 0, 10, 10, 20), box(10.2, 0, 10, 10, 15), box(0, 10.4, 10, 10, 30)};
    findSharedWalls(layout);
    EXPECT_EQ(spans(layout.footprints[0], 1), "0-10:15");
    EXPECT_EQ(spans(layout.footprints[1], 3), "0-10:20");
    u32 covered = 0;
    for (const Footprint& footprint : layout.footprints)
        for (const auto& edge : footprint.covered) covered += !edge.empty();
    EXPECT_EQ(covered, 2u);
    EXPECT_EQ(layout.footprints[2].covered.size(), 4u);
}

TEST(SharedWalls, CountAboveTheOwnGround)
{
    Layout layout; // on a slope: the neighbour's eaves at 3 + 9 are 7 m above the ground at 5
    layout.footprints = {box(0, 0, 10, 10, 20), box(10, 0, 10, 10, 9), box(-10, 0, 10, 10, 2)};
    layout.footprints[0].base = 5.0;
    layout.footprints[1].base = 3.0;
    findSharedWalls(layout);
    EXPECT_EQ(spans(layout.footprints[0], 1), "0-10:7");
    EXPECT_EQ(spans(layout.footprints[0], 3), ""); // its top lies below this one's ground
    EXPECT_EQ(spans(layout.footprints[2], 1), "0-10:25");
}

TEST(SharedWalls, AreTheStretchesThatTouch)
{
    Layout layout; // along the right side of a, upwards: 2 m free, 3 m of b, 1 m free, 4 m of c, of which d hides 1 m
    layout.footprints = {box(0, 0, 10, 10, 20), box(10, 2, 5, 3, 15), box(10, 6, 5, 4, 8), box(10.1, 7, 5, 1, 12)};
    findSharedWalls(layout);
    EXPECT_EQ(spans(layout.footprints[0], 1), "2-5:15 6-7:8 7-8:12 8-10:8");
    EXPECT_EQ(spans(layout.footprints[1], 3), "0-3:20");
    EXPECT_EQ(coveredHalf(layout.footprints[0].covered[1], 10.0), 8.0); // 3 m up to 15, 4 m up to 12, 7 m up to 8
    EXPECT_EQ(coveredHalf(layout.footprints[0].covered[1], 14.1), 0.0);
    EXPECT_EQ(coveredHalf({}, 10.0), 0.0);
}

TEST(SharedWalls, MergeEqualNeighboursAndCloseSeams)
{
    Layout layout; // three houses of one height with seams of 5 mm between, 8 mm short of the corners
    layout.footprints = {box(0, 0, 10, 10, 20), box(10, 0.008, 5, 2.987, 9), box(10, 3, 5, 3, 9),
                         box(10, 6.005, 5, 3.987, 9)};
    findSharedWalls(layout);
    EXPECT_EQ(spans(layout.footprints[0], 1), "0-10:9");
}

TEST(SharedWalls, EndWhereWallsDriftApart)
{
    // The neighbour's wall leans away by 0.1 m per metre (5.7 degrees): 0.3 m are reached after 3 m.
    Layout layout;
    layout.footprints = {box(0, 0, 10, 10, 20), box(0, 0, 1, 1, 15)};
    layout.footprints[1].outline.outer = {{10, 0}, {20, 0}, {20, 10}, {11, 10}};
    findSharedWalls(layout);
    ASSERT_EQ(layout.footprints[0].covered[1].size(), 1u);
    EXPECT_NEAR(layout.footprints[0].covered[1][0].end, 3.0, 1e-9);
    // Twice as steep, 11.3 degrees: not along each other.
    layout.footprints[1].outline.outer[3] = {12, 10};
    findSharedWalls(layout);
    EXPECT_EQ(spans(layout.footprints[0], 1), "");
}

TEST(SharedWalls, CoverHolesToo)
{
    Layout layout; // a house fills the court of another one
    layout.footprints = {box(0, 0, 30, 30, 20), box(10, 10, 10, 10, 8)};
    layout.footprints[0].outline.holes = {{{10, 10}, {10, 20}, {20, 20}, {20, 10}}};
    findSharedWalls(layout);
    for (size_t edge = 0; edge < 8; ++edge)
        EXPECT_EQ(spans(layout.footprints[0], edge), edge < 4 ? "" : "0-10:8") << edge;
    for (size_t edge = 0; edge < 4; ++edge) EXPECT_EQ(spans(layout.footprints[1], edge), "0-10:20") << edge;
}

TEST(Fronts, AreTheLongestFreeEdge)
{
    Layout layout; // the long side of the first house is a party wall
    layout.footprints = {box(0, 0, 20, 8, 15), box(0, 8, 20, 8, 15)};
    findSharedWalls(layout);
    chooseFronts(layout);
    EXPECT_EQ(layout.footprints[0].outline.outer[0], glm::dvec2(0, 0));
    EXPECT_EQ(layout.footprints[1].outline.outer[0], glm::dvec2(20, 16));
    for (size_t edge = 0; edge < 4; ++edge)
        EXPECT_EQ(spans(layout.footprints[1], edge), edge == 2 ? "0-20:15" : "") << edge;
    EXPECT_TRUE(layout.footprints[0].onStreet.empty());
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

TEST(Fronts, JoinTheFirstEdgeWithTheWallThatItIsASmallPartOf)
{
    Layout
        layout; // the wall from (0, 0) to (12, 0) is drawn in two edges, of which the input puts the shorter one first
    layout.footprints = {box(0, 0, 12, 8, 15), box(10, -5, 2, 5, 6)}; // the small house stands against the last 2 m
    layout.footprints[0].outline.outer = {{7, 0}, {12, 0}, {12, 8}, {1, 8}, {0, 0}};
    findSharedWalls(layout);
    EXPECT_EQ(spans(layout.footprints[0], 0), "3-5:6");
    chooseFronts(layout);
    EXPECT_EQ(layout.footprints[0].outline.outer, (Ring2{{0, 0}, {12, 0}, {12, 8}, {1, 8}}));
    EXPECT_EQ(spans(layout.footprints[0], 0), "10-12:6");
    EXPECT_EQ(layout.footprints[0].covered.size(), 4u);
}

TEST(Fronts, KeepAFirstEdgeThatIsMostOfTheFront)
{
    Layout layout;
    layout.footprints = {box(0, 0, 12, 8, 15), box(0, 0, 12, 8, 15)};
    layout.footprints[0].outline.outer = {{3, 0}, {12, 0}, {12, 8}, {1, 8}, {0, 0}};         // 9 of 12 m
    layout.footprints[1].outline.outer = {{107, 0}, {112, 0}, {112, 8}, {101, 8}, {100, 0}}; // 5 of 12 m
    findSharedWalls(layout);
    chooseFronts(layout);
    EXPECT_EQ(layout.footprints[0].outline.outer[0], glm::dvec2(3, 0));
    EXPECT_EQ(layout.footprints[0].outline.outer.size(), 5u);
    EXPECT_EQ(layout.footprints[1].outline.outer, (Ring2{{100, 0}, {112, 0}, {112, 8}, {101, 8}}));
}

TEST(Streets, AreFacedWithin30MetresAndWithNothingBetween)
{
    Layout layout; // south of the houses runs a street 10 m away; a shed stands before the second house
    layout.footprints = {box(0, 0, 10, 20, 15), box(50, 0, 10, 20, 15), box(49, -4, 12, 3, 3),
                         box(100, 21, 10, 20, 15)};
    layout.streets = {{{-20, -10}, {200, -10}}};
    markStreets(layout);
    using Flags = std::vector<bool>;
    EXPECT_EQ(layout.footprints[0].onStreet, (Flags{true, false, false, false}));
    EXPECT_EQ(layout.footprints[1].onStreet, (Flags{false, false, false, false})); // the shed stands before it
    EXPECT_EQ(layout.footprints[2].onStreet, (Flags{true, false, false, false}));
    EXPECT_EQ(layout.footprints[3].onStreet, (Flags{false, false, false, false})); // 31 m
    EXPECT_NEAR(streetDistances(layout)[0][0], 10.0 - 0.02, 1e-9);
    layout.streets.clear();
    markStreets(layout);
    EXPECT_TRUE(layout.footprints[0].onStreet.empty());
}

TEST(Streets, AreFacedUnderLessThan60Degrees)
{
    // A street that ends 6 m before the wall, at its side: seen from the wall's middle at atan(d / 6).
    const auto faces = [](double aside) {
        Layout layout;
        layout.footprints = {box(-1, 0, 2, 10, 15)};
        layout.streets = {{{aside, -6}, {aside + 50, -6}}};
        markStreets(layout);
        return bool(layout.footprints[0].onStreet.at(0));
    };
    EXPECT_TRUE(faces(10.2)); // 59.5 degrees; 60 are 10.39
    EXPECT_FALSE(faces(10.7));
}

TEST(Streets, ChooseTheNearestFreeEdgeAsFront)
{
    Layout layout; // the long sides look south and north; a street runs east of the house, another one farther south
    layout.footprints = {box(0, 0, 20, 8, 15), box(0, 8, 20, 8, 15), box(0, -60, 12, 8, 15)};
    layout.streets = {{{26, -20}, {26, 50}}, {{-20, -20}, {50, -20}}};
    findSharedWalls(layout);
    markStreets(layout);
    chooseFronts(layout);
    const Ring2& ring = layout.footprints[0].outline.outer;
    EXPECT_EQ(ring[0], glm::dvec2(20, 0));
    EXPECT_EQ(ring[1], glm::dvec2(20, 8));
    EXPECT_EQ(layout.footprints[0].onStreet, (std::vector<bool>{true, false, false, true}));
    EXPECT_EQ(spans(layout.footprints[0], 1), "0-20:15");
    EXPECT_EQ(layout.footprints[2].outline.outer[0], glm::dvec2(0, -60)); // no street within 30 m: the longest
}

TEST(Streets, TakeTheLongestOfEdgesEquallyNear)
{
    Layout layout; // a front with a bay: its 2.5 m stand 0.5 m nearer to the street than the 9 m beside it
    layout.footprints = {box(0, 0, 12, 8, 15)};
    layout.footprints[0].outline.outer = {{0, 0.5}, {0.5, 0.5}, {0.5, 0}, {3, 0}, {3, 0.5}, {12, 0.5}, {12, 8}, {0, 8}};
    layout.streets = {{{-20, -10}, {50, -10}}};
    findSharedWalls(layout);
    markStreets(layout);
    chooseFronts(layout);
    EXPECT_EQ(layout.footprints[0].outline.outer[0], glm::dvec2(3, 0.5));
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
