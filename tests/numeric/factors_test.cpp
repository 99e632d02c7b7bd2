// SPDX-License-Identifier: Apache-2.0
// Form factors of pairs against the table tests/data/closed_forms/formfactors.csv, against closed forms (Howell's
// catalogue: C-1, C-13, C-15), and against what must hold for every pair.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <numbers>
#include <tuple>

#include "city/light/form_factor.h"
#include "city/light/pair_factor.h"
#include "tests/numeric/factor_rows.h"

using namespace helio;
using namespace helio::test;

namespace {

/// The table's pairs without occluders.
std::vector<FactorRow> openRows()
{
    std::vector<FactorRow> rows = factorRows(HELIO_TEST_DATA);
    std::erase_if(rows, [](const FactorRow& row) { return !row.occluders.empty(); });
    return rows;
}

/// Of F, from corners that no double holds: those of U01 stand on a grid of 1e-9 m, those of R03 and R04 have a sine
/// that loses digits.
double roundingOf(const FactorRow& row)
{
    return row.id == "U01" ? 2e-8 : 1e-13;
}

double relative(double value, double expected)
{
    return std::abs(value - expected) / expected;
}

} // namespace

TEST(PairFactor, PlanarRowsInBothAccuracies)
{
    for (const FactorRow& row : openRows()) {
        for (const auto& [accuracy, bound] : {std::pair{kProductionAccuracy, 1e-4}, {kReferenceAccuracy, 1e-9}}) {
            const PairFactor f = pairFactor(row.pair.a, row.pair.b, {}, accuracy);
            EXPECT_LT(relative(f.ab, row.ab), std::max(bound, roundingOf(row))) << row.id;
            EXPECT_LT(relative(f.ba, row.ba), std::max(bound, roundingOf(row))) << row.id;
            EXPECT_LT(f.error, bound / 10) << row.id;
            EXPECT_EQ(f.visibility, 1.0);
            EXPECT_GT(f.evaluations, 0u);
            // The estimate holds.
            EXPECT_LE(relative(f.ab, row.ab), 2.0 * f.error + roundingOf(row)) << row.id;
        }
    }
}

