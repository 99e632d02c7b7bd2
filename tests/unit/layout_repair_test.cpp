// SPDX-License-Identifier: Apache-2.0
#include "city/layout/polygon_repair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/common.hpp>
#include <numbers>

#include "city/base/hash.h"
#include "city/layout/overlaps.h"

using namespace helio;

namespace {

double totalArea(const std::vector<Polygon2>& polygons)
{
    double sum = 0.0;
    for (const Polygon2& polygon : polygons) sum += area(polygon);
    return sum;
}

TEST(PolygonRepair, KeepsACleanPolygonToTheLastBit)
{
    const Polygon2 clean{{{0.1, 0.2}, {10.3, 0.0}, {10.0 / 3.0, 8.7}}, {}};
    RepairReport report;
    const auto pieces = cleanPolygon(clean, report);
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_EQ(pieces[0].outer, clean.outer);
    EXPECT_TRUE(repairItems(report).empty());
    EXPECT_EQ(report.reversedRings, 0u);
}

TEST(PolygonRepair, TurnsRingsAndKeepsTheFirstEdge)
{
    const Polygon2 wrong{{{0, 0}, {0, 10}, {10, 10}, {10, 0}}, {{{2, 2}, {4, 2}, {4, 4}, {2, 4}}}};
    RepairReport report;
    const auto pieces = cleanPolygon(wrong, report);
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_EQ(signedArea(pieces[0].outer), 100.0);
    EXPECT_EQ(signedArea(pieces[0].holes.at(0)), -4.0);
    EXPECT_EQ(report.reversedRings, 2u);
    const Ring2 firstEdgeReversed{{0, 10}, {0, 0}};
    EXPECT_EQ(Ring2(pieces[0].outer.begin(), pieces[0].outer.begin() + 2), firstEdgeReversed);
}

TEST(PolygonRepair, SplitsABowTie)
{
    // The diagonals meet at (5, 4): two triangles with base 8 and height 5.
    RepairReport report;
    const auto pieces = cleanPolygon({{{0, 0}, {10, 8}, {10, 0}, {0, 8}}, {}}, report);
    ASSERT_EQ(pieces.size(), 2u);
    EXPECT_TRUE(report.crossing);
    for (const Polygon2& piece : pieces) {
        EXPECT_NEAR(signedArea(piece.outer), 20.0, 1e-6);
        EXPECT_TRUE(isSimple(piece));
    }
}

TEST(PolygonRepair, RemovesASpikeAndARepeatedCorner)
{
    RepairReport report;
    const auto spike = cleanPolygon({{{0, 0}, {10, 0}, {10, 8}, {10, 20}, {10, 8}, {0, 8}}, {}}, report);
    ASSERT_EQ(spike.size(), 1u);
    EXPECT_EQ(spike[0].outer.size(), 4u);
    EXPECT_EQ(area(spike[0]), 80.0);
    EXPECT_GT(report.spikes, 0u);
    EXPECT_FALSE(report.crossing);

    RepairReport repeats;
    const auto twice =
        cleanPolygon({{{0, 0}, {10, 0}, {10.0001, 0}, {10.0001, 0}, {10, 8}, {0, 8}, {0, 8.0001}}, {}}, repeats);
    ASSERT_EQ(twice.size(), 1u);
    EXPECT_EQ(twice[0].outer.size(), 4u);
    EXPECT_EQ(repeats.repeatedCorners, 3u);
}

TEST(PolygonRepair, KeepsANarrowWedgeThatIsNoSpike)
{
    RepairReport report;
    EXPECT_NEAR(totalArea(cleanPolygon({{{0, 0}, {30, 0}, {30, 0.5}}, {}}, report)), 7.5, 1e-12);
    EXPECT_EQ(report.spikes, 0u);
    // 1.5 m2, but 5 cm wide on average.
    EXPECT_TRUE(cleanPolygon({{{0, 0}, {30, 0}, {30, 0.1}}, {}}, report).empty());
    EXPECT_EQ(report.spikes, 0u);
    EXPECT_EQ(report.smallPieces, 1u);
}

TEST(PolygonRepair, DropsStraightCornersButNotACurve)
{
    RepairReport report;
    const auto box = cleanPolygon({{{0, 8}, {0, 0}, {5, 0.001}, {10, 0}, {10, 8}}, {}}, report);
    EXPECT_EQ(box.at(0).outer.size(), 4u);
    EXPECT_EQ(report.straightCorners, 1u);

    // 8 mrad, but 8 cm off the straight line.
    const auto bent = cleanPolygon({{{0, 0}, {20, -0.08}, {40, 0}, {40, 10}, {0, 10}}, {}}, report);
    EXPECT_EQ(bent.at(0).outer.size(), 5u);

    // 1000 corners turn 6 mrad each, below the limit for one corner; the circle must stay one to 2 cm.
    Polygon2 circle;
    for (int i = 0; i < 1000; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 1000.0;
        circle.outer.emplace_back(50.0 * std::cos(angle), 50.0 * std::sin(angle));
    }
    const auto round = cleanPolygon(circle, report);
    ASSERT_EQ(round.size(), 1u);
    EXPECT_NEAR(area(round[0]), std::numbers::pi * 2500.0, 2.0 * std::numbers::pi * 50.0 * 0.02);
}

TEST(PolygonRepair, KeepsTheEndsOfTheFirstEdge)
{
    RepairReport report; // (0, 0) and (5, 0) lie on the line from (-5, 0) to (10, 0), (2, 8) on the upper side
    const Ring2 marked{{0, 0}, {5, 0}, {10, 0}, {10, 8}, {2, 8}, {-5, 8}, {-5, 0}};
    const auto pieces = cleanPolygon({marked, {}}, report);
    EXPECT_EQ(pieces.at(0).outer, (Ring2{{0, 0}, {5, 0}, {10, 0}, {10, 8}, {-5, 8}, {-5, 0}}));
    EXPECT_EQ(report.straightCorners, 1u);
}

TEST(PolygonRepair, NamesEachKindOfRepairOnce)
{
    RepairReport report;
    cleanPolygon({{{0, 0}, {10, 0}, {10, 0}, {10, 8}, {10, 20}, {10, 8}, {0, 8}}, {{{1, 1}, {2, 2}, {3, 3}}}}, report);
    std::vector<std::string> kinds;
    for (const auto& [kind, words] : repairItems(report)) kinds.push_back(kind);
    EXPECT_EQ(kinds,
              (std::vector<std::string>{"repaired.duplicate_corners", "repaired.spikes", "repaired.lost_holes"}));
}

TEST(PolygonRepair, CollapsesShortEdgesOntoTheTrueCorner)
{
    // Without (9.95, 8.01) the area changes by 0.05 m2, without (10, 8) by 0.2 m2.
    RepairReport report;
    const auto pieces = cleanPolygon({{{0, 0}, {10, 0}, {10, 8}, {9.95, 8.01}, {0, 8}}, {}}, report);
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_EQ(pieces[0].outer, (Ring2{{0, 0}, {10, 0}, {10, 8}, {0, 8}}));
    EXPECT_EQ(report.shortEdges, 1u);
}

TEST(PolygonRepair, MendsHoles)
{
    const Ring2 square{{0, 0}, {12, 0}, {12, 12}, {0, 12}};
    RepairReport touching;
    EXPECT_NEAR(totalArea(cleanPolygon({square, {{{0, 6}, {6, 3}, {6, 9}}}}, touching)), 144.0 - 18.0,
                0.07); // drawn apart by 1 mm
    EXPECT_TRUE(touching.crossing);

    RepairReport onTheEdge; // the hole becomes a bay of the outline
    const auto bay = cleanPolygon({square, {{{0, 3}, {0, 9}, {6, 9}, {6, 3}}}}, onTheEdge);
    ASSERT_EQ(bay.size(), 1u);
    EXPECT_TRUE(bay[0].holes.empty());
    EXPECT_NEAR(area(bay[0]), 144.0 - 36.0, 1e-6);

    RepairReport overlapping; // 4 x 4 and 4 x 4 that share 2 x 2
    const auto one =
        cleanPolygon({square, {{{2, 2}, {6, 2}, {6, 6}, {2, 6}}, {{4, 4}, {8, 4}, {8, 8}, {4, 8}}}}, overlapping);
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(one[0].holes.size(), 1u);
    EXPECT_NEAR(area(one[0]), 144.0 - 28.0, 1e-6);

    RepairReport outside;
    const auto alone = cleanPolygon({square, {{{20, 0}, {22, 0}, {22, 2}, {20, 2}}}}, outside);
    EXPECT_NEAR(totalArea(alone), 144.0, 1e-6);
    EXPECT_TRUE(alone.at(0).holes.empty());
}

TEST(PolygonRepair, GivesNothingForWhatHasNoArea)
{
    RepairReport report;
    EXPECT_TRUE(cleanPolygon({{{0, 0}, {5, 0}, {10, 0}}, {}}, report).empty());
    EXPECT_TRUE(cleanPolygon({{{0, 0}, {5, 0}}, {}}, report).empty());
    EXPECT_TRUE(cleanPolygon({}, report).empty());
    EXPECT_EQ(report.smallPieces, 0u);
    EXPECT_TRUE(cleanPolygon({{{0, 0}, {0.9, 0}, {0.9, 0.9}, {0, 0.9}}, {}}, report).empty());
    EXPECT_EQ(report.smallPieces, 1u);
}

TEST(PolygonRepair, MakesSimplePolygonsOfScribbles)
{
    // Random rings with up to three random holes, half of them on a coarse raster where corners and edges coincide.
    Random random(20260721);
    u32 pieceCount = 0;
    for (int i = 0; i < 3000; ++i) {
        const bool coarse = i % 2 == 0;
        const auto scribble = [&](double size) {
            Ring2 ring(3 + size_t(random.uniform() * 12.0));
            for (glm::dvec2& corner : ring) {
                corner = size * glm::dvec2(random.uniform(), random.uniform());
                if (coarse) corner = glm::round(corner);
            }
            return ring;
        };
        Polygon2 polygon{scribble(20.0), {}};
        for (int hole = int(random.uniform() * 4.0); hole > 0; --hole) polygon.holes.push_back(scribble(10.0));
        RepairReport report;
        const auto pieces = cleanPolygon(polygon, report);
        double sum = 0.0;
        for (const Polygon2& piece : pieces) {
            EXPECT_TRUE(isSimple(piece)) << "scribble " << i;
            EXPECT_GE(area(piece), 1.0);
            sum += area(piece);
        }
        EXPECT_LE(sum, 400.0);
        pieceCount += u32(pieces.size());
    }
    EXPECT_GT(pieceCount, 3000u);
}

TEST(PolygonRepair, KnowsSimplePolygons)
{
    const Ring2 square{{0, 0}, {12, 0}, {12, 12}, {0, 12}};
    EXPECT_TRUE(isSimple({square, {}}));
    EXPECT_TRUE(isSimple({square, {{{2, 2}, {2, 4}, {4, 4}}, {{6, 6}, {6, 8}, {8, 8}}}}));
    EXPECT_FALSE(isSimple({{{0, 0}, {5, 0}, {5, 5}, {10, 5}, {10, 10}, {5, 10}, {5, 5}, {0, 5}}, {}})); // meets itself
    EXPECT_FALSE(isSimple({square, {{{1, 1}, {1, 9}, {9, 9}, {9, 1}}, {{2, 2}, {2, 3}, {3, 3}}}})); // hole in a hole
    EXPECT_FALSE(isSimple({square, {{{20, 0}, {22, 0}, {22, 2}}}}));                                // hole outside
}

TEST(SplitFootprint, TellsOfPiecesWithoutFaces)
{
    const auto square = [](double x) { return Polygon2{{{x, 0}, {x + 10, 0}, {x + 10, 10}, {x, 10}}, {}}; };
    Footprint whole;
    whole.id = "a";
    whole.faces.resize(1);
    whole.faces[0].polygon.outer = {{2, 2, 5}, {8, 2, 5}, {8, 8, 5}, {2, 8, 5}}; // a roof over the first square
    ImportNotes notes;
    const std::vector<Footprint> pieces = splitFootprint(whole, {square(0), square(20), square(40)}, notes);
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_EQ(pieces[0].outline.outer[0], glm::dvec2(0, 0));
    EXPECT_EQ(notes.counts().at("repaired.faceless_pieces"), 1u);
    EXPECT_EQ(notes.take().at(0), "feature a: dropped 2 piece(s) on which no given wall or roof stands");
    whole.faces.clear();
    EXPECT_EQ(splitFootprint(whole, {square(0), square(20)}, notes).size(), 2u);
    EXPECT_TRUE(notes.take().empty());
}

} // namespace
