// SPDX-License-Identifier: Apache-2.0
#include "city/layout/validity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "city/layout/census.h"

using namespace helio;

namespace {

std::string defectOf(const Polygon2& polygon)
{
    const char* defect = polygonFindings(polygon).defect;
    return defect ? defect : "";
}

const Ring2 kSquare{{0, 0}, {12, 0}, {12, 12}, {0, 12}};

TEST(Orientation, IsExactWhereDoublesRoundTheSignAway)
{
    // c lies one unit in the last place above the line through (0, 0) and (3, 3) far away: the plain determinant of
    // doubles is 0 or of the wrong sign for many of these.
    const glm::dvec2 a(0.5, 0.5), b(12.0, 12.0);
    for (int i = 0; i < 64; ++i) {
        const double x = 24.0 + i * 0x1p-48;
        EXPECT_EQ(orientation(a, b, {x, x}), 0);
        EXPECT_EQ(orientation(a, b, {x, std::nextafter(x, 30.0)}), 1);
        EXPECT_EQ(orientation(a, b, {std::nextafter(x, 30.0), x}), -1);
        EXPECT_EQ(orientation(b, a, {x, std::nextafter(x, 30.0)}), -1);
    }
    EXPECT_EQ(orientation({0, 0}, {1, 0}, {0, 1}), 1);
    EXPECT_EQ(orientation({1, 1}, {1, 1}, {5, 7}), 0);
}

TEST(Validity, AcceptsWhatTheStandardAccepts)
{
    EXPECT_EQ(defectOf({kSquare, {}}), "");
    EXPECT_EQ(defectOf({{{0, 12}, {12, 12}, {12, 0}, {0, 0}}, {}}), "");                      // either direction
    EXPECT_EQ(defectOf({{{0, 0}, {0, 0}, {6, 0}, {12, 0}, {12, 12}, {0, 12}}, {}}), "");      // repeated and straight
    EXPECT_EQ(defectOf({kSquare, {{{0, 6}, {6, 3}, {6, 9}}}}), "");                           // touches in one point
    EXPECT_EQ(defectOf({kSquare, {{{2, 2}, {4, 2}, {4, 4}}, {{4, 4}, {6, 4}, {6, 6}}}}), ""); // holes touch
}

TEST(Validity, NamesEachDefect)
{
    EXPECT_EQ(defectOf({{{0, 0}, {5, 0}}, {}}), "Too few points in geometry component");
    EXPECT_EQ(defectOf({kSquare, {{{2, 2}, {2, 2}, {4, 4}}}}), "Too few points in geometry component");
    EXPECT_EQ(defectOf({{{0, 0}, {10, 8}, {10, 0}, {0, 8}}, {}}), "Self-intersection");                    // bow tie
    EXPECT_EQ(defectOf({{{0, 0}, {10, 0}, {10, 8}, {10, 20}, {10, 8}, {0, 8}}, {}}), "Self-intersection"); // antenna
    EXPECT_EQ(defectOf({kSquare, {{{6, 6}, {18, 6}, {18, 8}}}}), "Self-intersection");
    EXPECT_EQ(defectOf({kSquare, {{{0, 3}, {0, 9}, {6, 9}, {6, 3}}}}), "Self-intersection"); // shares an edge
    // The hole's corner lies on the outline, and its edges leave to either side.
    EXPECT_EQ(defectOf({kSquare, {{{12, 6}, {14, 9}, {10, 9}, {10, 3}}}}), "Self-intersection");
    EXPECT_EQ(defectOf({{{0, 0}, {5, 0}, {5, 5}, {10, 5}, {10, 10}, {5, 10}, {5, 5}, {0, 5}}, {}}),
              "Ring Self-intersection");
    EXPECT_EQ(defectOf({{{0, 0}, {12, 0}, {12, 12}, {6, 0}, {0, 12}}, {}}), "Ring Self-intersection"); // corner on edge
    EXPECT_EQ(defectOf({kSquare, {{{20, 0}, {22, 0}, {22, 2}}}}), "Hole lies outside shell");
    EXPECT_EQ(defectOf({kSquare, {{{1, 1}, {1, 9}, {9, 9}, {9, 1}}, {{2, 2}, {2, 3}, {3, 3}}}}), "Holes are nested");
    EXPECT_EQ(defectOf({kSquare, {{{0, 6}, {6, 0}, {12, 6}, {6, 12}}}}), "Interior is disconnected");
    EXPECT_EQ(defectOf({kSquare, {{{0, 0}, {6, 2}, {6, 6}}, {{6, 6}, {6, 10}, {0, 12}}}}), "Interior is disconnected");
}

TEST(Validity, StopsCountingAtTheLimit)
{
    Polygon2 fan; // 2 x 40 needles from left to right and back, all of which cross a comb
    for (int i = 0; i < 40; ++i) fan.outer.insert(fan.outer.end(), {{0.0, double(i)}, {100.0, i + 0.5}});
    for (int i = 0; i < 40; ++i) fan.outer.insert(fan.outer.end(), {{double(i) + 20.3, 60.0}, {i + 20.6, -20.0}});
    EXPECT_EQ(polygonFindings(fan, 50).meetings, 51u);
    EXPECT_GE(polygonFindings(fan).meetings, 79u * 79u);
}

GeoFeature feature(const std::string& id, const Polygon2& polygon)
{
    GeoFeature feature;
    feature.id = id;
    feature.polygons = {polygon};
    return feature;
}

TEST(Census, CountsEachKindAsDelivered)
{
    const auto box = [](double x, double y, double w, double h) {
        return Polygon2{{{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}}, {}};
    };
    std::vector<GeoFeature> city{
        feature("plain", box(0, 0, 10, 10)),
        feature("neighbour", box(10.02, 2, 10, 10)), // shares 8 m of wall
        feature("clockwise", {{{100, 0}, {100, 10}, {110, 10}, {110, 0}}, {}}),
        feature("again", {{{110, 10}, {100, 10}, {100, 0}, {110, 0}}, {}}), // the same square
        feature("over", box(105, 5, 10, 10)),                               // 25 m2 of both
        feature("bow", {{{200, 0}, {210, 8}, {210, 0}, {200, 8}}, {}}),
        feature("spike", {{{300, 0}, {310, 0}, {310, 8}, {310, 20}, {310, 8}, {300, 8}}, {}}),
        feature("repeat", {{{400, 0}, {405, 0}, {410, 0}, {410, 0.0005}, {410, 0.2}, {410, 8}, {400, 8}}, {}}),
        feature("sliver", box(500, 0, 60, 0.9)),
        feature("tiny", box(600, 0, 1.9, 2)),
        feature("court", {{{700, 0}, {730, 0}, {730, 30}, {715, 15}, {700, 30}}, {{{705, 5}, {705, 8}, {710, 8}}}}),
    };
    city[0].height = 5.0;
    city[1].openRings = 1;
    const std::map<std::string, u32> expected{{"polygons", 11},
                                              {"holes", 1},
                                              {"with_holes", 1},
                                              {"vertices", 53},
                                              {"missing_height", 10},
                                              {"clockwise_outer", 1},
                                              {"invalid", 2},
                                              {"invalid_kinds.Self-intersection", 2},
                                              {"rings_not_closed", 1},
                                              {"has_duplicate_vertex(<1mm)", 1},
                                              {"has_short_edge(1mm..0.25m)", 1},
                                              {"has_collinear_vertex", 2}, // repeat, and the foot of the spike
                                              {"spike_vertices", 1},
                                              {"non_convex(<95% hull)", 3},     // bow, spike, court
                                              {"slivers(compactness<0.12)", 2}, // sliver, and the bow without area
                                              {"tiny(<4m2)", 2},
                                              {"in_shared_wall(>0.5m)", 4},
                                              {"overlapping_pairs(>0.5m2)", 3},
                                              {"duplicate_footprints", 1}};
    const std::map<std::string, u32> found = censusOf(city);
    for (const auto& [name, count] : expected) EXPECT_EQ(found.at(name), count) << name;
    EXPECT_EQ(found.size(), expected.size());
}

} // namespace
