// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/primitives.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

using namespace helio;
using namespace helio::cga;

namespace {

const glm::dvec3 kSize(2.0, 3.0, 4.0);

// Every edge once in each direction, every face planar and away from the middle, and the volume of the closed form.
void expectSolid(const Geometry& solid, size_t faces, double expected)
{
    EXPECT_TRUE(solid.closed);
    EXPECT_EQ(solid.faces.size(), faces);
    EXPECT_NEAR(volume(solid), expected, 1e-9);
    std::map<std::array<double, 6>, int> seen;
    for (const Face& face : solid.faces) {
        const Ring3& ring = face.polygon.outer;
        const glm::dvec3 normal = unitNormal(face.polygon);
        EXPECT_NEAR(glm::length(normal), 1.0, 1e-12);
        EXPECT_GT(glm::dot(normal, ring[0] - 0.5 * kSize), 0.0);
        for (size_t k = 0; k < ring.size(); ++k) {
            const glm::dvec3 &a = ring[k], &b = ring[(k + 1) % ring.size()];
            EXPECT_NEAR(glm::dot(normal, a - ring[0]), 0.0, 1e-12);
            ++seen[{a.x, a.y, a.z, b.x, b.y, b.z}];
        }
        EXPECT_NEAR(glm::length(face.xAxis), 1.0, 1e-12);
        EXPECT_NEAR(glm::dot(face.xAxis, normal), 0.0, 1e-12);
        EXPECT_NEAR(face.xAxis.y, 0.0, 1e-12);
    }
    for (const auto& [edge, count] : seen) {
        EXPECT_EQ(count, 1);
        EXPECT_TRUE(seen.contains({edge[3], edge[4], edge[5], edge[0], edge[1], edge[2]}));
    }
}

// Area of a regular polygon over that of its circumscribed square.
double shareOf(u32 sides)
{
    return sides * std::sin(2.0 * M_PI / sides) / 8.0;
}

TEST(Primitives, AreClosedSolidsOfKnownVolume)
{
    const double box = 2.0 * 3.0 * 4.0;
    expectSolid(boxPrimitive(kSize), 6, box);
    for (const u32 sides : {3u, 4u, 7u, 32u}) {
        expectSolid(cylinderPrimitive(sides, kSize), sides + 2, box * shareOf(sides));
        expectSolid(conePrimitive(sides, kSize), sides + 1, box * shareOf(sides) / 3.0);
    }
}

TEST(Primitives, SphereIsASumOfFrusta)
{
    for (const u32 segments : {3u, 8u, 24u})
        for (const u32 rings : {2u, 3u, 12u}) {
            // Between two rings of radii a and b at the distance h: h (a^2 + a b + b^2) / 3 times the polygon's share.
            double sum = 0.0;
            for (u32 k = 0; k < rings; ++k) {
                const double a = std::sin(M_PI * k / rings), b = std::sin(M_PI * (k + 1) / rings);
                const double h = 0.5 * (std::cos(M_PI * k / rings) - std::cos(M_PI * (k + 1) / rings));
                sum += h * (a * a + a * b + b * b) / 3.0;
            }
            expectSolid(spherePrimitive(segments, rings, kSize), size_t(segments) * rings,
                        sum * shareOf(segments) * 24.0);
        }
}

TEST(Primitives, FlatOnesLookUp)
{
    const std::pair<Geometry, double> cases[] = {{quadPrimitive(kSize), 8.0},
                                                 {diskPrimitive(6, kSize), 8.0 * shareOf(6)}};
    for (const auto& [flat, expected] : cases) {
        ASSERT_EQ(flat.faces.size(), 1u);
        EXPECT_FALSE(flat.closed);
        EXPECT_NEAR(area(flat), expected, 1e-12);
        EXPECT_NEAR(unitNormal(flat.faces[0].polygon).y, 1.0, 1e-12);
        for (const glm::dvec3& p : flat.faces[0].polygon.outer) EXPECT_EQ(p.y, 0.0);
    }
}

TEST(Primitives, BoxWithOneSizeOfZeroIsARectangle)
{
    for (int flat = 0; flat < 3; ++flat) {
        glm::dvec3 size = kSize;
        size[flat] = 0.0;
        const Geometry sheet = boxPrimitive(size);
        ASSERT_EQ(sheet.faces.size(), 1u);
        EXPECT_FALSE(sheet.closed);
        EXPECT_NEAR(unitNormal(sheet.faces[0].polygon)[flat], 1.0, 1e-12);
        EXPECT_NEAR(area(sheet), 24.0 / kSize[flat], 1e-12);
        EXPECT_NEAR(sheet.faces[0].xAxis.y, 0.0, 1e-12);
        const auto [low, high] = bounds(sheet);
        EXPECT_EQ(low, glm::dvec3(0.0));
        EXPECT_EQ(high, size);
    }
}

} // namespace
