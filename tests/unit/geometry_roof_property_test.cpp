// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "city/geometry/clip.h"
#include "city/geometry/roof_base.h"
#include "city/geometry/straight_skeleton.h"
#include "tests/unit/geometry_roof_support.h"

// Roofs over made-up bases: closed, over all of the base, of the asked pitch, without any fallback.
namespace helio {

namespace {

using Random = std::mt19937_64;

/// A whole number from 0 to count - 1: the same on every machine, unlike the standard's distributions.
i64 pick(Random& random, u64 count)
{
    return i64(random() % count);
}

/// The union of rectangles on a metre grid: many equal widths, events of one moment, courtyards.
Polygon2 rectilinear(Random& random, double turned)
{
    ClipperLib::Paths paths;
    for (i64 i = 0, count = 2 + pick(random, 6); i < count; ++i) {
        const double x = double(pick(random, 12)), y = double(pick(random, 12));
        const double w = double(2 + pick(random, 8)), d = double(2 + pick(random, 8));
        Polygon2 box{{{x, y}, {x + w, y}, {x + w, y + d}, {x, y + d}}, {}};
        for (glm::dvec2& p : box.outer)
            p = {p.x * std::cos(turned) - p.y * std::sin(turned), p.x * std::sin(turned) + p.y * std::cos(turned)};
        appendRings(paths, box);
    }
    Polygon2 largest;
    for (const Polygon2& piece : subtractToPolygons(paths, {}))
        if (largest.outer.empty() || area(piece) > area(largest)) largest = piece;
    return largest;
}

/// Corners at random distances around a centre: reflex corners of every angle, split events.
Polygon2 star(Random& random)
{
    Polygon2 polygon;
    const i64 n = 5 + pick(random, 40);
    for (i64 i = 0; i < n; ++i) {
        const double angle =
            2.0 * std::numbers::pi * (double(i) + 0.8 * double(pick(random, 1000)) / 1000.0) / double(n);
        const double radius = 4.0 + 0.01 * double(pick(random, 1000));
        polygon.outer.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return polygon;
}

double perimeter(const Polygon2& base)
{
    double sum = 0.0;
    for (const auto& [a, b] : edgesOf(base)) sum += glm::distance(a, b);
    return sum;
}

/// The area of the base, of the faces in plan, and the pitch of the slopes.
void expectCovers(const Polygon2& base, const Roof& roof, double pitch, const std::string& name)
{
    double plan = 0.0;
    for (const RoofFace& face : roof.faces) {
        if (face.part == RoofPart::Slope) {
            plan += vectorArea(face.polygon).z;
            EXPECT_NEAR(unitNormal(face.polygon).z, std::cos(pitch * std::numbers::pi / 180.0), 1e-5) << name;
        }
        for (const glm::dvec3& p : face.polygon.outer) EXPECT_GE(p.z, -1e-9) << name;
    }
    // Bases that touch themselves become 0.5 mm smaller all round.
    const double tolerance = isSimpleOnGrid(base) ? 6e-5 * perimeter(base) + 1e-6 * plan : 6e-4 * perimeter(base);
    EXPECT_NEAR(plan, area(base), tolerance) << name;
    EXPECT_EQ(solidProblem(roof), "") << name;
    EXPECT_EQ(roof.fallback, RoofFallback::None) << name << ": " << roof.reason;
}

void expectRoofs(const Polygon2& base, const std::string& name)
{
    expectCovers(base, hipRoof(base, {false, 40.0}, 0.0), 40.0, "hip " + name);
    expectCovers(base, gableRoof(base, {false, 40.0}, 0.0, 0.0, false, kNoIndex), 40.0, "gable " + name);
    for (const Roof& roof : {hipRoof(base, {false, 40.0}, 0.35), gableRoof(base, {true, 3.0}, 0.35, 0.2, true, 0),
                             shedRoof(base, {true, 3.0}, 1), pyramidRoof(base, {true, 3.0})}) {
        EXPECT_EQ(solidProblem(roof), "") << name;
        EXPECT_EQ(roof.fallback, RoofFallback::None) << name << ": " << roof.reason;
    }
}

} // namespace

TEST(RoofProperties, RectilinearBases)
{
    Random random(1);
    for (u32 i = 0; i < 300; ++i) expectRoofs(rectilinear(random, 0.0), "rectilinear " + std::to_string(i));
}

TEST(RoofProperties, TurnedRectilinearBases)
{
    Random random(2);
    for (u32 i = 0; i < 300; ++i) {
        const double angle = 0.001 * double(pick(random, 1571));
        expectRoofs(rectilinear(random, angle), "turned " + std::to_string(i));
    }
}

TEST(RoofProperties, DiagonalRectilinearBases)
{
    // At 45 degrees the corners round to the grid in pairs: parallels stay parallel almost everywhere.
    Random random(3);
    for (u32 i = 0; i < 200; ++i)
        expectRoofs(rectilinear(random, std::numbers::pi / 4), "diagonal " + std::to_string(i));
}

TEST(RoofProperties, StarBases)
{
    Random random(4);
    for (u32 i = 0; i < 300; ++i) expectRoofs(star(random), "star " + std::to_string(i));
}

TEST(RoofProperties, SameBaseSameBytes)
{
    Random a(5), b(5);
    for (u32 i = 0; i < 50; ++i) {
        const Result<Skeleton> x = straightSkeleton(rectilinear(a, 0.3)), y = straightSkeleton(rectilinear(b, 0.3));
        ASSERT_TRUE(x && y);
        ASSERT_EQ(x->faces, y->faces);
        for (std::size_t n = 0; n < x->nodes.size(); ++n) EXPECT_EQ(x->nodes[n].position, y->nodes[n].position);
    }
}

} // namespace helio
