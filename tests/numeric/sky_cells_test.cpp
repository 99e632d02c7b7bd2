// SPDX-License-Identifier: Apache-2.0
// What it costs that a sky is known by cells: walls with nothing before them against the continuous sky, and a city
// against 4,096 cells and the same rays. Prints the tables of city/sky/README.md.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

#include "city/layout/surfaces.h"
#include "city/light/sky.h"
#include "city/light/sun.h"
#include "city/model/build_nodes.h"
#include "city/sky/sky_model.h"
#include "tests/numeric/sky_sum.h"

namespace helio::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

struct NamedSky
{
    std::string name;
    SkyShape shape;
};

NamedSky clear(double azimuth, double elevation)
{
    return {concat("CIE 12, sun ", azimuth, "/", elevation),
            cieSky(12, sunDirection(azimuth * kDegree, elevation * kDegree))};
}

NamedSky perez(double dni, double dhi, double azimuth, double elevation)
{
    return {concat("Perez ", dni, "/", dhi, ", sun ", azimuth, "/", elevation),
            perezSky(dni, dhi, kSolarConstant, sunDirection(azimuth * kDegree, elevation * kDegree))};
}

/// Irradiance of eight open walls under some radiance of the sky, by fine quadrature.
template <class Radiance> std::array<double, 8> onWalls(const Radiance& radiance)
{
    constexpr int kHeights = 300, kTurns = 1200;
    std::array<double, 8> sums{};
    for (int i = 0; i < kHeights; ++i)
        for (int k = 0; k < kTurns; ++k) {
            const double z = (i + 0.5) / kHeights, r = std::sqrt(1.0 - z * z);
            const double phi = 2.0 * std::numbers::pi * (k + 0.5) / kTurns;
            const double value = radiance(glm::dvec3(r * std::cos(phi), r * std::sin(phi), z));
            for (int w = 0; w < 8; ++w)
                sums[size_t(w)] += value * r * std::max(0.0, std::cos(phi - w * 45.0 * kDegree));
        }
    for (double& sum : sums) sum *= 2.0 * std::numbers::pi / (kHeights * kTurns);
    return sums;
}

/// Largest relative error of the eight walls.
double worstWall(const SkyShape& shape, u32 cells, bool linear)
{
    double horizontal = 0.0;
    const SkyDome fine(SkyDome::kMaxCells);
    for (u32 cell = 0; cell < fine.cellCount(); ++cell)
        for (const double u : {0.125, 0.375, 0.625, 0.875})
            for (const double v : {0.125, 0.375, 0.625, 0.875}) {
                const glm::dvec3 d = fine.pointOf(cell, u, v);
                horizontal += shape(d) * d.z * fine.solidAngle() / 16.0;
            }
    const SkyDome dome(cells);
    const std::vector<CellSky> sky = domeRadiance(dome, shape, horizontal, linear);
    const auto truth = onWalls(shape);
    const auto byCells = onWalls([&](const glm::dvec3& d) {
        const u32 cell = dome.cellOf(d);
        return sky[cell].mean + glm::dot(sky[cell].slope, dome.placeIn(cell, d));
    });
    double worst = 0.0;
    for (size_t w = 0; w < 8; ++w) worst = std::max(worst, std::abs(byCells[w] / truth[w] - 1.0));
    return worst;
}

TEST(SkyCells, OpenWallsUnderLinearCells)
{
    const NamedSky skies[] = {{"overcast", cieSky(16, {0, 0, 1})}, clear(160, 34), perez(800, 100, 160, 34)};
    for (const u32 cells : {24u, 48u, 64u, 96u, 145u}) {
        std::printf("| %u |", cells);
        for (const NamedSky& sky : skies)
            std::printf(" %.2f, %.2f |", 100.0 * worstWall(sky.shape, cells, false),
                        100.0 * worstWall(sky.shape, cells, true));
        std::printf("\n");
    }
    for (const NamedSky& sky : skies) EXPECT_LT(worstWall(sky.shape, 48, true), 1e-3) << sky.name;
    EXPECT_LT(worstWall(skies[0].shape, 24, true), 2e-4) << "it is linear in height";
}

TEST(SkyCells, GridCityOfFourBuildings)
{
    const std::string base = std::string(HELIO_TEST_DATA) + "/scenes/S";
    const Result<ShapeTree> shapes = readSurfaces(base + ".obj", base + ".csv");
    ASSERT_TRUE(shapes.ok());
    const NodeTree tree = buildNodes(shapes.value(), {}).tree;
    const Visibility visibility(tree);
    const u32 domes[] = {24, 48, 64, 96, 145};
    const SkyDome fine(SkyDome::kMaxCells);
    const SkyScan truth = scanSky(tree, visibility, 1024, 1, 0, {}, fine);
    std::vector<SkyScan> scans;
    for (const u32 cells : domes) {
        scans.push_back(scanSky(tree, visibility, 1024, 1, 0, {}, SkyDome(cells)));
        std::printf("%u cells: %.1f sky links a patch\n", cells,
                    double(scans.back().links.column.size()) / tree.patchCount());
    }
    std::vector<NamedSky> skies;
    for (const auto& [azimuth, elevation] : {std::pair{150.0, 40.0}, {235.0, 18.0}, {100.0, 62.0}})
        for (const NamedSky& sky :
             {clear(azimuth, elevation), perez(800, 100, azimuth, elevation), perez(400, 200, azimuth, elevation)})
            skies.push_back(sky);
    for (const NamedSky& sky : skies) {
        std::printf("| %s |", sky.name.c_str());
        const std::vector<CellSky> radiance = domeRadiance(fine, sky.shape, 100.0);
        for (size_t d = 0; d < scans.size(); ++d) {
            double rms[2] = {};
            for (const bool linear : {false, true}) {
                const std::vector<CellSky> coarse = domeRadiance(SkyDome(domes[d]), sky.shape, 100.0, linear);
                double squares = 0.0, mean = 0.0, area = 0.0;
                for (u32 i = 0; i < tree.patchCount(); ++i) {
                    const double expected = skyIrradiance(truth.links, i, radiance), a = tree.patches[i].area;
                    const double error = skyIrradiance(scans[d].links, i, coarse) - expected;
                    squares += a * error * error, mean += a * expected, area += a;
                }
                rms[linear] = std::sqrt(squares / area) / (mean / area);
            }
            std::printf(" %.2f, %.2f |", 100.0 * rms[0], 100.0 * rms[1]);
            if (domes[d] == 48) {
                EXPECT_LT(rms[1], 5e-3) << sky.name;
            }
        }
        std::printf("\n");
    }
}

} // namespace
} // namespace helio::test
