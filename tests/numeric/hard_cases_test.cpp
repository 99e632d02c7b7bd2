// SPDX-License-Identifier: Apache-2.0
// Scenes that break renderers: what physics says of each must come out of the bake, the sun, the sky and the solver.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <numbers>

#include "city/light/path_tracer.h"
#include "city/light/sun.h"
#include "tests/numeric/lit_scene.h"
#include "tests/numeric/pair_fixtures.h"

using namespace helio;
using namespace helio::test;

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

/// 80 x 80 m in n x n cells about the origin, group 0; shadows of what stands in its middle end on it.
std::vector<Face> ground(u32 n = 16)
{
    return grid({-40, -40, 0}, 80.0 * kX, 80.0 * kY, n, n, {{}, 0, glm::dvec4(0.2)});
}
constexpr double kGroundArea = 6400.0;

Daylight sunAt(double azimuth, double elevation)
{
    Daylight light;
    light.toSun = sunDirection(azimuth * kDegree, elevation * kDegree);
    return light;
}

/// All the sun that falls on the ground's outline falls on something: flux of the sun, W.
void expectAllOfTheSun(const LitScene& scene, const Daylight& light)
{
    const double expected = light.dni * light.toSun.z * kGroundArea;
    EXPECT_NEAR(scene.flux([&](u32 i) { return scene.sun[i]; }) / expected, 1.0, 5e-3);
}

/// The first `count` patches of two scenes have the same light: sun and sky to the last ray, what comes from patches
/// within 5 % of its mean for each (their links rest on other rays) and 0.3 % in the mean.
void expectSameLight(const LitScene& a, const LitScene& b, u32 count, double rays)
{
    const auto among = [&](u32 i) { return i < count; };
    const double indirect = a.mean([&](u32 i) { return a.indirect(i); }, among);
    double sun = 0.0, sky = 0.0, each = 0.0;
    for (u32 i = 0; i < count; ++i) {
        raise(sun, std::abs(a.sun[i] - b.sun[i]));
        raise(sky, std::abs(a.sky[i] - b.sky[i]));
        raise(each, std::abs(a.indirect(i) - b.indirect(i)) / indirect);
    }
    const double mean = b.mean([&](u32 i) { return b.indirect(i); }, among) / indirect - 1.0;
    std::printf("largest difference: sun %.3g, sky %.3g W/m2, indirect %.2f %%, its mean %+.3f %%\n", sun, sky,
                100 * each, 100 * mean);
    EXPECT_LE(sun, 800.0 * rays / 256.0 + 1e-9);
    EXPECT_LE(sky, 120.0 * rays / 1024.0 + 1e-4);
    EXPECT_LT(each, 0.05);
    EXPECT_LT(std::abs(mean), 3e-3);
}

void expectDark(const LitScene& scene, u32 begin, u32 end, double irradiance)
{
    double worst = 0.0;
    for (u32 i = begin; i < end; ++i) raise(worst, scene.irradiance(i));
    EXPECT_LE(worst, irradiance) << "patches " << begin << " to " << end;
}

} // namespace

TEST(HardCases, TouchingBuildingsAreOneBuilding)
{
    // Two boxes of 10 m, wall against wall, and one of 20 x 10 m; the walls between them come last.
    const Daylight light = sunAt(200, 35);
    std::vector<Face> one = ground();
    append(one, boxOutside({-10, -5, 0}, {10, 5, 10}, 5, 1));
    std::vector<Face> two = one;
    append(two, grid({0, -5, 0}, 10.0 * kY, 10.0 * kZ, 2, 2, {{}, 6})); // faces +x, into the eastern one
    append(two, grid({0, 5, 0}, -10.0 * kY, 10.0 * kZ, 2, 2, {{}, 7})); // faces -x
    const LitScene a = lightFaces(one, light), b = lightFaces(two, light);
    for (const LitScene* scene : {&a, &b}) {
        expectPhysical(*scene, light);
        expectAllOfTheSun(*scene, light);
    }
    expectSameLight(a, b, u32(one.size()), 0);
    // A link to ground half of which lies outside may leave less than one ray of 1024 sees of the sky.
    expectDark(b, u32(one.size()), u32(two.size()), 120.0 / 1024);
}

