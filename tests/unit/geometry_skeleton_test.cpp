// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "city/geometry/straight_skeleton.h"

namespace helio {

namespace {

/// Area in plan of each face.
std::vector<double> faceAreas(const Skeleton& skeleton)
{
    std::vector<double> areas;
    for (const auto& face : skeleton.faces) {
        Ring2 ring;
        for (const u32 n : face) ring.push_back(skeleton.nodes[n].position);
        areas.push_back(signedArea(ring));
    }
    return areas;
}

void expectAreas(const Polygon2& polygon, const std::vector<double>& expected, std::vector<double> speeds = {})
{
    const Result<Skeleton> skeleton = straightSkeleton(polygon, speeds);
    ASSERT_TRUE(skeleton) << skeleton.error().message;
    const std::vector<double> areas = faceAreas(*skeleton);
    ASSERT_EQ(areas.size(), expected.size());
    for (std::size_t i = 0; i < areas.size(); ++i) EXPECT_NEAR(areas[i], expected[i], 1e-6) << i;
}

/// True if a node lies there at that time.
bool hasNode(const Skeleton& skeleton, double x, double y, double time)
{
    return std::any_of(skeleton.nodes.begin(), skeleton.nodes.end(), [&](const SkeletonNode& node) {
        return std::abs(node.position.x - x) < 1e-6 && std::abs(node.position.y - y) < 1e-6 &&
               std::abs(node.time - time) < 1e-6;
    });
}

Polygon2 rectangle(double width, double depth)
{
    return {{{0, 0}, {width, 0}, {width, depth}, {0, depth}}, {}};
}

} // namespace

TEST(Skeleton, SquareMeetsInOnePoint)
{
    const Result<Skeleton> skeleton = straightSkeleton(rectangle(4, 4));
    ASSERT_TRUE(skeleton) << skeleton.error().message;
    EXPECT_EQ(skeleton->nodes.size(), 5u);
    EXPECT_TRUE(hasNode(*skeleton, 2, 2, 2));
    expectAreas(rectangle(4, 4), {4, 4, 4, 4});
}

TEST(Skeleton, RectangleHasRidge)
{
    const Result<Skeleton> skeleton = straightSkeleton(rectangle(10, 4));
    ASSERT_TRUE(skeleton) << skeleton.error().message;
    EXPECT_EQ(skeleton->nodes.size(), 6u);
    EXPECT_TRUE(hasNode(*skeleton, 2, 2, 2));
    EXPECT_TRUE(hasNode(*skeleton, 8, 2, 2));
    // Trapezoids (10 + 6) / 2 * 2, triangles 4 * 2 / 2.
    expectAreas(rectangle(10, 4), {16, 4, 16, 4});
}

TEST(Skeleton, LShape)
{
    // Arms 4 wide; the valley runs from the reflex corner (4, 4) to (2, 2).
    expectAreas({{{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}}, {}}, {16, 4, 12, 12, 4, 16});
}

TEST(Skeleton, TShape)
{
    // Bar 12 x 4, stem 4 x 6 below its middle: ridges at 2 m everywhere, valleys from (4, 6) and (8, 6) to (6, 8).
    const Polygon2 t{{{4, 0}, {8, 0}, {8, 6}, {12, 6}, {12, 10}, {0, 10}, {0, 6}, {4, 6}}, {}};
    // Stem end 4; stem side: from (8, 0) to (8, 6), ridge from (6, 2) to (6, 8): 6 * 2; bar below: base 4, top from
    // (6, 8) to (10, 8): 4 * 2; bar end 4; bar above: (12 + 8) / 2 * 2.
    expectAreas(t, {4, 12, 8, 4, 20, 4, 8, 12});
}

TEST(Skeleton, Cross)
{
    const Polygon2 cross{
        {{4, 1}, {1, 1}, {1, 4}, {-1, 4}, {-1, 1}, {-4, 1}, {-4, -1}, {-1, -1}, {-1, -4}, {1, -4}, {1, -1}, {4, -1}},
        {}};
    expectAreas(cross, {3, 3, 1, 3, 3, 1, 3, 3, 1, 3, 3, 1});
    const Result<Skeleton> skeleton = straightSkeleton(cross);
    EXPECT_TRUE(hasNode(*skeleton, 0, 0, 1));
}

TEST(Skeleton, UAndHShapes)
{
    // U: arms 2 wide and 6 long beside a gap of 2, base 2 deep.
    expectAreas({{{0, 0}, {6, 0}, {6, 6}, {4, 6}, {4, 2}, {2, 2}, {2, 6}, {0, 6}}, {}}, {5, 5, 1, 4, 3, 4, 1, 5});
    // H: legs 2 wide and 6 high, a bar 2 high between them at half height: 8 faces of 2 against the bar's two.
    const Result<Skeleton> h = straightSkeleton(
        {{{0, 0}, {2, 0}, {2, 2}, {4, 2}, {4, 0}, {6, 0}, {6, 6}, {4, 6}, {4, 4}, {2, 4}, {2, 6}, {0, 6}}, {}});
    ASSERT_TRUE(h) << h.error().message;
    const std::vector<double> areas = faceAreas(*h);
    EXPECT_NEAR(areas[0], 1, 1e-6);  // end of a leg
    EXPECT_NEAR(areas[1], 2, 1e-6);  // inner side of a leg: parallelogram 2 * 1
    EXPECT_NEAR(areas[2], 3, 1e-6);  // bar: 2 below, 4 at the ridge
    EXPECT_NEAR(areas[11], 5, 1e-6); // outer side of a leg: 6 below, 4 at the ridge
}

TEST(Skeleton, CourtyardRingHasItsRidgeAtHalfWidth)
{
    const Polygon2 ring{{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{3, 3}, {3, 7}, {7, 7}, {7, 3}}}};
    expectAreas(ring, {12.75, 12.75, 12.75, 12.75, 8.25, 8.25, 8.25, 8.25});
    const Result<Skeleton> skeleton = straightSkeleton(ring);
    for (const auto& [x, y] : {std::pair(1.5, 1.5), {8.5, 1.5}, {8.5, 8.5}, {1.5, 8.5}})
        EXPECT_TRUE(hasNode(*skeleton, x, y, 1.5));
    EXPECT_EQ(skeleton->nodes.size(), 12u);
}

