// SPDX-License-Identifier: Apache-2.0
#include "city/geometry/offset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "city/base/hash.h"
#include "city/geometry/clip.h"

using namespace helio;

namespace {

// One grid step along every border is what rounding may cost.
constexpr double kGridArea = 2e-3;

Polygon2 rectangle(double width, double depth)
{
    return {{{0, 0}, {width, 0}, {width, depth}, {0, depth}}, {}};
}

// Edge 2 runs to the reflex corner, edge 3 from it.
Polygon2 lShape()
{
    return {{{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}}, {}};
}

Polygon2 ring()
{
    return {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{3, 3}, {3, 7}, {7, 7}, {7, 3}}}};
}

double totalArea(const std::vector<Polygon2>& polygons)
{
    double sum = 0.0;
    for (const Polygon2& polygon : polygons) sum += area(polygon);
    return sum;
}

std::map<u32, double> areaByEdge(const Setback& cut)
{
    std::map<u32, double> sums;
    for (const SetbackStrip& strip : cut.strips) sums[strip.edge] += area(strip.polygon);
    return sums;
}

void expectAreas(const Setback& cut, const std::map<u32, double>& strips, double remainder)
{
    const std::map<u32, double> sums = areaByEdge(cut);
    ASSERT_EQ(sums.size(), strips.size());
    for (const auto& [edge, expected] : strips) {
        ASSERT_TRUE(sums.contains(edge)) << edge;
        EXPECT_NEAR(sums.at(edge), expected, kGridArea) << "edge " << edge;
    }
    EXPECT_NEAR(totalArea(cut.remainder), remainder, kGridArea);
}

std::vector<double> same(size_t count, double width)
{
    return std::vector<double>(count, width);
}

TEST(OffsetPolygon, OfRectangles)
{
    EXPECT_NEAR(totalArea(offsetPolygon(rectangle(10, 6), -1)), 32, 1e-9);
    EXPECT_NEAR(totalArea(offsetPolygon(rectangle(10, 6), 1)), 96, 1e-9);
    EXPECT_NEAR(totalArea(offsetPolygon(rectangle(10, 6), 0)), 60, 1e-9);
    EXPECT_TRUE(offsetPolygon(rectangle(10, 6), -3).empty());
    EXPECT_TRUE(offsetPolygon(rectangle(10, 6), -1e9).empty());
}

TEST(OffsetPolygon, KeepsTheCornersOfATriangleSharp)
{
    // Corners of 60 degrees: the sides of an equilateral triangle grow by 2 sqrt(3) d.
    const double h = std::sqrt(3.0);
    const Polygon2 triangle{{{0, 0}, {2, 0}, {1, h}}, {}};
    const double side = 2.0 + 2.0 * h * 0.5;
    EXPECT_NEAR(totalArea(offsetPolygon(triangle, 0.5)), side * side * h / 4.0, kGridArea);
}

TEST(OffsetPolygon, OfAnLAndARing)
{
    EXPECT_NEAR(totalArea(offsetPolygon(lShape(), -0.5)), 5, 1e-9);
    EXPECT_NEAR(totalArea(offsetPolygon(lShape(), 0.5)), 25 - 4, 1e-9);
    const std::vector<Polygon2> thin = offsetPolygon(ring(), -1);
    ASSERT_EQ(thin.size(), 1u);
    EXPECT_EQ(thin[0].holes.size(), 1u);
    EXPECT_NEAR(area(thin[0]), 64 - 36, 1e-9);
    EXPECT_GT(signedArea(thin[0].outer), 0.0);
    EXPECT_LT(signedArea(thin[0].holes[0]), 0.0);
    const std::vector<Polygon2> filled = offsetPolygon(ring(), 2.5);
    ASSERT_EQ(filled.size(), 1u);
    EXPECT_TRUE(filled[0].holes.empty());
    EXPECT_NEAR(area(filled[0]), 225, 1e-9);
    EXPECT_TRUE(offsetPolygon(ring(), -1.6).empty());
}

TEST(OffsetPolygon, SplitsWhereItIsNarrow)
{
    // Two rooms of 4 x 4 with a neck of 2.
    const Polygon2 bell{
        {{0, 0}, {4, 0}, {4, 1}, {6, 1}, {6, 0}, {10, 0}, {10, 4}, {6, 4}, {6, 3}, {4, 3}, {4, 4}, {0, 4}}, {}};
    const std::vector<Polygon2> rooms = offsetPolygon(bell, -1.5);
    ASSERT_EQ(rooms.size(), 2u);
    EXPECT_NEAR(area(rooms[0]), 1, 1e-9);
    EXPECT_NEAR(area(rooms[1]), 1, 1e-9);
}