TEST(HardCases, MirroredBuildingsAreLitAlike)
{
    // Symmetric about x = 0, the sun in the south.
    const Daylight light = sunAt(180, 30);
    std::vector<Face> faces = ground();
    append(faces, boxOutside({-15, -5, 0}, {-5, 5, 12}, 2.5, 1));
    append(faces, boxOutside({5, -5, 0}, {15, 5, 12}, 2.5, 6));
    const LitScene scene = lightFaces(faces, light);
    expectPhysical(scene, light);
    expectAllOfTheSun(scene, light);
    const auto side = [&](double sign, const glm::dvec3& normal) {
        return scene.mean([&](u32 i) { return scene.irradiance(i); },
                          [&](u32 i) {
                              const Node& node = scene.tree.nodes[i];
                              return sign * node.centroid.x > 0.0 &&
                                     glm::dot(node.normal, glm::dvec3(sign * normal.x, normal.y, normal.z)) > 0.9;
                          });
    };
    for (const glm::dvec3& normal : {kX, -kX, kY, -kY, kZ}) {
        const double east = side(1.0, normal), west = side(-1.0, normal);
        EXPECT_GT(east, 1.0);
        EXPECT_NEAR(west / east, 1.0, 5e-3) << normal.x << " " << normal.y << " " << normal.z;
    }
}

TEST(HardCases, OverlappingBuildingsAreTheirUnion)
{
    // [0, 10] x [0, 10] x 10 m and [5, 15] x [5, 15] x 15 m in cells of 5 m: what lies in the other one is a cell of
    // its own. The union leaves these out.
    const Daylight light = sunAt(225, 40);
    std::vector<Face> boxes = boxOutside({0, 0, 0}, {10, 10, 10}, 5, 1);
    append(boxes, boxOutside({5, 5, 0}, {15, 15, 15}, 5, 6));
    const auto isInside = [](const Face& face) {
        const glm::dvec3 c = 0.5 * (face.ring[0] + face.ring[2]);
        const auto in = [&](const glm::dvec3& low, const glm::dvec3& high) {
            return c.x > low.x && c.y > low.y && c.x < high.x && c.y < high.y && c.z < high.z;
        };
        return face.group <= 5 ? in({5, 5, 0}, {15, 15, 15}) : in({0, 0, 0}, {10, 10, 10});
    };
    std::vector<Face> outside = ground(), all;
    for (const Face& face : boxes)
        if (!isInside(face)) outside.push_back(face);
    all = outside;
    for (Face face : boxes)
        if (isInside(face)) {
            face.group += 10;
            all.push_back(face);
        }
    ASSERT_GT(all.size(), outside.size() + 6);
    const LitScene a = lightFaces(outside, light), b = lightFaces(all, light);
    for (const LitScene* scene : {&a, &b}) {
        expectPhysical(*scene, light);
        expectAllOfTheSun(*scene, light);
    }
    expectSameLight(a, b, u32(outside.size()), 0);
    // One of 1024 rays may slip through where a wall ends on another one.
    expectDark(b, u32(outside.size()), u32(all.size()), 120.0 / 1024);
}

TEST(HardCases, InterpenetratingBuildingsKeepTheSun)
{
    // The second stands askew through the first, so that patches are cut by each other's walls. Such a patch has one
    // radiosity for its free part and for what lies in the dark: an error that goes with the patches' size.
    const Daylight light = sunAt(160, 38);
    double error[2];
    for (const u32 fine : {0u, 1u}) {
        std::vector<Face> faces = ground(fine == 0 ? 16 : 32);
        const double cell = fine == 0 ? 3.0 : 1.5;
        append(faces, boxOutside({-8, -6, 0}, {8, 6, 9}, cell, 1));
        append(faces, turned(boxOutside({-5, -9, 0}, {6, 10, 13}, cell, 6), 0.5));
        const LitScene scene = lightFaces(faces, light);
        expectPhysical(scene, light);
        expectAllOfTheSun(scene, light);
        // The path tracer, which knows no links, judges what arrives from patches.
        const Visibility visibility(scene.tree);
        const PathReference reference =
            tracePaths(scene.tree, visibility, {.toSun = light.toSun, .samples = fine == 0 ? 1024u : 256u});
        const auto everywhere = [](u32) { return true; };
        const double traced = scene.mean([&](u32 i) { return reference.patches[i].indirect.x; }, everywhere);
        error[fine] = scene.mean([&](u32 i) { return scene.indirect(i); }, everywhere) / traced - 1.0;
    }
    std::printf("indirect light against paths: %+.2f %%, in patches of half the size %+.2f %%\n", 100 * error[0],
                100 * error[1]);
    EXPECT_LT(std::abs(error[0]), 0.12);
    EXPECT_LT(std::abs(error[1]), 0.7 * std::abs(error[0]));
}

