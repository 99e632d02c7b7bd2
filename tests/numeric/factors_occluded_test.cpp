// SPDX-License-Identifier: Apache-2.0
// Visibility between pairs of polygons: closed forms and values of others where there are any, else what must hold.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "city/light/pair_factor.h"
#include "tests/numeric/pair_fixtures.h"

using namespace helio;
using namespace helio::test;

namespace {

Ring3 plate(double x0, double x1, double y0, double y1, double z)
{
    return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

const PairRings kCube = opposed(0, 1, 0, 1, 1, 0, 1, 0, 1);

double seen(const PairFactor& f)
{
    return f.ab * f.visibility;
}

} // namespace

TEST(PairVisibility, OccludedRows)
{
    // V01 and V04: two-dimensional quadrature of the exact visible rectangle, 18 and 20 digits; V04 also as published
    // by Walton (NISTIR 6925), 0.11562061.
    for (const auto& [z, expected] : {std::pair{0.5, 0.09950629459898479}, {0.75, 0.115620602132415}}) {
        for (const glm::dvec3& offset : {glm::dvec3(0.0), glm::dvec3(5e5, 4.5e6, 200.0)}) {
            const std::vector<Ring3> blocker{moved(plate(.25, .75, .25, .75, z), offset)};
            const Ring3 a = moved(kCube.a, offset), b = moved(kCube.b, offset);
            const double rounding = offset.x > 0.0 ? 1e-8 : 0.0;
            const PairFactor f = pairFactor(a, b, blocker);
            EXPECT_NEAR(seen(f), expected, 1e-5 * expected) << z;
            EXPECT_LE(std::abs(seen(f) - expected), f.ab * f.error + rounding) << z;
            const PairFactor g = pairFactor(a, b, blocker, kReferenceAccuracy);
            EXPECT_NEAR(seen(g), expected, (1e-8 + rounding) * expected) << z;
            EXPECT_LE(std::abs(seen(g) - expected), g.ab * g.error + rounding) << z;
            EXPECT_EQ(seen(pairFactor(b, a, blocker)), seen(f)) << "reciprocity";
        }
    }
}

TEST(PairVisibility, EndlessPlatesByCrossedStrings)
{
    // V03: plates 2 wide and 2 apart, a blocker 1 wide half-way, F = sqrt(1.25) - 1; 1e5 long, whose ends change F by
    // some 1e-5.
    const PairRings plates = opposed(-1, 1, 0, 1e5, 2, -1, 1, 0, 1e5);
    const std::vector<Ring3> blocker{plate(-.5, .5, 0, 1e5, 1)};
    const PairFactor f = pairFactor(plates.a, plates.b, blocker);
    EXPECT_NEAR(seen(f), std::sqrt(1.25) - 1.0, 1e-4 * (std::sqrt(1.25) - 1.0));
    EXPECT_LT(f.error, 1e-4);
}

TEST(PairVisibility, WallOnTheReceiverDividesTheRoom)
{
    // A wall from floor to ceiling leaves two cubes of a 2 x 1 x 1 room.
    const PairRings room = opposed(0, 2, 0, 1, 1, 0, 2, 0, 1);
    const Ring3 wall{{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}};
    const PairFactor f = pairFactor(room.a, room.b, {{wall}});
    EXPECT_NEAR(seen(f), 0.19982489569838738304, 1e-5 * 0.2);
    EXPECT_NEAR(f.ab, closedOpposed(0, 2, 0, 1, 1, 0, 2, 0, 1), 1e-9);
}

TEST(PairVisibility, FullCoverNothingBetweenAndInPlane)
{
    EXPECT_EQ(pairFactor(kCube.a, kCube.b, {{plate(-9, 9, -9, 9, .5)}}).visibility, 0.0);
    EXPECT_EQ(pairFactor(kCube.a, kCube.b, {{plate(0, 1, 0, 1, .999)}}).visibility, 0.0);
    const std::vector<Ring3> elsewhere{plate(0, 1, 0, 1, 1.5), plate(0, 1, 0, 1, -.5),
                                       plate(3, 4, 0, 1, .5),  plate(0, 1, 0, 1, 0),
                                       plate(0, 1, 0, 1, 1),   {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}},
                                       plate(.5, .5, 0, 1, .5)};
    for (const Ring3& occluder : elsewhere)
        EXPECT_EQ(pairFactor(kCube.a, kCube.b, {{occluder}}).visibility, 1.0) << &occluder - elsewhere.data();
    // Seen edge-on by all that matters: a fin that stands across takes some, never all.
    const PairFactor fin = pairFactor(kCube.a, kCube.b, {{{{.5, 0, .4}, {.5, 1, .4}, {.5, 1, .6}, {.5, 0, .6}}}});
    EXPECT_TRUE(fin.visibility > 0.8 && fin.visibility < 1.0);
}

