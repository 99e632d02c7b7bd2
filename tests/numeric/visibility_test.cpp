// SPDX-License-Identifier: Apache-2.0
#include "city/light/visibility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "city/light/cosine_directions.h"
#include "city/light/sequence.h"
#include "city/light/sky.h"
#include "city/light/sun.h"
#include "tests/numeric/fixtures.h"

using namespace helio;
using namespace helio::test;

namespace {

const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

std::vector<Face> square(const glm::dvec3& centre, const glm::dvec3& u, const glm::dvec3& v, double size, u32 group)
{
    return grid(centre - 0.5 * size * (u + v), size * u, size * v, 1, 1, {{}, group});
}

/// Floor of a 20 x 20 m courtyard with walls of 15 m.
std::vector<Face> courtyard(u32 n)
{
    std::vector<Face> faces = room({20, 20, 15}, n, glm::dvec4(0.5), glm::dvec4(0.0));
    std::erase_if(faces, [](const Face& face) { return face.group == 1; });
    for (Face& face : faces)
        if (face.group > 1) --face.group;
    return faces;
}

} // namespace

TEST(Sequence, DirectionNumbersByHand)
{
    // Fourth dimension: polynomial x^3 + x + 1, m = 1, 3, 1, then m4 = 4 m2 ^ 8 m1 ^ m1 = 5. Point 2^k is m / 2^(k +
    // 1).
    EXPECT_EQ(sobol4(1)[3], 0x80000000u);
    EXPECT_EQ(sobol4(2)[3], 3u << 30);
    EXPECT_EQ(sobol4(4)[3], 1u << 29);
    EXPECT_EQ(sobol4(8)[3], 5u << 28);
    // Second dimension: m = 1, then m2 = 2 m1 ^ m1 = 3. First: the bits of the index backwards.
    EXPECT_EQ(sobol4(2)[1], 3u << 30);
    EXPECT_EQ(sobol4(6)[0], 0x60000000u);
}

TEST(Sequence, SobolPointsFillEveryQuarterEvenly)
{
    // 64 points: each dimension has one in every 64th; the pairs (0,1) and (2,3) have one in each cell of 8 x 8.
    const std::array<u32, 4> shift = digitalShift(11);
    std::array<std::array<int, 64>, 4> bins{};
    std::array<int, 64> cells{};
    for (u32 i = 64; i < 128; ++i) {
        const std::array<double, 4> x = shiftedSobol4(i, shift);
        for (u32 d = 0; d < 4; ++d) ++bins[d][size_t(x[d] * 64.0)];
        ++cells[size_t(x[0] * 8.0) * 8 + size_t(x[1] * 8.0)];
    }
    for (const auto& dimension : bins)
        for (const int count : dimension) EXPECT_EQ(count, 1);
    for (const int count : cells) EXPECT_EQ(count, 1);
    EXPECT_EQ(sobol4(1500)[0], (sobol4(1500 - 1024)[0] ^ sobol4(1024)[0])) << "beyond the table";
}

TEST(Visibility, BlocksFromBothSidesAndEndsOnSurfaces)
{
    for (const glm::dvec3 offset : {glm::dvec3(0.0), glm::dvec3(5e5, 4.5e6, 300.0)}) {
        std::vector<Face> faces = square({0, 0, 0}, kX, kY, 2, 0); // up
        append(faces, square({0, 0, 4}, kY, kX, 2, 1));            // down
        append(faces, square({0, 0, 2}, kX, kY, 1, 2));            // blocker, faces up
        const NodeTree tree = makeTree(moved(faces, offset));
        const Visibility visibility(tree);
        const auto blocked = [&](double x0, double x1) {
            return visibility.isBlocked(offset + glm::dvec3(x0, 0, 0), kZ, offset + glm::dvec3(x1, 0, 4), -kZ);
        };
        EXPECT_TRUE(blocked(0.0, 0.0));
        EXPECT_TRUE(blocked(-0.4, -0.4));
        EXPECT_FALSE(blocked(0.9, 0.9));
        EXPECT_FALSE(blocked(0.2, 0.9)) << "crosses the blocker's plane at 0.55";
        const RayHit back = visibility.trace(offset, kZ, kZ), front = visibility.trace(offset + 4.0 * kZ, -kZ, -kZ);
        EXPECT_EQ(back.patch, 2u);
        EXPECT_FALSE(back.front);
        EXPECT_EQ(front.patch, 2u);
        EXPECT_TRUE(front.front);
        EXPECT_EQ(visibility.trace(offset + 0.9 * kX, kZ, glm::normalize(glm::dvec3(3, 0, 1))).patch, kNoIndex);
        EXPECT_TRUE(visibility.isBlocked(offset + 4.0 * kZ, -kZ, -kZ));
        EXPECT_FALSE(visibility.isBlocked(offset, -kZ, -kZ));
    }
}