TEST(Skeleton, RegularPolygonsMeetAtTheApothem)
{
    for (const u32 n : {3u, 5u, 6u, 8u, 12u, 17u, 64u}) {
        Polygon2 polygon;
        for (u32 i = 0; i < n; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / n + 0.1;
            polygon.outer.push_back({10.0 * std::cos(angle), 10.0 * std::sin(angle)});
        }
        const Result<Skeleton> skeleton = straightSkeleton(polygon);
        ASSERT_TRUE(skeleton) << n << ": " << skeleton.error().message;
        double last = 0.0;
        for (const SkeletonNode& node : skeleton->nodes) last = std::max(last, node.time);
        EXPECT_NEAR(last, 10.0 * std::cos(std::numbers::pi / n), 1e-3) << n;
        for (const double face : faceAreas(*skeleton)) EXPECT_NEAR(face, area(polygon) / n, 0.01) << n;
    }
}

TEST(Skeleton, FourPointedStar)
{
    // Points at 6, notches at (+-1, +-1): all eight faces meet in the middle and are equal.
    const Polygon2 star{{{6, 0}, {1, 1}, {0, 6}, {-1, 1}, {-6, 0}, {-1, -1}, {0, -6}, {1, -1}}, {}};
    expectAreas(star, std::vector<double>(8, 3.0));
}

TEST(Skeleton, SplitEventCutsTheFrontInTwo)
{
    // A wedge from above reaches down to (10, 2) in a bar 20 x 6: the front falls into two parts at 2 / (1 + speed of
    // the reflex corner), where the corner of half angle a moves 1 / sin(a).
    const Polygon2 bar{{{0, 0}, {20, 0}, {20, 6}, {14, 6}, {10, 2}, {6, 6}, {0, 6}}, {}};
    const Result<Skeleton> skeleton = straightSkeleton(bar);
    ASSERT_TRUE(skeleton) << skeleton.error().message;
    const double time = 2.0 / (1.0 + std::numbers::sqrt2);
    EXPECT_TRUE(hasNode(*skeleton, 10, time, time));
}