TEST(PairVisibility, PartsOfACoverBlockWhatTheWholeDoes)
{
    // A concave piece of a screen and its complement: what one lets through the other blocks.
    const Ring3 corner{{-9, -9, .4}, {9, -9, .4}, {9, .3, .4}, {.6, .3, .4}, {.6, 9, .4}, {-9, 9, .4}};
    const Ring3 rest = plate(.6, 9, .3, 9, .4);
    const PairFactor first = pairFactor(kCube.a, kCube.b, {{corner}}), second = pairFactor(kCube.a, kCube.b, {{rest}});
    EXPECT_NEAR(first.visibility + second.visibility, 1.0, 2e-5);
    EXPECT_LE(std::abs(first.visibility + second.visibility - 1.0), first.error + second.error);
    EXPECT_NEAR(pairFactor(kCube.a, kCube.b, {{corner, rest}}).visibility, 0.0, 1e-14);
    // Twice the same, or turned over, blocks no more than once.
    const Ring3 turned(rest.rbegin(), rest.rend());
    EXPECT_NEAR(pairFactor(kCube.a, kCube.b, {{rest, turned, rest}}).visibility, second.visibility, 2e-5);
}

TEST(PairVisibility, RandomOccludersKeepTheLaws)
{
    Random dice(21);
    u32 partial = 0;
    for (int k = 0; k < 9; ++k) {
        PairRings pair = randomPair(dice);
        const glm::dvec3 middle = 0.5 * (pair.a[0] + pair.b[1]);
        const Ring3 blocker = moved(randomRing(dice), middle);
        const PairFactor f = pairFactor(pair.a, pair.b, {{blocker}});
        ASSERT_TRUE(f.visibility >= 0.0 && f.visibility <= 1.0) << k;
        partial += f.visibility > 0.01 && f.visibility < 0.99;
        // The occluder in parts, everything turned, more exactly: the same within the estimates.
        const PairFactor parts = pairFactor(pair.a, pair.b, trianglesOf(blocker));
        EXPECT_NEAR(parts.visibility, f.visibility, 2.0 * (f.error + parts.error) + 1e-12) << k;
        const std::vector<Ring3> turned = turnedAll({pair.a, pair.b, blocker}, dice);
        const PairFactor spun = pairFactor(turned[0], turned[1], {{turned[2]}});
        EXPECT_NEAR(spun.visibility, f.visibility, 2.0 * (f.error + spun.error) + 1e-12) << k;
        const PairFactor fine = pairFactor(pair.a, pair.b, {{blocker}}, {1e-9, 1e-5});
        EXPECT_NEAR(fine.visibility, f.visibility, 1.5 * f.error + fine.error + 1e-12) << k;
    }
    EXPECT_GE(partial, 4u) << "the cases are to be of interest";
}

TEST(PairVisibility, TooIntricateAViewEndsAndSaysSo)
{
    std::vector<Ring3> slats;
    for (int k = 0; k < 100; ++k) {
        slats.push_back(plate(k * .01, k * .01 + .005, -1, 2, .5));
        slats.push_back(plate(-1, 2, k * .01, k * .01 + .005, .55));
    }
    const PairFactor f = pairFactor(kCube.a, kCube.b, slats, {1e-6, 3e-5, 100'000});
    EXPECT_EQ(f.error >= 1.0, true);
    EXPECT_TRUE(f.visibility >= 0.0 && f.visibility <= 1.0);
}
