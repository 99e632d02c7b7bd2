// SPDX-License-Identifier: Apache-2.0
// Form factors of pairs against closed forms (Howell's catalogue: C-1, C-11, C-13, C-14, C-15), against values of an
// independent evaluation with 55 digits (inner integral of the double contour in closed form, outer by tanh-sinh; names
// are the rows of that table), and against what must hold for every pair.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "city/light/form_factor.h"
#include "city/light/pair_factor.h"
#include "tests/numeric/pair_fixtures.h"

using namespace helio;
using namespace helio::test;

namespace {

struct Row
{
    const char* name;
    PairRings pair;
    double ab, ba;
};

std::vector<Row> rows()
{
    const Ring3 street{{-5, 0, 0}, {5, 0, 0}, {5, 10, 0}, {-5, 10, 0}};
    const Ring3 lShape{{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
    return {
        {"P01 cube", opposed(0, 1, 0, 1, 1, 0, 1, 0, 1), 0.19982489569838738304, 0.19982489569838738304},
        {"P02 near", opposed(.1, .2, .1, .2, .05, .1, .2, .1, .2), 0.41525328357714673537, 0.41525328357714673537},
        {"P03 facades", opposed(0, 100, 0, 20, 15, 0, 100, 0, 20), 0.44850431100919077733, 0.44850431100919077733},
        {"P04 windows", opposed(0, 1.5, 0, 1.2, 12, 7.3, 8.5, 4.1, 5.6), 0.0018150826747763339745,
         0.0018150826747763339745},
        {"P06 gap 1e-3", opposed(0, 1, 0, 1, 1e-3, 0, 1, 0, 1), 0.998005631907579727, 0.998005631907579727},
        {"P07 gap 1e-6", opposed(0, 1, 0, 1, 1e-6, 0, 1, 0, 1), 0.99999800001002952124, 0.99999800001002952124},
        {"P08 ratio 1e6", opposed(-.0005, .0005, -.0005, .0005, 10, -500, 500, -500, 500), 0.99967278693644750938,
         9.9967278693644750938e-13},
        {"P10 far", opposed(0, 1, 0, 1, 1000, 0, 1, 0, 1), 3.1830967397738025777e-7, 3.1830967397738025777e-7},
        {"P11 far windows", opposed(0, 3, 0, 3, 250, 80, 83, 20, 23), 0.000037280321831181324085,
         0.000037280321831181324085},
        {"P13 sliver to wall", opposed(0, .001, 0, 100, 10, 0, 20, 0, 100), 0.4122027445176317486,
         0.00002061013722588158743},
        {"P14 slivers", opposed(0, .001, 0, 100, .001, 0, .001, 0, 100), 0.41421076872909668142,
         0.41421076872909668142},
        {"Q01 adjacent", perpendicular(0, 1, 0, 1, 0, 1, 0, 1), 0.20004377607540315424, 0.20004377607540315424},
        {"Q02 street, facade", perpendicular(0, 15, 0, 100, 0, 20, 0, 100), 0.31182401037947633713,
         0.23386800778460725285},
        {"Q03 general", perpendicular(.5, 2, 0, 3, .25, 1.5, -1, 2.2), 0.11508156306669084315, 0.12946675845002719854},
        {"Q05 strip at the foot", perpendicular(0, 20, 0, 100, 0, .001, 0, 100), 0.000024998547641034433096,
         0.49997095282068866193},
        {"Q06 gap at the edge", perpendicular(1e-6, 1.000001, 0, 1, 0, 1, 0, 1), 0.20004334176022314416,
         0.20004334176022314416},
        {"Q07 one corner", perpendicular(0, 1, 0, 1, 0, 1, 1, 2), 0.040592230101558542583, 0.040592230101558542583},
        {"Q08 jamb", perpendicular(0, 1.5, 0, 1.2, 0, .12, 0, 1.2), 0.034786082607169449728, 0.4348260325896181216},
        {"Q10 far", perpendicular(800, 801, 0, 1, 30, 31, 100, 101), 1.8296794040015112711e-8,
         1.8296794040015112711e-8},
        {"R01 60 deg", hinged(1, 1, 1, 60), 0.3709053211500514359, 0.3709053211500514359},
        {"R02 120 deg", hinged(1, 1, 1, 120), 0.086615001118276058831, 0.086615001118276058831},
        {"R03 179 deg", hinged(1, 1, 1, 179), 0.000023608783114983361582, 0.000023608783114983361582},
        {"R04 179.9 deg", hinged(1, 1, 1, 179.9), 2.3608665446788677202e-7, 2.3608665446788677202e-7},
        {"R06 roof and wall", hinged(6, 20, 100, 150), 0.049536318042533995489, 0.014860895412760198647},
        {"S01 triangles",
         {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 2, 1}, {2, 0, 1}}},
         0.28431252098946008575,
         0.071078130247365021439},
        {"S03 L-shape",
         {lShape, {{0, 0, 2}, {0, 2, 2}, {2, 2, 2}, {2, 0, 2}}},
         0.16798876529848359182,
         0.20998595662310448978},
        {"H01 behind the wall's plane",
         {street, {{0, 0, 0}, {0, 10, 0}, {0, 10, 8}, {0, 0, 8}}},
         0.1396560017209588,
         0.1396560017209588 * 100 / 80},
    };
}

double relative(double value, double expected)
{
    return std::abs(value - expected) / expected;
}

} // namespace