TEST(PairFactor, TheSameAtMapCoordinates)
{
    for (const FactorRow& row : openRows()) {
        const glm::dvec3 map(5e5, 4.5e6, 300.0);
        const PairFactor f = pairFactor(moved(row.pair.a, map), moved(row.pair.b, map), {});
        EXPECT_LT(relative(f.ab, row.ab), 1e-6) << row.id;
        EXPECT_LT(relative(f.ba, row.ba), 1e-6) << row.id;
    }
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

TEST(PairFactor, ConvexPolygonsInPartsTurnedAndMoved)
{
    // Polygons with corners on an ellipse, cut along a diagonal, both at once: four parts make the whole.
    Random dice(12);
    const auto convexRing = [&](double size) {
        const u32 n = 4 + u32(6 * dice.uniform());
        const double flat = 0.2 + dice.uniform();
        Ring3 ring;
        for (u32 k = 0; k < n; ++k) {
            const double angle = (k + 0.7 * dice.uniform()) * 2.0 * std::numbers::pi / n;
            ring.push_back({size * std::cos(angle), size * flat * std::sin(angle), 0.0});
        }
        return turnedAll({ring}, dice)[0];
    };
    const auto halves = [](const Ring3& ring) {
        const auto middle = ring.begin() + std::ptrdiff_t(ring.size() / 2);
        Ring3 first(ring.begin(), middle + 1), second(middle, ring.end());
        second.push_back(ring.front());
        return std::array{first, second};
    };
    for (int k = 0; k < 30; ++k) {
        PairRings pair{convexRing(1.0), convexRing(std::pow(10.0, 2.0 * dice.uniform() - 1.0))};
        const glm::dvec3 away = std::pow(10.0, 2.0 * dice.uniform() - 0.5) *
                                glm::normalize(glm::dvec3(dice.uniform() - .5, dice.uniform() - .5, dice.uniform()));
        pair.b = moved(pair.b, away);
        if (glm::dot(vectorArea(pair.a), away) < 0.0) std::reverse(pair.a.begin(), pair.a.end());
        if (glm::dot(vectorArea(pair.b), away) > 0.0) std::reverse(pair.b.begin(), pair.b.end());
        const double areaA = planarShape({{pair.a}}).area;
        const double whole = areaA * pairFactor(pair.a, pair.b, {}, kReferenceAccuracy).ab;
        double parts = 0.0;
        for (const Ring3& a : halves(pair.a))
            for (const Ring3& b : halves(pair.b))
                parts += planarShape({{a}}).area * pairFactor(a, b, {}, kReferenceAccuracy).ab;
        EXPECT_NEAR(parts, whole, 1e-9 * whole + 1e-18) << k;
        const std::vector<Ring3> turned = turnedAll({pair.a, pair.b}, dice);
        const glm::dvec3 map(5e5, 4.5e6, 100.0);
        EXPECT_NEAR(areaA * pairFactor(turned[0], turned[1], {}, kReferenceAccuracy).ab, whole, 1e-9 * whole + 1e-18);
        EXPECT_NEAR(areaA * pairFactor(moved(pair.a, map), moved(pair.b, map), {}).ab, whole, 1e-6 * whole + 1e-9) << k;
    }
}

TEST(PairFactor, TheBakesKernelKeepsItsWord)
{
    // exchange() on rectangles and triangles, far, near and through each other.
    Random dice(5);
    const auto point = [&] { return glm::dvec3(dice.uniform() - .5, dice.uniform() - .5, dice.uniform() - .5); };
    double relativeWorst = 0.0, absoluteWorst = 0.0;
    u32 crossing = 0;
    for (int k = 0; k < 1500; ++k) {
        const auto ring = [&](const glm::dvec3& at, double size) {
            const glm::dvec3 u = size * point(), across = glm::cross(u, point());
            const glm::dvec3 v = size * (0.3 + dice.uniform()) * glm::normalize(across);
            return k % 2 == 0 ? Ring3{at, at + u, at + u + v, at + v} : Ring3{at, at + u, at + v};
        };
        PairRings pair{ring(point(), 1.0), {}};
        pair.b = ring(2.0 * std::pow(10.0, 2.0 * dice.uniform()) * point(), std::pow(10.0, 2.0 * dice.uniform() - 0.5));
        const glm::dvec3 away = pair.b[0] - pair.a[0];
        if (glm::dot(vectorArea(pair.a), away) < 0.0) std::reverse(pair.a.begin(), pair.a.end());
        if (glm::dot(vectorArea(pair.b), away) > 0.0) std::reverse(pair.b.begin(), pair.b.end());
        const PairFactor exact = pairFactor(pair.a, pair.b, {}, kReferenceAccuracy);
        const std::vector<Ring3> a{pair.a}, b{pair.b};
        const PlanarShape shapeA = planarShape(a), shapeB = planarShape(b);
        const double small = std::min(shapeA.area, shapeB.area), value = exchange(shapeA, shapeB) / small,
                     expected = std::max(exact.ab, exact.ba);
        if (expected > 1e-4)
            relativeWorst = std::max(relativeWorst, relative(value, expected));
        else
            absoluteWorst = std::max(absoluteWorst, std::abs(value - expected));
        const auto cuts = [](const PlanarShape& plane, const Ring3& other) {
            const auto before = [&](const glm::dvec3& c) { return glm::dot(plane.normal, c - plane.centroid) > 0.0; };
            return std::any_of(other.begin(), other.end(), before) && !std::all_of(other.begin(), other.end(), before);
        };
        crossing += expected > 1e-4 && cuts(shapeA, pair.b) && cuts(shapeB, pair.a);
    }
    std::printf("exchange(): relative error %.1e, absolute %.1e at most\n", relativeWorst, absoluteWorst);
    EXPECT_LT(relativeWorst, 3e-3);
    EXPECT_LT(absoluteWorst, 2e-7);
    EXPECT_GT(crossing, 20u) << "pairs that cut each other's planes are to be among them";
}

TEST(PairFactor, TheBakesKernelOnRectanglesThroughEachOther)
{
    // As the walls of buildings that stand in each other: edges end on edges, at any angle.
    Random dice(6);
    const auto point = [&] { return glm::dvec3(dice.uniform() - .5, dice.uniform() - .5, dice.uniform() - .5); };
    double worst = 0.0;
    u32 seen = 0;
    for (int k = 0; k < 600; ++k) {
        const auto rectangle = [&] {
            const glm::dvec3 middle = 0.5 * point(), u = point(), n = glm::normalize(glm::cross(u, point()));
            const glm::dvec3 v = (0.3 + dice.uniform()) * glm::cross(n, u);
            return Ring3{middle - u - v, middle + u - v, middle + u + v, middle - u + v};
        };
        const std::vector<Ring3> a{rectangle()}, b{rectangle()};
        const PlanarShape shapeA = planarShape(a), shapeB = planarShape(b);
        const double expected = pairFactor(a[0], b[0], {}, kReferenceAccuracy).ab;
        if (expected < 1e-4) continue;
        ++seen;
        worst = std::max(worst, relative(exchange(shapeA, shapeB) / shapeA.area, expected));
    }
    std::printf("exchange(): relative error %.1e at most in %u pairs\n", worst, seen);
    EXPECT_GT(seen, 300u);
    EXPECT_LT(worst, 3e-3);
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
    // Strips that are long stand for endless ones: their ends change F by about width over length.
    for (const auto& [id, height] : {std::pair{"C01", 1.0}, {"C02", 0.5}}) {
        const double expected = factorOf(HELIO_TEST_DATA, id);
        for (const double length : {1e6, 1e10}) {
            const PairRings strips = opposed(0, 1, 0, length, height, 0, 1, 0, length);
            for (const auto& [accuracy, bound] : {std::pair{kProductionAccuracy, 1e-4}, {kReferenceAccuracy, 1e-9}})
                EXPECT_LT(relative(pairFactor(strips.a, strips.b, {}, accuracy).ab, expected),
                          std::max(length < 1e7 ? 5e-6 : 0.0, bound))
                    << id << " " << length;
        }
    }
}

TEST(PairFactor, PointsOfTheTable)
{
    const glm::dvec3 o(0.0), up(0, 0, 1);
    const auto ceiling = [](double x0, double x1, double y0, double y1, double z) {
        return std::vector<Ring3>{{{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}}};
    };
    const std::vector<Ring3> wall{{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}},
        half{{{1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {1, 1, -1}}};
    const std::tuple<const char*, glm::dvec3, std::vector<Ring3>> rows[] = {{"D01", o, ceiling(0, 1, 0, 1, 1)},
                                                                            {"D02", {1, 0, 0}, wall},
                                                                            {"D03", o, ceiling(0, .5, 0, .5, 1e-6)},
                                                                            {"D04", o, half},
                                                                            {"C03", o, ceiling(-10, 10, -10, 10, 15)}};
    for (const auto& [id, point, rings] : rows)
        EXPECT_LT(relative(pointFactor(point, up, rings), factorOf(HELIO_TEST_DATA, id)), 1e-12) << id;
}
