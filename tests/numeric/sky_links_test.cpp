// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "city/light/bake_light.h"
#include "city/light/sky.h"
#include "city/sky/sky_model.h"
#include "tests/numeric/fixtures.h"
#include "tests/numeric/sky_sum.h"

namespace helio::test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Open ground, a wall that nothing obstructs, and the same wall behind an endless parallel one.
enum Patch : u32
{
    kGround,
    kWall,
    kHidden,
    kScreen
};

NodeTree openScene()
{
    std::vector<Face> faces;
    append(faces, grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1, {{}, 0}));
    append(faces, grid({50, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}, 1, 1, {{}, 1}));
    // Across 1000 m the top of a wall of 577.35 m stands at 30 degrees; seen from it the scene above lies at its foot.
    append(faces, grid({0, 9e5, 0}, {0, 0.1, 0}, {0, 0, 0.1}, 1, 1, {{}, 2}));
    append(faces, grid({1000, 1.3e6, 0}, {0, -8e5, 0}, {0, 0, 1000 / std::sqrt(3.0)}, 1, 1, {{}, 3}));
    return makeTree(faces);
}

double irradiance(const SkyTable& table, u32 patch, const std::vector<double>& radiance)
{
    std::vector<CellSky> cells;
    for (const double value : radiance) cells.push_back({value, {}});
    return skyIrradiance(table, patch, cells);
}

TEST(SkyLinks, UniformSkyDoesNotDependOnTheDome)
{
    const NodeTree tree = openScene();
    const Visibility visibility(tree);
    const SkyScan one = scanSky(tree, visibility, 1024, 1, 1, {});
    ASSERT_EQ(one.links.skyPatches.size(), 1u);
    EXPECT_EQ(one.links.skyPatches[0].direction, glm::vec3(0, 0, 1));
    for (const u32 cells : {5u, 145u, 577u}) {
        const SkyDome dome(cells);
        const SkyScan scan = scanSky(tree, visibility, 1024, 1, 0, {}, dome);
        ASSERT_EQ(scan.links.skyPatches.size(), cells);
        ASSERT_EQ(scan.links.rowBegin.size(), tree.patchCount() + 1);
        const std::vector<double> uniform(cells, 100.0 / kPi);
        for (u32 i = 0; i < tree.patchCount(); ++i) {
            EXPECT_EQ(scan.sky[i], one.sky[i]);
            EXPECT_NEAR(irradiance(scan.links, i, uniform), 100.0 * double(one.sky[i]), 1e-10) << cells << " " << i;
            for (u32 k = scan.links.rowBegin[i] + 1; k < scan.links.rowBegin[i + 1]; ++k)
                EXPECT_LT(scan.links.column[k - 1], scan.links.column[k]);
        }
    }
}

TEST(SkyLinks, FactorsAreTheCellsProjectedSolidAngles)
{
    const NodeTree tree = openScene();
    const Visibility visibility(tree);
    const SkyDome dome(29);
    const SkyScan scan = scanSky(tree, visibility, 65536, 1, 0, {}, dome);
    ASSERT_EQ(scan.links.rowBegin[kGround + 1] - scan.links.rowBegin[kGround], 29u);
    for (u32 cell = 0; cell < 29; ++cell)
        EXPECT_NEAR(double(scan.links.factor[scan.links.rowBegin[kGround] + cell]),
                    dome.projectedSolidAngle(cell) / kPi, 5e-4)
            << cell;
    // The wall faces +x: it sees no cell that lies wholly behind it.
    for (u32 k = scan.links.rowBegin[kWall]; k < scan.links.rowBegin[kWall + 1]; ++k) {
        const u32 cell = scan.links.column[k];
        double foremost = -1.0;
        for (const double u : {0.0, 0.5, 1.0})
            for (const double v : {0.0, 1.0}) foremost = std::max(foremost, dome.pointOf(cell, u, v).x);
        EXPECT_GT(foremost, 0.0) << cell;
    }
}

TEST(SkyLinks, OvercastSkyOnGroundAndWalls)
{
    // Vertical to horizontal under (1 + 2 sin g) / 3: 0.396177078 in the open, 0.243561 behind an obstruction of 30
    // degrees. One radiance a cell costs 0.6 % with 145, a quarter of that with 577; a linear one nothing to speak of,
    // also where the obstruction cuts cells: this sky is linear in height. What is left behind the obstruction is the
    // floats of a scene of a thousand kilometres.
    const NodeTree tree = openScene();
    const Visibility visibility(tree);
    const struct
    {
        u32 cells;
        bool linear;
        double tolerance, behind;
    } domes[] = {{145, false, 8e-3, 13e-3}, {577, false, 3e-3, 8e-3}, {48, true, 1e-4, 2e-3}, {24, true, 1e-4, 2e-3}};
    for (const auto& row : domes) {
        const SkyDome dome(row.cells);
        const SkyScan scan = scanSky(tree, visibility, 65536, 1, 0, {}, dome);
        const std::vector<CellSky> radiance = domeRadiance(dome, cieSky(16, {0, 0, 1}), 100.0, row.linear);
        EXPECT_NEAR(skyIrradiance(scan.links, kGround, radiance), 100.0, row.linear ? 5e-3 : 0.05);
        EXPECT_NEAR(skyIrradiance(scan.links, kWall, radiance) / 39.6177078, 1.0, row.tolerance) << row.cells;
        EXPECT_NEAR(skyIrradiance(scan.links, kHidden, radiance) / 24.3561, 1.0, row.behind) << row.cells;
    }
}