TEST(Visibility, PacketsMeetWhatSingleRaysMeet)
{
    const NodeTree tree = makeTree(courtyard(4));
    const Visibility visibility(tree);
    const std::array<u32, 4> shift = digitalShift(3);
    u32 met = 0;
    for (u32 patch = 0; patch < tree.patchCount(); patch += 5) {
        const PlaneFrame frame = planeFrame(tree.nodes[patch].normal);
        constexpr u32 kRays = 43; // no multiple of the packet's width
        std::vector<glm::dvec3> from(kRays), direction(kRays);
        std::vector<RayEnd> ends(kRays);
        for (u32 k = 0; k < kRays; ++k) {
            const std::array<double, 4> x = shiftedSobol4(k, shift);
            from[k] = visibility.pointOnPatch(patch, x[2], x[3]);
            direction[k] = cosineDirection(frame, x[0], x[1]);
        }
        visibility.trace(from, frame.normal, direction, ends);
        for (u32 k = 0; k < kRays; ++k) {
            const RayHit hit = visibility.trace(from[k], frame.normal, direction[k]);
            ASSERT_EQ(ends[k].node == kNoIndex, hit.patch == kNoIndex) << patch << " " << k;
            if (hit.patch == kNoIndex) continue;
            ++met;
            u32 above = hit.patch;
            while (above != ends[k].node && above != kNoIndex) above = tree.nodes[above].parent;
            EXPECT_EQ(above, ends[k].node) << "a node that the patch is part of";
            EXPECT_EQ(ends[k].front, hit.front);
            EXPECT_NEAR(double(ends[k].distance), glm::distance(hit.point, from[k]), 1e-3);
        }
    }
    EXPECT_GT(met, 500u);
    EXPECT_LT(visibility.triangleCount(), 2 * tree.patchCount() / 4) << "walls block as wholes";
}

TEST(CosineDirections, EightAtATimeAgreeWithOne)
{
    const PlaneFrame frame = planeFrame(glm::normalize(glm::dvec3(1, 2, -3)));
    const std::array<u32, 4> shift = digitalShift(8);
    double worst = 0.0;
    for (u32 first = 0; first < 4096; first += kLanes) {
        Row8 x, y;
        std::array<glm::dvec3, kLanes> directions;
        for (u32 k = 0; k < kLanes; ++k) {
            const std::array<double, 4> point = shiftedSobol4(first + k, shift);
            x[k] = float(point[0]);
            y[k] = float(point[1]);
        }
        cosineDirections(frame, x, y, directions);
        for (u32 k = 0; k < kLanes; ++k) {
            const glm::dvec3 one = cosineDirection(frame, std::min(double(x[k]), 1.0 - 0x1.0p-24), double(y[k]));
            raise(worst, glm::distance(directions[k], one));
            EXPECT_GT(glm::dot(directions[k], frame.normal), 0.0);
        }
    }
    EXPECT_LT(worst, 1e-6);
}

