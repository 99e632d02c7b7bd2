// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "city/model/convex_hull.h"
#include "city/model/polygon.h"
#include "city/model/triangulate.h"

using namespace helio;

namespace {

double areaOf(const Polygon2& polygon)
{
    std::vector<glm::dvec2> p(polygon.outer);
    for (const Ring2& hole : polygon.holes) p.insert(p.end(), hole.begin(), hole.end());
    double sum = 0.0;
    for (const auto& t : triangulate(polygon)) {
        const double a = signedArea(std::vector{p[t[0]], p[t[1]], p[t[2]]});
        EXPECT_GT(a, 0.0);
        sum += a;
    }
    return sum;
}

Ring2 square(double x, double y, double size, bool clockwise)
{
    Ring2 ring{{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}};
    if (clockwise) std::reverse(ring.begin(), ring.end());
    return ring;
}

} // namespace

TEST(Polygon, SignedAreaKeepsItsDigitsFarFromTheOrigin)
{
    EXPECT_NEAR(signedArea(square(5e5, 4.5e6, 0.125, false)), 0.015625, 1e-12);
    EXPECT_NEAR(signedArea(square(5e5, 4.5e6, 0.125, true)), -0.015625, 1e-12);
}

TEST(Polygon, CentroidOfASquareWithAHole)
{
    // 4 x 4 square with a 2 x 2 hole in its right half: x = (16 * 2 - 4 * 3) / 12.
    Polygon3 p{{{0, 0, 1}, {4, 0, 1}, {4, 4, 1}, {0, 4, 1}}, {{{2, 1, 1}, {2, 3, 1}, {4, 3, 1}, {4, 1, 1}}}};
    EXPECT_NEAR(area(p), 12.0, 1e-12);
    EXPECT_NEAR(centroid(p).x, 20.0 / 12.0, 1e-12);
    EXPECT_NEAR(centroid(p).y, 2.0, 1e-12);
    EXPECT_NEAR(centroid(p).z, 1.0, 1e-12);
    EXPECT_EQ(unitNormal(p), glm::dvec3(0, 0, 1));
}

TEST(Polygon, PlaneFrameIsRightHanded)
{
    for (const glm::dvec3 n :
         {glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1), glm::dvec3(1, 0, 0), glm::normalize(glm::dvec3(1, -2, 3))}) {
        const PlaneFrame f = planeFrame(n);
        EXPECT_NEAR(glm::length(glm::cross(f.u, f.v) - n), 0.0, 1e-12);
    }
}

TEST(Triangulate, ConcaveOutline)
{
    EXPECT_NEAR(areaOf({{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}}, {}}), 6.0, 1e-12);
}

TEST(Triangulate, HolesWhicheverWayTheyRun)
{
    for (const bool clockwise : {true, false}) {
        Polygon2 p{square(0, 0, 10, false),
                   {square(1, 1, 2, clockwise), square(5, 5, 3, clockwise), square(1, 6, 2, clockwise)}};
        EXPECT_NEAR(areaOf(p), 100.0 - 4.0 - 9.0 - 4.0, 1e-9);
    }
}

TEST(Triangulate, HolesInARowShareOneBridgeLine)
{
    Polygon2 p{square(0, 0, 10, false), {}};
    for (int i = 0; i < 4; ++i) p.holes.push_back(square(0.5 + 2.25 * i, 4, 1.5, true));
    EXPECT_NEAR(areaOf(p), 100.0 - 4 * 2.25, 1e-9);
}

TEST(Triangulate, CollinearCornersAndBowTiesEnd)
{
    EXPECT_NEAR(areaOf({{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}}, {}}), 4.0, 1e-12);
    EXPECT_LE(triangulate(Polygon2{{{0, 0}, {2, 2}, {2, 0}, {0, 2}}, {}}).size(), 2u);
    EXPECT_TRUE(triangulate(Polygon2{{{0, 0}, {1, 1}}, {}}).empty());
}

TEST(ConvexHull, DropsInnerAndCollinearPoints)
{
    const std::vector<glm::dvec2> points{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}, {0, 1}};
    const Ring2 hull = convexHull(points);
    EXPECT_EQ(hull.size(), 4u);
    EXPECT_NEAR(signedArea(hull), 4.0, 1e-12);
}

TEST(Polygon, CrossIsTwiceTheAreaOfTheTriangle)
{
    EXPECT_EQ(cross(glm::dvec2(2, 0), glm::dvec2(1, 3)), 6.0);
    EXPECT_EQ(cross(glm::dvec2(1, 3), glm::dvec2(2, 0)), -6.0);
    EXPECT_EQ(cross(glm::dvec2(5, 5), glm::dvec2(7, 5), glm::dvec2(6, 8)), 6.0);
}

TEST(Polygon, ContainsGoesByEvenAndOdd)
{
    const Ring2 angle = {{0, 0}, {4, 0}, {4, 4}, {3, 4}, {3, 1}, {0, 1}};
    EXPECT_TRUE(contains(angle, {0.5, 0.5}));
    EXPECT_TRUE(contains(angle, {3.5, 3.5}));
    EXPECT_FALSE(contains(angle, {1, 3}));
    EXPECT_FALSE(contains(angle, {5, 0.5}));
    EXPECT_FALSE(contains(angle, {-1, 0.5}));
}

TEST(IsInside, HoldsOnPlanesAtFortyFiveDegreesToTheAxes)
{
    // Two coordinates of the normal are equal there: the coordinate plane must still have two different axes.
    const double s = std::sqrt(0.5), t = std::sqrt(1.0 / 3.0);
    for (const glm::dvec3& normal :
         {glm::dvec3(s, 0, s), glm::dvec3(-s, 0, s), glm::dvec3(s, s, 0), glm::dvec3(0, s, s), glm::dvec3(t, t, t),
          glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0)}) {
        const PlaneFrame frame = planeFrame(normal);
        const auto at = [&](double u, double v) { return u * frame.u + v * frame.v; };
        const Ring3 square{at(-1, -1), at(1, -1), at(1, 1), at(-1, 1)};
        const Ring3 hole{at(0, 0), at(0, 0.5), at(0.5, 0.5), at(0.5, 0)};
        const std::vector<Ring3> rings{square, hole};
        EXPECT_TRUE(isInside(at(-0.5, -0.4), rings, normal));
        EXPECT_TRUE(isInside(at(0.9, 0.8), rings, normal));
        EXPECT_FALSE(isInside(at(0.2, 0.3), rings, normal)) << "in the hole";
        EXPECT_FALSE(isInside(at(1.2, 0.3), rings, normal));
        EXPECT_FALSE(isInside(at(0.3, -1.1), rings, normal));
    }
}