TEST(PairFactor, PlanarRowsInBothAccuracies)
{
    for (const Row& row : rows()) {
        for (const auto& [accuracy, bound] : {std::pair{kProductionAccuracy, 1e-4}, {kReferenceAccuracy, 1e-9}}) {
            const PairFactor f = pairFactor(row.pair.a, row.pair.b, {}, accuracy);
            EXPECT_LT(relative(f.ab, row.ab), bound) << row.name;
            EXPECT_LT(relative(f.ba, row.ba), bound) << row.name;
            EXPECT_LT(f.error, bound / 10) << row.name;
            EXPECT_EQ(f.visibility, 1.0);
            EXPECT_GT(f.evaluations, 0u);
            // The estimate holds; the corners of the hinged pairs are themselves rounded, by 1e-16 / sin(angle) twice.
            EXPECT_LE(relative(f.ab, row.ab), 2.0 * f.error + 1e-13) << row.name;
        }
    }
}

TEST(PairFactor, TheSameAtMapCoordinates)
{
    for (const Row& row : rows()) {
        const glm::dvec3 map(5e5, 4.5e6, 300.0);
        const PairFactor f = pairFactor(moved(row.pair.a, map), moved(row.pair.b, map), {});
        EXPECT_LT(relative(f.ab, row.ab), 1e-6) << row.name;
        EXPECT_LT(relative(f.ba, row.ba), 1e-6) << row.name;
    }
    // U02: corners that are exact in float at map coordinates; 60 digits.
    const PairRings u02{
        {{500000, 4500000, 0}, {500001.5, 4500000, 0}, {500001.5, 4500001, 0}, {500000, 4500001, 0}},
        {{500007.3125, 4500004, 12}, {500007.3125, 4500005.5, 12}, {500008.5, 4500005.5, 12}, {500008.5, 4500004, 12}}};
    EXPECT_LT(relative(pairFactor(u02.a, u02.b, {}, kReferenceAccuracy).ab, 0.001794965399985987), 1e-12);
}

TEST(PairFactor, GeneralAlignedRectanglesByClosedForm)
{
    Random dice(11);
    for (int k = 0; k < 60; ++k) {
        const auto interval = [&](double scale) {
            const double low = scale * (dice.uniform() - 0.5);
            return std::pair{low, low + scale * (0.05 + dice.uniform())};
        };
        const auto [x0, x1] = interval(3);
        const auto [y0, y1] = interval(2);
        const auto [u0, u1] = interval(1);
        const auto [v0, v1] = interval(4);
        const double z = std::pow(10.0, -3.0 + 3.5 * dice.uniform());
        const PairRings pair = opposed(x0, x1, y0, y1, z, u0, u1, v0, v1);
        const double expected = closedOpposed(x0, x1, y0, y1, z, u0, u1, v0, v1);
        EXPECT_LT(relative(pairFactor(pair.a, pair.b, {}, kReferenceAccuracy).ab, expected), 1e-9) << k;
        EXPECT_LT(relative(pairFactor(pair.a, pair.b, {}).ab, expected), 1e-4) << k;
    }
}