TEST(OffsetPolygon, OfWhatIsLargerThanTheGrid)
{
    Polygon2 large = rectangle(4e6, 2e6);
    for (glm::dvec2& corner : large.outer) corner += glm::dvec2(9e5, -3e7);
    EXPECT_NEAR(totalArea(offsetPolygon(large, -1e5)) / (3.8e6 * 1.8e6), 1.0, 1e-8);
    EXPECT_NEAR(totalArea(setback(large, same(4, 1e5)).remainder) / (3.8e6 * 1.8e6), 1.0, 1e-8);
}

TEST(Setback, DividesCornersByTheBisector)
{
    expectAreas(setback(rectangle(10, 6), same(4, 1)), {{0, 9}, {1, 5}, {2, 9}, {3, 5}}, 32);
}

TEST(Setback, TakesTheEdgesThatAreAskedFor)
{
    expectAreas(setback(rectangle(10, 6), std::vector<double>{2, 0, 0, 0}), {{0, 20}}, 40);
    // The mitre of unequal widths runs from (10, 0) to (8, 1).
    expectAreas(setback(rectangle(10, 6), std::vector<double>{1, 2, 0, 0}), {{0, 9}, {1, 11}}, 40);
    expectAreas(setback(rectangle(10, 6), same(4, 0)), {}, 60);
}

TEST(Setback, RunsAroundReflexCorners)
{
    expectAreas(setback(lShape(), same(6, 0.5)), {{0, 1.75}, {1, 0.75}, {2, 1}, {3, 1}, {4, 0.75}, {5, 1.75}}, 5);
    // Alone, the strip ends square at the reflex corner.
    expectAreas(setback(lShape(), std::vector<double>{0, 0, 0.5, 0, 0, 0}), {{2, 1}}, 11);
}

TEST(Setback, GoesAroundHoles)
{
    expectAreas(setback(ring(), std::vector<double>{0, 0, 0, 0, 1, 1, 1, 1}), {{4, 5}, {5, 5}, {6, 5}, {7, 5}}, 64);
    // 3 m between the rings, 2 m wanted from each side: they meet in the middle.
    expectAreas(setback(ring(), same(8, 2)),
                {{0, 12.75}, {1, 12.75}, {2, 12.75}, {3, 12.75}, {4, 8.25}, {5, 8.25}, {6, 8.25}, {7, 8.25}}, 0);
}

TEST(Setback, ConsumesThePolygon)
{
    // A hip roof over the rectangle, and the three parts of a triangle around its incircle of radius 1.
    expectAreas(setback(rectangle(10, 4), same(4, 50)), {{0, 16}, {1, 4}, {2, 16}, {3, 4}}, 0);
    const Polygon2 triangle{{{0, 0}, {4, 0}, {0, 3}}, {}};
    expectAreas(setback(triangle, same(3, 1e9)), {{0, 2}, {1, 2.5}, {2, 1.5}}, 0);
    // Opposite edges share by their widths, 6 : 2.
    expectAreas(setback(rectangle(10, 4), std::vector<double>{6, 0, 2, 0}), {{0, 30}, {2, 10}}, 0);
}

TEST(Setback, StaysInItsArmOfTheShape)
{
    // A U with a yard between x = 2 and x = 4. A strip of 5 from the upper part of the left arm's outer side would
    // reach over the yard into the right arm.
    const Polygon2 u{{{0, 0}, {6, 0}, {6, 5}, {4, 5}, {4, 2}, {2, 2}, {2, 5}, {0, 5}, {0, 3}}, {}};
    expectAreas(setback(u, std::vector<double>{0, 0, 0, 0, 0, 0, 0, 5, 0}), {{7, 4}}, 24 - 4);
}