TEST(SkyLinks, AWallAtTheEdgeOfAFlatCityIsLitByTheGroundBeyond)
{
    // It sees nothing of the city, half of the sky, and half of the plain: rho / 2 (DNI sin(elevation) + DHI).
    std::vector<Face> faces = grid({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1, 1, {{}, 0});
    append(faces, grid({-1000, -500, 0}, {1000, 0, 0}, {0, 1000, 0}, 1, 1, {{}, 1}));
    append(faces, grid({0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 1, 1, {{}, 2}));
    const NodeTree tree = makeTree(faces);
    const glm::dvec4 rho(0.12, 0.2, 0.3, 0.4);
    for (const u32 cells : {1u, 48u}) {
        const LightBake bake = bakeLight(tree, {.skyPatches = cells, .farGround = rho});
        ASSERT_EQ(bake.sky.skyPatches.size(), cells + 1);
        EXPECT_EQ(bake.sky.skyPatches[cells].direction, glm::vec3(0, 0, -1));
        EXPECT_EQ(bake.sky.skyPatches[cells].rho, glm::vec4(rho));
        EXPECT_EQ(bake.sky.skyPatches[0].rho, glm::vec4(0.0f));
        std::vector<double> radiance(cells + 1, 0.0);
        radiance[cells] = rho.y / kPi * (800.0 * 0.5 + 120.0);
        EXPECT_NEAR(irradiance(bake.sky, 0, radiance), 0.5 * rho.y * 520.0, 0.01 * 0.5 * rho.y * 520.0);
        EXPECT_EQ(irradiance(bake.sky, 1, radiance), 0.0) << "the city's ground lies in the plain";
        // Towards the city: its ground takes part of what is below the horizon, the plain beyond the rest.
        EXPECT_LT(irradiance(bake.sky, 2, radiance), 0.02 * 0.5 * rho.y * 520.0);
        radiance.assign(cells + 1, 1.0 / kPi);
        EXPECT_NEAR(irradiance(bake.sky, 0, radiance), 1.0, 1e-6) << "nothing is lost";
        EXPECT_TRUE(bake.stats.farGround);
        EXPECT_NEAR(bake.stats.closure.mean, 1.0, 2e-3);
        EXPECT_NEAR(bake.stats.below.max, 0.5, 5e-3);
    }
    EXPECT_EQ(bakeLight(tree, {.skyPatches = 48}).sky.skyPatches.size(), 48u);
}

TEST(SkyLinks, BakeChoosesTheDome)
{
    const NodeTree tree = openScene();
    EXPECT_EQ(bakeLight(tree, {.raysPerPatch = 16, .skyPatches = 0}).sky.skyPatches.size(), 48u);
    EXPECT_EQ(bakeLight(tree, {.raysPerPatch = 16, .skyPatches = 12}).sky.skyPatches.size(), 12u);
    EXPECT_EQ(autoSkyPatches(200'000), 48u);
    EXPECT_EQ(autoSkyPatches(200'001), 24u);
}

TEST(SkyLinks, SameForAnyNumberOfThreads)
{
    const NodeTree tree = makeTree(room({4, 4, 4}, 12, glm::dvec4(0.5), glm::dvec4(0.0)));
    std::vector<Face> faces = grid({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}, 30, 30, {{}, 0});
    append(faces, moved(grid({0, 0, 0}, {0, 4, 0}, {0, 0, 8}, 4, 8, {{}, 1}), {2, 2, 0}));
    const NodeTree open = makeTree(faces);
    const Visibility visibility(open);
    const SkyScan a = scanSky(open, visibility, 128, 7, 1, {}, SkyDome(145));
    const SkyScan b = scanSky(open, visibility, 128, 7, 3, {}, SkyDome(145));
    EXPECT_EQ(a.links.rowBegin, b.links.rowBegin);
    EXPECT_EQ(a.links.column, b.links.column);
    EXPECT_EQ(a.links.factor, b.links.factor);
    EXPECT_EQ(a.links.offset, b.links.offset);
    EXPECT_EQ(a.links.offset.size(), a.links.column.size());
    EXPECT_GT(a.links.column.size(), 900u);
    // A closed room has rows without links.
    const Visibility inside(tree);
    const SkyScan dark = scanSky(tree, inside, 128, 7, 2, {}, SkyDome(145));
    EXPECT_EQ(dark.links.rowBegin, std::vector<u32>(tree.patchCount() + 1, 0));
}

} // namespace
} // namespace helio::test