TEST(PairFactor, TinyPatchBesideHugeOne)
{
    // 1e-6 m2 beside 1e4 m2: at its foot, and 1e-4 m before its middle.
    const PairRings foot = perpendicular(0, 1e-3, 0, 1e-3, 0, 100, -50, 50);
    EXPECT_LT(relative(pairFactor(foot.a, foot.b, {}, kReferenceAccuracy).ab,
                       closedPerpendicular(0, 1e-3, 0, 1e-3, 0, 100, -50, 50)),
              2e-7); // the closed form itself loses that much
    EXPECT_LT(pairFactor(foot.a, foot.b, {}, kReferenceAccuracy).error, 1e-14);
    // At the wall's corner neither points over the patch nor the whole wall's edges are exact enough.
    const PairRings corner = perpendicular(0, 1e-3, 0, 1e-3, 0, 100, 0, 100);
    const PairFactor atCorner = pairFactor(corner.a, corner.b, {}, kReferenceAccuracy);
    EXPECT_LT(atCorner.error, 1e-11);
    EXPECT_LT(relative(atCorner.ab, closedPerpendicular(0, 1e-3, 0, 1e-3, 0, 100, 0, 100)), 2e-7);
    // In the corner of an endless wall it would be 1/2; what is missing goes with the patch's width.
    const auto missing = [](double width) {
        const PairRings pair = perpendicular(0, width, 0, width, 0, 100, -50, 50);
        return 0.5 - pairFactor(pair.a, pair.b, {}, kReferenceAccuracy).ab;
    };
    EXPECT_NEAR(missing(1e-3) / missing(1e-5), 100.0, 1e-6);
    EXPECT_LT(pairFactor(foot.a, foot.b, {}).error, 1e-6);
    // Before the middle of a wide wall nothing but the wall is seen: less than 1 by (z / r)^2 about.
    const PairRings middle = opposed(0, 1e-3, 0, 1e-3, 1e-4, -50, 50, -50, 50);
    const PairFactor f = pairFactor(middle.a, middle.b, {});
    EXPECT_NEAR(f.ab, 1.0, 1e-8);
    EXPECT_LE(f.ab, 1.0);
    EXPECT_NEAR(f.ba, 1e-10, 1e-17);
}

TEST(PairFactor, NothingFromBehindInPlaneOrWithoutArea)
{
    const PairRings cube = opposed(0, 1, 0, 1, 1, 0, 1, 0, 1);
    const Ring3 reversed(cube.b.rbegin(), cube.b.rend());
    const Ring3 beside{{2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}};
    const Ring3 line{{0, 0, 1}, {1, 0, 1}, {2, 0, 1}};
    for (const Ring3& other : {reversed, beside, line, cube.a, Ring3{}}) {
        const PairFactor f = pairFactor(cube.a, other, {});
        EXPECT_EQ(f.ab, 0.0);
        EXPECT_EQ(f.ba, 0.0);
        EXPECT_EQ(f.visibility, 1.0);
        EXPECT_EQ(f.error, 0.0);
    }
    // A sliver of 1e-9 m and one of no more than rounding.
    for (const double width : {1e-9, 1e-15, 1e-300}) {
        const PairRings sliver = opposed(0, width, 0, 1, 1, 0, 1, 0, 1);
        const PairFactor f = pairFactor(sliver.a, sliver.b, {});
        EXPECT_TRUE(f.ab >= 0.0 && f.ab <= 1.0 && f.ba >= 0.0 && f.ba <= 1.0) << width;
        if (width == 1e-9) {
            EXPECT_NEAR(f.ab, pointLineMean(), 1e-6);
        }
    }
}

TEST(PairFactor, InterpenetratingWallsSeeTheirFrontParts)
{
    // Two squares that cross in the line x = z = 1/2: each counts with its half before the other, a hinged pair.
    const Ring3 level{{0, 0, .5}, {1, 0, .5}, {1, 1, .5}, {0, 1, .5}},
        upright{{.5, 0, 0}, {.5, 1, 0}, {.5, 1, 1}, {.5, 0, 1}};
    const PairFactor f = pairFactor(level, upright, {}, kReferenceAccuracy);
    const double half = closedPerpendicular(0, .5, 0, 1, 0, .5, 0, 1);
    EXPECT_LT(relative(f.ab, half / 2), 1e-12);
    EXPECT_LT(relative(f.ba, half / 2), 1e-12);
}