TEST(Setback, BeginsEachStripOnItsEdgeAndKeepsTheCorners)
{
    // Corners off the grid come back exactly.
    Polygon2 polygon = lShape();
    const glm::dvec2 axis(std::cos(0.7), std::sin(0.7));
    for (glm::dvec2& p : polygon.outer) p = {axis.x * p.x - axis.y * p.y, axis.y * p.x + axis.x * p.y};
    const Setback cut = setback(polygon, same(6, 0.4));
    ASSERT_EQ(cut.strips.size(), 6u);
    for (const SetbackStrip& strip : cut.strips) {
        EXPECT_EQ(strip.polygon.outer[0], polygon.outer[strip.edge]);
        EXPECT_EQ(strip.polygon.outer[1], polygon.outer[(strip.edge + 1) % 6]);
    }
}

// A star-shaped polygon of 3 to 14 corners, often with a hole of the same kind.
Polygon2 randomPolygon(Random& random)
{
    const auto star = [&](u32 corners, double low, double high) {
        Ring2 corner;
        const double start = random.uniform();
        for (u32 k = 0; k < corners; ++k) {
            const double angle = 2.0 * M_PI * (start + k + 0.7 * random.uniform()) / corners;
            const double radius = low + (high - low) * random.uniform();
            corner.push_back(radius * glm::dvec2(std::cos(angle), std::sin(angle)));
        }
        return corner;
    };
    const u32 corners = 3 + u32(random.uniform() * 12);
    Polygon2 polygon{star(corners, corners < 5 ? 14.0 : 7.0, 20.0), {}};
    if (corners >= 5 && random.uniform() < 0.5) {
        // Corners at 7 m and more, at least 5 of them, less than 122 degrees apart: the border stays 3.3 m away.
        polygon.holes.push_back(star(3 + u32(random.uniform() * 4), 1.0, 2.5));
        std::reverse(polygon.holes[0].begin(), polygon.holes[0].end());
    }
    return polygon;
}

std::vector<std::pair<glm::dvec2, glm::dvec2>> edgesOf(const Polygon2& polygon)
{
    std::vector<std::pair<glm::dvec2, glm::dvec2>> edges;
    const auto add = [&](const Ring2& ring) {
        for (size_t k = 0; k < ring.size(); ++k) edges.emplace_back(ring[k], ring[(k + 1) % ring.size()]);
    };
    add(polygon.outer);
    for (const Ring2& hole : polygon.holes) add(hole);
    return edges;
}

bool isInside(const Polygon2& polygon, const glm::dvec2& point)
{
    return contains(polygon.outer, point) &&
           std::none_of(polygon.holes.begin(), polygon.holes.end(), [&](const Ring2& h) { return contains(h, point); });
}

TEST(Setback, TilesRandomPolygons)
{
    Random random(17);
    for (u32 round = 0; round < 400; ++round) {
        const Polygon2 polygon = randomPolygon(random);
        const auto edges = edgesOf(polygon);
        std::vector<double> widths;
        for (size_t k = 0; k < edges.size(); ++k)
            widths.push_back(random.uniform() < 0.3 ? 0.0 : 6.0 * random.uniform() * random.uniform());
        const Setback cut = setback(polygon, widths);

        double sum = totalArea(cut.remainder), border = 0.0;
        ClipperLib::Paths all;
        for (const Polygon2& piece : cut.remainder) appendRings(all, piece);
        for (const SetbackStrip& strip : cut.strips) {
            sum += area(strip.polygon);
            appendRings(all, strip.polygon);
            const auto& [a, b] = edges[strip.edge];
            const glm::dvec2 along = glm::normalize(b - a);
            for (const glm::dvec2& corner : strip.polygon.outer) {
                EXPECT_LE(cross(along, corner - a), widths[strip.edge] + 4e-4) << round << " edge " << strip.edge;
                EXPECT_GE(cross(along, corner - a), -4e-4) << round << " edge " << strip.edge;
            }
        }
        for (const auto& [a, b] : edges) border += glm::distance(a, b);
        // Rounding along all borders of the pieces, whose length is a few times that of the polygon.
        EXPECT_NEAR(sum, area(polygon), 4e-4 * border) << round;
        EXPECT_NEAR(areaOf(unite(all)), area(polygon), 4e-4 * border) << round;

        // Right behind the middle of an edge with a width lies its strip.
        for (u32 k = 0; k < edges.size(); ++k) {
            const auto& [a, b] = edges[k];
            if (widths[k] < 0.05 || glm::distance(a, b) < 0.5) continue;
            const glm::dvec2 along = glm::normalize(b - a), p = 0.5 * (a + b) + 0.004 * glm::dvec2(-along.y, along.x);
            EXPECT_TRUE(std::any_of(cut.strips.begin(), cut.strips.end(),
                                    [&](const SetbackStrip& s) { return s.edge == k && isInside(s.polygon, p); }))
                << round << " edge " << k;
        }
    }
}