TEST(HardCases, GapOfAMillimetreIsDarkAndChangesNothingOutside)
{
    const Daylight light = sunAt(200, 35);
    const auto scene = [&](double gap) {
        std::vector<Face> faces = ground();
        std::vector<Face> west = boxOutside({-10, -5, 0}, {0, 5, 10}, 5, 1),
                          east = boxOutside({gap, -5, 0}, {10 + gap, 5, 10}, 5, 6);
        // The walls on the gap last: the second of the western box, the fourth of the eastern one.
        const auto take = [](std::vector<Face>& from, u32 group) {
            std::vector<Face> taken;
            std::copy_if(from.begin(), from.end(), std::back_inserter(taken),
                         [&](const Face& f) { return f.group == group; });
            std::erase_if(from, [&](const Face& f) { return f.group == group; });
            return taken;
        };
        const std::vector<Face> a = take(west, 2), b = take(east, 9);
        append(faces, west);
        append(faces, east);
        append(faces, a);
        append(faces, b);
        return lightFaces(faces, light);
    };
    const LitScene closed = scene(0.0), open = scene(1e-3);
    const u32 count = open.tree.patchCount();
    for (const LitScene* s : {&closed, &open}) {
        expectPhysical(*s, light);
        expectAllOfTheSun(*s, light);
    }
    expectSameLight(closed, open, count - 8, 2);
    // Through the slits (10 m2 / 1000 above, twice that beside) come at most 800 + 120 W/m2 for 200 m2 of wall.
    const double mean = open.mean([&](u32 i) { return open.irradiance(i); }, [&](u32 i) { return i >= count - 8; });
    std::printf("in the gap %.3g W/m2\n", mean);
    EXPECT_LT(mean, 920.0 * 0.03 / 200.0 / (1.0 - 0.5) + 0.1);
}

TEST(HardCases, SliversAreLitAsTheirNeighbours)
{
    // A furnace whose floor has a strip of 1 mm and one of 0.1 mm x 10 mm; E = 1 / (1 - rho) = 2 everywhere.
    std::vector<Face> faces = room({10, 7, 4}, 3, glm::dvec4(0.5), glm::dvec4(1.0));
    std::erase_if(faces, [](const Face& face) { return face.group == 0; });
    const auto floor = [&](double x0, double x1, double y0, double y1) {
        append(faces, grid({x0, y0, 0}, (x1 - x0) * kX, (y1 - y0) * kY, 1, 1, {{}, 0, glm::dvec4(0.5), glm::dvec4(1)}));
    };
    floor(0, 5, 0, 7);
    floor(5, 5.001, 0, 7);
    floor(5.001, 10, 0, 6.99);
    floor(5.001, 5.0011, 6.99, 7);
    floor(5.0011, 10, 6.99, 7);
    const LitScene scene = lightFaces(faces, {});
    expectPhysical(scene, {});
    ASSERT_EQ(scene.tree.patchCount(), faces.size());
    for (u32 i = 0; i < scene.tree.patchCount(); ++i) EXPECT_NEAR(scene.indirect(i), 2.0, 0.02) << i;
}