TEST(Visibility, PointsOnAPatchKeepToItsAreaAndItsHole)
{
    Face face{{{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}}; // an L of 5 m2
    const NodeTree tree = makeTree({face});
    const Visibility visibility(tree);
    glm::dvec3 mean(0.0);
    constexpr u32 kCount = 4096;
    for (u32 i = 0; i < kCount; ++i) {
        const std::array<double, 4> x = shiftedSobol4(i, {});
        const glm::dvec3 p = visibility.pointOnPatch(0, x[0], x[1]);
        EXPECT_FALSE(p.x > 1.0 + 1e-6 && p.y > 1.0 + 1e-6);
        mean += p / double(kCount);
    }
    // 3 x 1 with centroid (1.5, .5) and 1 x 2 with centroid (.5, 2).
    EXPECT_NEAR(mean.x, (3 * 1.5 + 2 * 0.5) / 5.0, 2e-3);
    EXPECT_NEAR(mean.y, (3 * 0.5 + 2 * 2.0) / 5.0, 2e-3);
}

TEST(Sky, OpenGroundWallAndCourtyard)
{
    std::vector<Face> open = square({0, 0, 0}, kX, kY, 1, 0);
    append(open, square({100, 0, 0}, kY, kZ, 1, 1));
    const NodeTree openTree = makeTree(open);
    const Visibility openVisibility(openTree);
    const SkyScan scan = scanSky(openTree, openVisibility, 1024, 1, 1, {});
    EXPECT_NEAR(double(scan.sky[0]), 1.0, 2e-3);
    EXPECT_NEAR(double(scan.sky[1]), 0.5, 2e-3);
    EXPECT_NEAR(double(scan.below[1]), 0.5, 2e-3);

    // Small patch at the centre of the floor: 0.357684747 (closed form).
    std::vector<Face> faces = courtyard(21);
    const NodeTree tree = makeTree(faces);
    const Visibility visibility(tree);
    const SkyScan yard = scanSky(tree, visibility, 4096, 1, 0, {});
    EXPECT_NEAR(double(yard.sky[10 * 21 + 10]), 0.3576847466302562, 2e-3);
    // Floor as a whole: to an opening of the same size 15 m above, C-11.
    const double a = 20.0 / 15.0, s = std::sqrt(1 + a * a);
    const double c11 = 2 / (std::numbers::pi * a * a) *
                       (0.5 * std::log((1 + a * a) * (1 + a * a) / (1 + 2 * a * a)) + 2 * a * s * std::atan(a / s) -
                        2 * a * std::atan(a));
    double floor = 0.0;
    for (u32 i = 0; i < 21 * 21; ++i) floor += double(yard.sky[i]) / (21.0 * 21.0);
    EXPECT_NEAR(floor, c11, 3e-4);
    for (u32 i = 0; i < tree.patchCount(); ++i)
        EXPECT_NEAR(double(yard.sky[i] + yard.below[i] + yard.rowSum[i] + yard.back[i]), 1.0, 1e-6);
    // Floor and four walls: all ten pairs see each other.
    EXPECT_EQ(yard.rootPairs.size(), 10u);
}

TEST(Sky, FewRaysAreWellSpread)
{
    // Independent rays would err by sqrt(v (1 - v) / 128) = 4.2 % on average; strata make it a third.
    const NodeTree tree = makeTree(courtyard(8));
    const Visibility visibility(tree);
    const SkyScan few = scanSky(tree, visibility, 128, 3, 0, {}), many = scanSky(tree, visibility, 8192, 4, 0, {});
    double square = 0.0;
    for (u32 i = 0; i < tree.patchCount(); ++i)
        square += std::pow(double(few.sky[i] - many.sky[i]), 2) / tree.patchCount();
    EXPECT_LT(std::sqrt(square), 0.014);
}

TEST(Sun, ShadowOfASquareOnTheGround)
{
    // Sun at 45 degrees from +x: a 2 x 2 m roof at 3 m shades x in (-4, -2).
    std::vector<Face> faces = grid({-10, -10, 0}, 20.0 * kX, 20.0 * kY, 20, 20, {{}, 0});
    append(faces, square({0, 0, 3}, kX, kY, 2, 1));
    const NodeTree tree = makeTree(faces);
    const Visibility visibility(tree);
    const glm::dvec3 toSun = sunDirection(std::numbers::pi / 2, std::numbers::pi / 4);
    EXPECT_NEAR(toSun.x, std::sqrt(0.5), 1e-12);
    const std::vector<double> sun = raySun(tree, visibility, toSun, 64, 1);
    double shaded = 0.0;
    for (u32 i = 0; i < 400; ++i) {
        const glm::dvec3 c = tree.nodes[i].centroid;
        const bool inShadow = c.x > -4 && c.x < -2 && std::abs(c.y) < 1;
        EXPECT_NEAR(sun[i], inShadow ? 0.0 : std::sqrt(0.5), 1e-12) << c.x << " " << c.y;
        shaded += inShadow;
    }
    EXPECT_EQ(shaded, 4.0);
    EXPECT_EQ(raySun(tree, visibility, -toSun, 4, 1)[400], 0.0) << "sun behind the patch";
}
