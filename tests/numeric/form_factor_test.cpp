// SPDX-License-Identifier: Apache-2.0
// The kernel against values of closed forms and of an independent high-precision evaluation (50 digits and more; names
// are the rows of that table).
#include "city/light/form_factor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "city/base/hash.h"

using namespace helio;

namespace {

Ring3 horizontal(double x0, double x1, double y0, double y1, double z, bool facesUp)
{
    Ring3 ring{{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
    if (!facesUp) std::reverse(ring.begin(), ring.end());
    return ring;
}

/// In the plane x = 0, facing +x.
Ring3 vertical(double z0, double z1, double y0, double y1)
{
    return {{0, y0, z0}, {0, y1, z0}, {0, y1, z1}, {0, y0, z1}};
}

using Rings = std::vector<Ring3>;

double factor(const Rings& a, const Rings& b)
{
    return exchange(planarShape(a), planarShape(b)) / planarShape(a).area;
}

struct Opposed // R1 at z = 0 facing up, R2 at z facing down
{
    const char* name;
    double x0, x1, y0, y1, z, u0, u1, v0, v1, expected, tolerance;
};
struct Perpendicular // R1 at z = 0 facing up, R2 at x = 0 facing +x
{
    const char* name;
    double x0, x1, y0, y1, z0, z1, v0, v1, expected;
};
struct Hinged // w1 x l and w2 x l sharing an edge of length l, angle between them in degrees
{
    const char* name;
    double w1, w2, l, angle, expected, tolerance;
};

} // namespace

TEST(FormFactor, OpposedRectangles)
{
    const Opposed cases[] = {
        {"P01 cube", 0, 1, 0, 1, 1, 0, 1, 0, 1, 0.19982489569838738304, 1e-6},
        {"P02 near", .1, .2, .1, .2, .05, .1, .2, .1, .2, 0.41525328357714673537, 1e-5},
        {"P03 facades", 0, 100, 0, 20, 15, 0, 100, 0, 20, 0.44850431100919077733, 1e-9},
        {"P04 windows", 0, 1.5, 0, 1.2, 12, 7.3, 8.5, 4.1, 5.6, 0.0018150826747763339745, 1e-5},
        {"P06 gap 1e-3", 0, 1, 0, 1, 1e-3, 0, 1, 0, 1, 0.998005631907579727, 1e-9},
        {"P07 gap 1e-6", 0, 1, 0, 1, 1e-6, 0, 1, 0, 1, 0.99999800001002952124, 1e-9},
        {"P08 size ratio 1e6", -.0005, .0005, -.0005, .0005, 10, -500, 500, -500, 500, 0.99967278693644750938, 1e-8},
        {"P10 1 m2 at 1 km", 0, 1, 0, 1, 1000, 0, 1, 0, 1, 3.1830967397738025777e-7, 1e-8},
        {"P11 250 m", 0, 3, 0, 3, 250, 80, 83, 20, 23, 0.000037280321831181324085, 1e-8},
        {"P13 sliver to wall", 0, .001, 0, 100, 10, 0, 20, 0, 100, 0.4122027445176317486, 1e-8},
        {"P14 sliver to sliver", 0, .001, 0, 100, .001, 0, .001, 0, 100, 0.41421076872909668142, 1e-8}};
    for (const Opposed& c : cases) {
        const double f =
            factor({horizontal(c.x0, c.x1, c.y0, c.y1, 0, true)}, {horizontal(c.u0, c.u1, c.v0, c.v1, c.z, false)});
        EXPECT_NEAR(f / c.expected, 1.0, c.tolerance) << c.name;
    }
}

TEST(FormFactor, PerpendicularRectangles)
{
    const Perpendicular cases[] = {
        {"Q01 cube", 0, 1, 0, 1, 0, 1, 0, 1, 0.20004377607540315424},
        {"Q02 street and facade", 0, 15, 0, 100, 0, 20, 0, 100, 0.31182401037947633713},
        {"Q03 no shared edge", .5, 2, 0, 3, .25, 1.5, -1, 2.2, 0.11508156306669084315},
        {"Q05 1 mm strip at the foot", 0, 20, 0, 100, 0, .001, 0, 100, 0.000024998547641034433096},
        {"Q06 gap 1e-6", 1e-6, 1.000001, 0, 1, 0, 1, 0, 1, 0.20004334176022314416},
        {"Q07 one shared corner", 0, 1, 0, 1, 0, 1, 1, 2, 0.040592230101558542583},
        {"Q08 window and jamb", 0, 1.5, 0, 1.2, 0, .12, 0, 1.2, 0.034786082607169449728},
        {"Q10 far", 800, 801, 0, 1, 30, 31, 100, 101, 1.8296794040015112711e-8}};
    for (const Perpendicular& c : cases) {
        const double f = factor({horizontal(c.x0, c.x1, c.y0, c.y1, 0, true)}, {vertical(c.z0, c.z1, c.v0, c.v1)});
        EXPECT_NEAR(f / c.expected, 1.0, 1e-8) << c.name;
    }
}

TEST(FormFactor, HingedRectangles)
{
    const Hinged cases[] = {{"R01", 1, 1, 1, 60, 0.3709053211500514359, 1e-6},
                            {"R02", 1, 1, 1, 120, 0.086615001118276058831, 1e-6},
                            {"R06 roof and wall", 6, 20, 100, 150, 0.049536318042533995489, 1e-6},
                            // Nearly in one plane: terms of order 1 cancel, an absolute error of 3e-9 is left.
                            {"R03", 1, 1, 1, 179, 0.000023608783114983361582, 2e-4},
                            {"R04", 1, 1, 1, 179.9, 2.3608665446788677202e-7, 2e-2}};
    for (const Hinged& c : cases) {
        const double angle = c.angle * std::numbers::pi / 180.0, x = c.w2 * std::cos(angle), z = c.w2 * std::sin(angle);
        const double f =
            factor({horizontal(0, c.w1, 0, c.l, 0, true)}, {{{0, 0, 0}, {0, c.l, 0}, {x, c.l, z}, {x, 0, z}}});
        EXPECT_NEAR(f / c.expected, 1.0, c.tolerance) << c.name;
    }
}

TEST(FormFactor, TrianglesConcaveAndCutPolygons)
{
    const Rings small{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, large{{{0, 0, 1}, {0, 2, 1}, {2, 0, 1}}};
    EXPECT_NEAR(factor(small, large) / 0.28431252098946008575, 1.0, 1e-6) << "S01";
    const Rings ell{{{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}};
    EXPECT_NEAR(factor(ell, {horizontal(0, 2, 0, 2, 2, false)}) / 0.16798876529848359182, 1.0, 1e-6) << "S03";
    // Half of the ground lies behind the wall and must not count.
    EXPECT_NEAR(factor({horizontal(-5, 5, 0, 10, 0, true)}, {vertical(0, 8, 0, 10)}) / 0.1396560017209588, 1.0, 1e-8)
        << "H01";
}

TEST(FormFactor, HolesAndSeveralOuterRingsAreSubtractedAndAdded)
{
    const Ring3 outer = horizontal(0, 4, 0, 4, 0, true), inner = horizontal(1, 2, 1, 3, 0, true);
    Ring3 hole = inner;
    std::reverse(hole.begin(), hole.end());
    for (const double z : {0.5, 3.0, 40.0}) {
        const Rings other{horizontal(-1, 3, 0, 2, z, false)};
        const auto with = [&](const Rings& rings) { return exchange(planarShape(rings), planarShape(other)); };
        EXPECT_NEAR(with({outer, hole}), with({outer}) - with({inner}), 1e-5 * with({outer})) << z;
        EXPECT_NEAR(with({inner, horizontal(6, 7, 0, 1, 0, true)}),
                    with({inner}) + with({horizontal(6, 7, 0, 1, 0, true)}), 1e-5 * with({inner}))
            << z;
    }
}

TEST(FormFactor, OneSidedAndNeverNegative)
{
    const Rings up{horizontal(0, 1, 0, 1, 0, true)}, down{horizontal(0, 1, 0, 1, 1, false)},
        upAbove{horizontal(0, 1, 0, 1, 1, true)};
    EXPECT_GT(factor(up, down), 0.19);
    EXPECT_EQ(factor(up, upAbove), 0.0);
    EXPECT_EQ(factor(up, {horizontal(2, 3, 0, 1, 0, true)}), 0.0) << "same plane";
    EXPECT_EQ(factor(up, {horizontal(0, 1, 0, 1, 0, true)}), 0.0) << "itself";
    EXPECT_EQ(factor(up, {horizontal(0, 1, 0, 0, 1, false)}), 0.0) << "no area";
    EXPECT_EQ(pointFactor({0.5, 0.5, 2.0}, {0, 0, -1}, down), 0.0) << "from behind";
}

TEST(FormFactor, SymmetricAndTheSameFarFromTheOrigin)
{
    Random random(7);
    const auto point = [&] { return glm::dvec3(random.uniform(), random.uniform(), random.uniform()); };
    const glm::dvec3 utm(5e5, 4.5e6, 200.0);
    int seen = 0;
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 a = 20.0 * point(), u = 4.0 * (point() - 0.5), v = 4.0 * (point() - 0.5);
        const glm::dvec3 b = 20.0 * point(), s = 4.0 * (point() - 0.5), t = 4.0 * (point() - 0.5);
        Rings first{{a, a + u, a + u + v, a + v}}, second{{b, b + s, b + t}};
        const double here = exchange(planarShape(first), planarShape(second));
        EXPECT_EQ(here, exchange(planarShape(second), planarShape(first)));
        for (Rings* rings : {&first, &second})
            for (glm::dvec3& corner : (*rings)[0]) corner += utm;
        // Corners move by rounding to 1e-9 m there.
        EXPECT_NEAR(exchange(planarShape(first), planarShape(second)), here, 1e-6 * here + 1e-9);
        seen += here > 0.0;
    }
    EXPECT_GT(seen, 30);
    const Rings a{horizontal(0, 1.5, 0, 1.2, 0, true)}, b{horizontal(7.3, 8.5, 4.1, 5.6, 12, false)};
    Rings farA = a, farB = b;
    for (Rings* rings : {&farA, &farB})
        for (glm::dvec3& corner : (*rings)[0]) corner += glm::dvec3(5e5, 4.5e6, 0.0);
    EXPECT_NEAR(factor(farA, farB) / 0.0018150826747763339745, 1.0, 1e-5) << "U01; in float the answer is 1.1 % off";
}

TEST(FormFactor, PartsAddUp)
{
    // The same transfer by the near and by the far rules: a wall as one piece and as 8 x 8.
    for (const double distance : {0.01, 1.0, 3.0, 12.0}) {
        const Rings ground{horizontal(distance, distance + 4, 0, 6, 0, true)};
        double sum = 0.0;
        for (int i = 0; i < 8; ++i)
            for (int j = 0; j < 8; ++j)
                sum += exchange(planarShape(ground),
                                planarShape(Rings{vertical(0.5 * i, 0.5 * i + 0.5, 0.75 * j, 0.75 * j + 0.75)}));
        const double whole = exchange(planarShape(ground), planarShape(Rings{vertical(0, 4, 0, 6)}));
        EXPECT_NEAR(sum / whole, 1.0, 1e-5) << distance;
    }
}

TEST(FormFactor, PointToPolygon)
{
    const glm::dvec3 o(0.0), up(0, 0, 1);
    EXPECT_NEAR(pointFactor(o, up, Rings{horizontal(0, 1, 0, 1, 1, false)}), 0.138531605994893, 1e-14) << "D01";
    EXPECT_NEAR(pointFactor({1, 0, 0}, up, Rings{vertical(0, 1, 0, 1)}), 0.0557341970025535, 1e-14) << "D02";
    EXPECT_NEAR(pointFactor(o, up, Rings{horizontal(0, .5, 0, .5, 1e-6, false)}), 0.2499999999991817, 1e-13) << "D03";
    // Straddles the horizon: the lower half is cut off. The same square from every corner it can begin with.
    Ring3 square{{1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {1, 1, -1}};
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(pointFactor(o, up, Rings{square}), 0.111468394005107, 1e-14) << "D04, corner " << i;
        std::rotate(square.begin(), square.begin() + 1, square.end());
    }
    // Sky over the centre of a 20 x 20 m courtyard with walls of 15 m (C03).
    EXPECT_NEAR(pointFactor(o, up, Rings{horizontal(-10, 10, -10, 10, 15, false)}), 0.3576847466302562, 1e-13);
}