TEST(HardCases, CoplanarNeighboursExchangeNothing)
{
    // A facade over two houses, one of them set with the same polygon twice, and a street before them.
    std::vector<Face> faces = grid({0, 0, 0}, 10.0 * kX, 8.0 * kZ, 2, 2, {{}, 0, glm::dvec4(0.5), glm::dvec4(1)});
    append(faces, grid({10, 0, 0}, 10.0 * kX, 8.0 * kZ, 2, 2, {{}, 1, glm::dvec4(0.5), glm::dvec4(1)}));
    append(faces, grid({10, 0, 0}, 10.0 * kX, 8.0 * kZ, 2, 2, {{}, 2, glm::dvec4(0.5), glm::dvec4(1)}));
    append(faces, grid({0, -10, 0}, 20.0 * kX, 10.0 * kY, 4, 2, {{}, 3, glm::dvec4(0.2)}));
    const Daylight light = sunAt(180, 45);
    const LitScene scene = lightFaces(faces, light);
    expectPhysical(scene, light);
    const std::vector<double> dense = denseFactors(scene.tree, scene.bake.links);
    const u32 n = scene.tree.patchCount();
    for (u32 i = 0; i < 12; ++i)
        for (u32 j = 0; j < 12; ++j) EXPECT_EQ(dense[i * n + j], 0.0) << i << " " << j;
    for (u32 i = 0; i < 4; ++i) EXPECT_NEAR(scene.sun[i], 800.0 * std::sqrt(0.5), 1e-9) << "no shadow in its own plane";
    // The first house's windows and the street: facade as in a closed form.
    double arrived = 0.0;
    for (u32 j = 12; j < n; ++j)
        for (u32 i = 0; i < 8; ++i) arrived += scene.tree.patches[j].area * dense[j * n + i];
    EXPECT_GT(arrived, 0.0);
    EXPECT_LE(arrived, 200.0 * closedPerpendicular(0, 10, 0, 20, 0, 8, 0, 20) * 1.01);
}

TEST(HardCases, WallEdgeOnToTheSunHasNeitherLightNorShadow)
{
    for (const double turn : {0.0, 0.3, 1.0, 2.2}) {
        // A wall of no thickness, lit from both sides, along the sun's azimuth.
        std::vector<Face> faces = ground();
        append(faces, turned(grid({0, -5, 0}, 10.0 * kY, 8.0 * kZ, 2, 2, {{}, 1}), turn)); // faces +x
        append(faces, turned(grid({0, 5, 0}, -10.0 * kY, 8.0 * kZ, 2, 2, {{}, 2}), turn));
        Daylight light;
        light.toSun = sunDirection(-turn, 30.0 * kDegree);
        const LitScene scene = lightFaces(faces, light);
        expectPhysical(scene, light);
        for (u32 i = 256; i < scene.tree.patchCount(); ++i) EXPECT_LE(scene.sun[i], 1e-10) << turn;
        double worst = 0.0;
        for (u32 i = 0; i < 256; ++i) raise(worst, std::abs(scene.sun[i] - 400.0));
        EXPECT_LE(worst, turn == 0.0 ? 1e-9 : 400.0 * 2 / 256) << turn;
    }
}

TEST(HardCases, SunAtAndBelowTheHorizonLightsNothing)
{
    // Walls to all sides, a roof and its soffit, without any ground that could hide the sun from below.
    std::vector<Face> faces = boxOutside({0, 0, 0}, {4, 4, 4}, 4, 0);
    append(faces, grid({6, 90, 3}, 4.0 * kY, 4.0 * kX, 1, 1, {{}, 5})); // faces down
    const NodeTree tree = makeTree(faces);
    const Visibility visibility(tree);
    for (const double elevation : {0.0, -1e-9, -0.5, -30.0, -90.0})
        for (const double azimuth : {0.0, 77.0, 180.0, 270.0}) {
            const glm::dvec3 toSun = sunDirection(azimuth * kDegree, elevation * kDegree);
            for (const double share : raySun(tree, visibility, toSun, 64)) EXPECT_EQ(share, 0.0) << elevation;
            const PathReference reference = tracePaths(tree, visibility, {.toSun = toSun, .dhi = 0.0, .samples = 16});
            for (const PatchLight& light : reference.patches) EXPECT_EQ(light.sun + light.indirect.x, 0.0) << elevation;
        }
    // Just above it: cosines as ever.
    const Daylight light = sunAt(90, 0.01);
    const LitScene scene = lightFaces(faces, light);
    expectPhysical(scene, light);
    EXPECT_NEAR(scene.sun[1], 800.0 * std::cos(0.01 * kDegree), 1e-9) << "the east wall";
    EXPECT_NEAR(scene.sun[4], 800.0 * std::sin(0.01 * kDegree), 1e-9) << "the roof";
    for (const u32 i : {0u, 2u, 3u, 5u}) EXPECT_LE(scene.sun[i], 1e-10);
}