TEST(Skeleton, AlmostParallelAndAlmostStraightEdges)
{
    // 0.1 mm out of parallel over 40 m, and corners 0.1 mm off a straight line.
    const Polygon2 slanted{{{0, 0}, {40, 0}, {40, 8}, {0, 8.0001}}, {}};
    const Polygon2 bent{{{0, 0}, {10, 0.0001}, {20, 0}, {30, -0.0001}, {40, 0}, {40, 8}, {20, 8}, {0, 8}}, {}};
    for (const Polygon2& polygon : {slanted, bent}) {
        const Result<Skeleton> skeleton = straightSkeleton(polygon);
        ASSERT_TRUE(skeleton) << skeleton.error().message;
        double sum = 0.0, last = 0.0;
        for (const double face : faceAreas(*skeleton)) sum += face;
        for (const SkeletonNode& node : skeleton->nodes) last = std::max(last, node.time);
        EXPECT_NEAR(sum, area(polygon), 1e-6 * sum);
        EXPECT_NEAR(last, 4.0, 2e-4);
    }
    // A corner on a straight edge cuts its face at right angles.
    expectAreas({{{0, 0}, {5, 0}, {10, 0}, {10, 4}, {0, 4}}, {}}, {8, 8, 4, 16, 4});
}

TEST(Skeleton, SpeedsMakeSlopesAndGables)
{
    // Edges of speed 0 stay: the ridge runs from gable to gable.
    expectAreas(rectangle(10, 4), {20, 0, 20, 0}, {1, 0, 1, 0});
    // One gable.
    expectAreas(rectangle(10, 4), {18, 4, 18, 0}, {1, 1, 1, 0});
    // The upper edge three times as fast: ridge at y = 1, hips from x = 1 to x = 9.
    expectAreas(rectangle(10, 4), {9, 2, 27, 2}, {1, 1, 3, 1});
    const std::vector<double> speeds{1, 1, 3, 1};
    const Result<Skeleton> skeleton = straightSkeleton(rectangle(10, 4), speeds);
    ASSERT_TRUE(skeleton) << skeleton.error().message;
    EXPECT_TRUE(hasNode(*skeleton, 1, 1, 1));
    EXPECT_TRUE(hasNode(*skeleton, 9, 1, 1));
}

TEST(Skeleton, FarFromTheOriginIsTheSame)
{
    const glm::dvec2 far(442312.0, 5541876.0);
    Polygon2 l{{{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}}, {}};
    for (glm::dvec2& p : l.outer) p += far;
    expectAreas(l, {16, 4, 12, 12, 4, 16});
}

TEST(Skeleton, ErrorsSayWhatIsWrong)
{
    EXPECT_EQ(straightSkeleton({{{0, 0}, {1, 0}}, {}}).error().message, "a ring has less than three corners");
    EXPECT_EQ(straightSkeleton({{{0, 0}, {1e6, 0}, {0, 1}}, {}}).error().message,
              "a ring has less than three corners, or is larger than 100 km");
    EXPECT_EQ(straightSkeleton({{{0, 0}, {4, 0}, {4, 0}, {0, 4}}, {}}).error().message, "two corners on one place");
    EXPECT_EQ(straightSkeleton({{{0, 0}, {4, 0}, {8, 0}}, {}}).error().message, "no area");
    EXPECT_FALSE(straightSkeleton({{{0, 0}, {4, 4}, {4, 0}, {0, 5}}, {}})); // crosses itself
    EXPECT_FALSE(straightSkeleton({{{0, 0}, {NAN, 0}, {4, 4}}, {}}));
    Polygon2 many;
    for (u32 i = 0; i < kSkeletonMaxCorners + 1; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / (kSkeletonMaxCorners + 1);
        many.outer.push_back({100.0 * std::cos(angle), 100.0 * std::sin(angle)});
    }
    EXPECT_EQ(straightSkeleton(many).error().message, "1201 corners, more than 1200");
}

} // namespace helio