glm::dvec2 turned(const glm::dvec2& p, double angle)
{
    return {std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y};
}

void expectRectangle(Polygon2 polygon, const glm::dvec2& origin, const glm::dvec2& size)
{
    for (const double angle : {0.0, 0.6, 2.5}) {
        Polygon2 there = polygon;
        for (glm::dvec2& p : there.outer) p = turned(p, angle);
        for (Ring2& hole : there.holes)
            for (glm::dvec2& p : hole) p = turned(p, angle);
        const auto found = innerRectangle(there, turned({1, 0}, angle));
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->size.x, size.x, 1e-5);
        EXPECT_NEAR(found->size.y, size.y, 1e-5);
        EXPECT_NEAR(glm::distance(found->origin, turned(origin, angle)), 0.0, 1e-5);
    }
}

TEST(InnerRectangle, OfSimpleShapes)
{
    expectRectangle(rectangle(10, 6), {0, 0}, {10, 6});
    expectRectangle({{{0, 0}, {6, 0}, {6, 2}, {2, 2}, {2, 5}, {0, 5}}, {}}, {0, 0}, {6, 2});
    // The yard of a U is larger than its arms, and outside.
    expectRectangle({{{0, 0}, {10, 0}, {10, 10}, {9, 10}, {9, 1.5}, {1, 1.5}, {1, 10}, {0, 10}}, {}}, {0, 0},
                    {10, 1.5});
    // The largest rectangle on the base of a triangle has half of its base and half of its height.
    expectRectangle({{{0, 0}, {8, 0}, {3, 6}}, {}}, {1.5, 0}, {4, 3});
    // 5 m stay free to the right of the hole.
    expectRectangle({{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{1, 3}, {1, 7}, {5, 7}, {5, 3}}}}, {5, 0}, {5, 10});
}

TEST(InnerRectangle, FindsTheLevelsBetweenItsFirstOnes)
{
    // A trapezoid 1 wide at its top, 5 at its base, 10 high: width 5 - 0.4 h, best at h = 6.25.
    expectRectangle({{{0, 0}, {5, 0}, {3, 10}, {2, 10}}, {}}, {1.25, 0}, {2.5, 6.25});
}

TEST(InnerRectangle, OfNothing)
{
    EXPECT_FALSE(innerRectangle({{{0, 0}, {1, 0}}, {}}, {1, 0}));
    EXPECT_FALSE(innerRectangle({{{0, 0}, {5, 0}, {10, 0}}, {}}, {1, 0}));
    EXPECT_FALSE(innerRectangle(rectangle(10, 1e-4), {1, 0}));
}

TEST(InnerRectangle, LiesInRandomPolygonsAndIsLarge)
{
    Random random(5);
    for (u32 round = 0; round < 60; ++round) {
        const Polygon2 polygon = randomPolygon(random);
        const glm::dvec2 axis = turned({1, 0}, 2.0 * M_PI * random.uniform()), across(-axis.y, axis.x);
        const auto found = innerRectangle(polygon, axis);
        ASSERT_TRUE(found) << round;
        const glm::dvec2 x = axis * found->size.x, y = across * found->size.y, o = found->origin;
        const ClipperLib::Paths inner = toPaths({{o, o + x, o + x + y, o + y}, {}});
        EXPECT_LT(areaOf(subtract(inner, toPaths(polygon))), 4e-4 * (found->size.x + found->size.y)) << round;
        // No thrown rectangle is larger by more than the steps between the levels allow.
        for (u32 thrown = 0; thrown < 60; ++thrown) {
            const glm::dvec2 p = turned({20.0 * random.uniform(), 0}, 7.0 * random.uniform());
            const glm::dvec2 size(20.0 * random.uniform(), 20.0 * random.uniform());
            const Polygon2 box{{p, p + axis * size.x, p + axis * size.x + across * size.y, p + across * size.y}, {}};
            if (areaOf(subtract(toPaths(box), toPaths(polygon))) > 0.0) continue;
            EXPECT_GT(found->size.x * found->size.y, 0.9 * size.x * size.y) << round;
        }
    }
}

} // namespace