TEST(HardCases, CourtyardWithoutSkyIsDark)
{
    const Daylight light = sunAt(150, 50);
    const std::vector<Face> closed = room({8, 6, 5}, 3, glm::dvec4(0.7), glm::dvec4(0.0));
    const LitScene dark = lightFaces(closed, light);
    expectDark(dark, 0, dark.tree.patchCount(), 0.0);
    for (const glm::dvec4& b : dark.solution.radiosity) EXPECT_EQ(b, glm::dvec4(0.0));
    std::vector<Face> open = closed;
    std::erase_if(open, [](const Face& face) { return face.group == 1; });
    const LitScene lit = lightFaces(open, light);
    expectPhysical(lit, light);
    for (u32 i = 0; i < lit.tree.patchCount(); ++i) EXPECT_GT(lit.irradiance(i), 1.0);
    // What comes in through the opening meets something: the sun's part of it exactly.
    EXPECT_NEAR(lit.flux([&](u32 i) { return lit.sun[i]; }) / (800.0 * light.toSun.z * 48.0), 1.0, 5e-3);
    EXPECT_NEAR(lit.flux([&](u32 i) { return lit.sky[i]; }) / (120.0 * 48.0), 1.0, 5e-3);
}

TEST(HardCases, BlackSurfacesSendNothingOn)
{
    // Reflectance 0 in one channel, 0.5 in another.
    const glm::dvec4 rho(0.0, 0.5, 0.0, 0.0);
    std::vector<Face> faces = ground();
    append(faces, boxOutside({-10, -5, 0}, {10, 5, 10}, 5, 1));
    for (Face& face : faces) face.rho = rho;
    const Daylight light = sunAt(200, 35);
    const LitScene scene = lightFaces(faces, light);
    expectPhysical(scene, light);
    for (u32 i = 0; i < scene.tree.patchCount(); ++i) {
        EXPECT_EQ(scene.solution.indirect[i].x, 0.0);
        EXPECT_EQ(scene.solution.radiosity[i].x, 0.0);
    }
    EXPECT_GT(scene.flux([&](u32 i) { return scene.solution.indirect[i].y; }), 0.0);
    // An emitter over a black square: E = F.
    std::vector<Face> pair = grid({0, 0, 0}, kX, kY, 4, 4, {{}, 0, glm::dvec4(0.0)});
    append(pair, grid({0, 0, 1}, kY, kX, 4, 4, {{}, 1, glm::dvec4(0.0), glm::dvec4(1.0)}));
    const LitScene two = lightFaces(pair, {.dhi = 0.0});
    const double mean = two.mean([&](u32 i) { return two.indirect(i); }, [](u32 i) { return i < 16; });
    EXPECT_NEAR(mean / closedOpposed(0, 1, 0, 1, 1, 0, 1, 0, 1), 1.0, 5e-3);
}

TEST(HardCases, WhiteSurfacesKeepTheBalance)
{
    // Reflectance 0.95. Closed: B = E / 0.05. Open above: what comes in is absorbed or leaves through the opening.
    const LitScene furnace = lightFaces(room({8, 6, 5}, 4, glm::dvec4(0.95), glm::dvec4(1.0)), {});
    expectPhysical(furnace, {});
    for (u32 i = 0; i < furnace.tree.patchCount(); ++i) EXPECT_NEAR(furnace.solution.radiosity[i].x / 20.0, 1.0, 5e-3);
    std::vector<Face> faces = room({8, 6, 5}, 6, glm::dvec4(0.95), glm::dvec4(0.0));
    std::erase_if(faces, [](const Face& face) { return face.group == 1; });
    const Daylight light = sunAt(150, 50);
    const LitScene court = lightFaces(faces, light);
    expectPhysical(court, light);
    const double in = court.flux([&](u32 i) { return court.sun[i] + court.sky[i]; });
    const double absorbed = court.flux([&](u32 i) { return 0.05 * court.irradiance(i); });
    const double out = court.flux([&](u32 i) { return court.solution.radiosity[i].x * court.sky[i] / light.dhi; });
    std::printf("absorbed %.2f %%, out %.2f %%\n", 100 * absorbed / in, 100 * out / in);
    EXPECT_NEAR((absorbed + out) / in, 1.0, 5e-3);
}