TEST(PairFactor, ClosedRoomsAddUpToOne)
{
    Random dice(5);
    for (int k = 0; k < 6; ++k) {
        const glm::dvec3 size(1 + 30 * dice.uniform(), 1 + 3 * dice.uniform(), 0.01 + dice.uniform());
        const std::vector<Ring3> room = turnedAll(boxInside(size), dice);
        for (const Ring3& wall : room) {
            double sum = 0.0;
            for (const Ring3& other : room)
                if (&other != &wall) sum += pairFactor(wall, other, {}, kReferenceAccuracy).ab;
            EXPECT_NEAR(sum, 1.0, 1e-11) << k;
        }
    }
}

TEST(PairFactor, RandomPolygonsKeepTheLaws)
{
    Random dice(3);
    for (int k = 0; k < 40; ++k) {
        const PairRings pair = randomPair(dice);
        const PairFactor f = pairFactor(pair.a, pair.b, {}, kReferenceAccuracy);
        ASSERT_TRUE(f.ab >= 0.0 && f.ab <= 1.0 && f.ba >= 0.0 && f.ba <= 1.0) << k;
        // Reciprocity, and the same to the bit whoever comes first.
        const PairFactor back = pairFactor(pair.b, pair.a, {}, kReferenceAccuracy);
        EXPECT_EQ(f.ab, back.ba);
        EXPECT_EQ(f.ba, back.ab);
        const double areaA = planarShape({{pair.a}}).area, areaB = planarShape({{pair.b}}).area;
        EXPECT_NEAR(areaA * f.ab, areaB * f.ba, 1e-14 * areaA * f.ab) << k;
        // Parts add up.
        double parts = 0.0;
        for (const Ring3& part : trianglesOf(pair.b)) parts += pairFactor(pair.a, part, {}, kReferenceAccuracy).ab;
        EXPECT_NEAR(parts, f.ab, 1e-9 * f.ab + 1e-18) << k;
        // Any rotation is the same.
        const std::vector<Ring3> turned = turnedAll({pair.a, pair.b}, dice);
        EXPECT_NEAR(pairFactor(turned[0], turned[1], {}, kReferenceAccuracy).ab, f.ab, 1e-9 * f.ab + 1e-18) << k;
        // The kernel of the bake, written apart from this one, says the same within what it promises.
        const std::vector<Ring3> a{pair.a}, b{pair.b};
        EXPECT_NEAR(exchange(planarShape(a), planarShape(b)) / areaA, f.ab,
                    1e-4 * f.ab + 1e-8 * std::min(1.0, areaB / areaA))
            << k;
    }
}

TEST(PairFactor, EstimatesHoldAtEveryAccuracy)
{
    Random dice(8);
    double worst = 0.0;
    for (int k = 0; k < 60; ++k) {
        const PairRings pair = randomPair(dice);
        const PairFactor exact = pairFactor(pair.a, pair.b, {}, kReferenceAccuracy);
        if (exact.ab == 0.0) continue;
        for (const double asked : {1e-1, 1e-2, 1e-4, 1e-6}) {
            const PairFactor f = pairFactor(pair.a, pair.b, {}, {asked});
            EXPECT_LE(f.error, asked * 1.000001) << k;
            worst = std::max(worst, relative(f.ab, exact.ab) / (f.error + exact.error));
        }
    }
    EXPECT_LE(worst, 1.5);
}

TEST(PairFactor, EndlessCanyonsByCrossedStrings)
{
    // C01, C02: strips 1e6 long stand for endless ones; their ends change F by about 1e-6.
    for (const auto& [height, expected] : {std::pair{1.0, std::sqrt(2.0) - 1.0}, {0.5, (std::sqrt(5.0) - 1.0) / 2.0}}) {
        const PairRings strips = opposed(0, 1, 0, 1e6, height, 0, 1, 0, 1e6);
        EXPECT_LT(relative(pairFactor(strips.a, strips.b, {}).ab, expected), 5e-6);
    }
}