TEST(HardCases, OnePatchAlone)
{
    const Daylight light = sunAt(10, 30);
    const LitScene scene = lightFaces(grid({0, 0, 0}, kX, kY, 1, 1, {{}, 0}), light);
    EXPECT_NEAR(scene.sun[0], 400.0, 1e-9);
    EXPECT_NEAR(scene.sky[0], 120.0, 1e-9);
    EXPECT_EQ(scene.indirect(0), 0.0);
    EXPECT_NEAR(scene.solution.radiosity[0].x, 0.5 * 520.0, 1e-9);
    EXPECT_TRUE(scene.bake.links.column.empty());
}

TEST(HardCases, NoPatchAtAll)
{
    for (const LinkMethod method : {LinkMethod::Heliopolis, LinkMethod::Paper, LinkMethod::PaperLiteral}) {
        LightOptions options;
        options.method = method;
        const LightBake bake = bakeLight(NodeTree{}, options);
        EXPECT_EQ(bake.stats.linkCount, 0u);
        EXPECT_EQ(bake.sky.rowBegin, std::vector<u32>{0});
        EXPECT_EQ(bake.links.rowBegin, std::vector<u32>{0});
        EXPECT_TRUE(std::isfinite(bake.stats.linksPerPatch + bake.stats.closure.mean + bake.stats.closureDefect));
        EXPECT_TRUE(solveLight(NodeTree{}, bake.links, {}, {}, {}).indirect.empty());
    }
    const NodeTree none;
    const Visibility visibility(none);
    EXPECT_TRUE(raySun(none, visibility, kZ, 16).empty());
    EXPECT_TRUE(tracePaths(none, visibility, {.samples = 16}).patches.empty());
}

TEST(HardCases, FiveMillionMetresFromTheOrigin)
{
    // A grid of 1e-9 m there: rays near an edge may fall on its other side, nothing more.
    const Daylight light = sunAt(200, 35);
    std::vector<Face> faces = ground();
    append(faces, boxOutside({-10, -5, 0}, {10, 5, 10}, 5, 1));
    append(faces, turned(boxOutside({-4, 12, 0}, {9, 20, 14}, 4, 6), 0.4));
    const LitScene here = lightFaces(faces, light), there = lightFaces(moved(faces, {5e6, 5e6, 250.0}), light);
    expectPhysical(there, light);
    expectAllOfTheSun(there, light);
    expectSameLight(here, there, here.tree.patchCount(), 2);
}

TEST(HardCases, PatchOfAMillionthBesideOneOfTenThousandSquareMetres)
{
    // 1 mm x 1 mm of wall at the middle of a glowing floor of 100 x 100 m, its foot on it; a second one stands on the
    // floor's edge.
    std::vector<Face> faces = grid({0, -50, 0}, 100.0 * kX, 100.0 * kY, 1, 1, {{}, 0, glm::dvec4(0.5), glm::dvec4(1)});
    append(faces, grid({50, -0.0005, 0}, 0.001 * kY, 0.001 * kZ, 1, 1, {{}, 1}));
    append(faces, grid({0, -0.0005, 0}, 0.001 * kY, 0.001 * kZ, 1, 1, {{}, 2}));
    const Daylight light = sunAt(90, 30);
    const LitScene scene = lightFaces(faces, light);
    ASSERT_EQ(scene.tree.patchCount(), 3u);
    expectPhysical(scene, light);
    const double floor = scene.solution.radiosity[0].x;
    EXPECT_NEAR(floor, 1.0 + 0.5 * (400.0 + 120.0), 1e-3) << "two square millimetres change nothing";
    const double atMiddle = closedPerpendicular(0, 50, -50, 50, 0, 1e-3, -5e-4, 5e-4) * 5000.0 / 1e-6,
                 atEdge = closedPerpendicular(0, 100, -50, 50, 0, 1e-3, -5e-4, 5e-4) * 10000.0 / 1e-6;
    EXPECT_NEAR(atMiddle, 0.5, 1e-3);
    // Rays begin 0.1 mm above their surface in a scene of this size: here and there one of 64 goes wrong.
    EXPECT_NEAR(scene.indirect(1) / (floor * atMiddle), 1.0, 0.02);
    EXPECT_NEAR(scene.indirect(2) / (floor * atEdge), 1.0, 0.02);
    for (const u32 i : {1u, 2u}) {
        EXPECT_NEAR(scene.sun[i], 800.0 * std::cos(30.0 * kDegree), 1e-9);
        EXPECT_NEAR(scene.sky[i], 60.0, 0.5);
    }
}
