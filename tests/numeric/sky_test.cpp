// SPDX-License-Identifier: Apache-2.0
#include "city/sky/sky_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace helio {
namespace {

constexpr double kPi = std::numbers::pi;

glm::dvec3 direction(double azimuthDeg, double zenithDeg)
{
    const double a = azimuthDeg * kPi / 180.0, z = zenithDeg * kPi / 180.0;
    return {std::sin(a) * std::sin(z), std::cos(a) * std::sin(z), std::cos(z)};
}

/// Irradiance from the sky whose profile angle about the y axis lies in [from, to], on a plane with the given normal.
/// A direction has the profile angle psi and the angle tau to the xz plane.
double profileIrradiance(const SkyShape& sky, const glm::dvec3& normal, double from, double to)
{
    constexpr int kSteps = 400;
    const double dPsi = (to - from) / kSteps, dTau = kPi / kSteps;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k) {
            const double psi = from + (i + 0.5) * dPsi, tau = -kPi / 2 + (k + 0.5) * dTau;
            const glm::dvec3 d(std::cos(tau) * std::cos(psi), std::sin(tau), std::cos(tau) * std::sin(psi));
            sum += sky(d) * std::max(0.0, d.x * normal.x + d.y * normal.y + d.z * normal.z) * std::cos(tau);
        }
    return sum * dPsi * dTau;
}

TEST(SkyDome, CellsTileTheHemisphereEvenly)
{
    for (const u32 count : {1u, 2u, 3u, 5u, 8u, 29u, 64u, 145u, 577u, 4096u}) {
        const SkyDome dome(count);
        ASSERT_EQ(dome.cellCount(), count);
        EXPECT_NEAR(dome.solidAngle() * count, 2.0 * kPi, 1e-12);
        double projected = 0.0;
        for (u32 cell = 0; cell < count; ++cell) {
            projected += dome.projectedSolidAngle(cell);
            for (const double u : {0.01, 0.5, 0.99})
                for (const double v : {0.01, 0.5, 0.99})
                    EXPECT_EQ(dome.cellOf(dome.pointOf(cell, u, v)), cell) << count << " cells";
            EXPECT_EQ(dome.cellOf(dome.centreOf(cell)), cell);
            const glm::dvec3 direction = dome.pointOf(cell, 0.3, 0.8);
            const SkyDome::Place place = dome.placeOf(direction);
            EXPECT_EQ(place.cell, cell);
            EXPECT_EQ(place.inside, dome.placeIn(cell, direction));
        }
        EXPECT_NEAR(projected, kPi, 1e-12);
    }
    EXPECT_EQ(SkyDome(1).solidAngle(), 2.0 * kPi);
    EXPECT_EQ(SkyDome(1).projectedSolidAngle(0), kPi);
    EXPECT_EQ(SkyDome(145).cellOf({0.0, 0.0, 1.0}), 0u);
    EXPECT_EQ(SkyDome(145).cellOf({1.0, -1e-300, 1e-300}), 144u) << "turn of exactly 1";
}

TEST(SkyDome, CellsAreCompact)
{
    // No point of a cell is further from its centre than a square cell's corner would be, times 1.5.
    for (const u32 count : {16u, 64u, 145u, 577u}) {
        const SkyDome dome(count);
        const double corner = std::sqrt(dome.solidAngle() / 2.0);
        for (u32 cell = 0; cell < count; ++cell)
            for (const double u : {0.0, 1.0})
                for (const double v : {0.0, 1.0})
                    EXPECT_LT(glm::distance(dome.pointOf(cell, u, v), dome.centreOf(cell)), 1.5 * corner)
                        << count << " cells, cell " << cell;
    }
}

TEST(SkyDome, PlacesInACell)
{
    for (const u32 count : {2u, 5u, 64u, 577u}) {
        const SkyDome dome(count);
        for (u32 cell = 1; cell < count; ++cell)
            for (const double u : {0.01, 0.3, 0.99})
                for (const double v : {0.01, 0.6, 0.99}) {
                    const glm::dvec2 place = dome.placeIn(cell, dome.pointOf(cell, u, v));
                    EXPECT_NEAR(place.x, u - 0.5, 1e-9) << count << " cells, cell " << cell;
                    EXPECT_NEAR(place.y, v - 0.5, 1e-9) << count << " cells, cell " << cell;
                }
        // The cap: x and y over its width. Integrals over every cell, by midpoints.
        const glm::dvec2 rim = dome.placeIn(0, dome.pointOf(0, 0.125, 1.0));
        EXPECT_NEAR(rim.x, 0.5 * std::sqrt(0.5), 1e-9);
        EXPECT_NEAR(rim.y, 0.5 * std::sqrt(0.5), 1e-9);
        for (const u32 cell : {0u, count / 2, count - 1}) {
            glm::dvec2 sum(0.0);
            constexpr int kSteps = 200;
            for (int i = 0; i < kSteps; ++i)
                for (int k = 0; k < kSteps; ++k) {
                    const glm::dvec3 d = dome.pointOf(cell, (i + 0.5) / kSteps, (k + 0.5) / kSteps);
                    sum += d.z * dome.placeIn(cell, d);
                }
            sum *= dome.solidAngle() / (kSteps * kSteps);
            EXPECT_NEAR(sum.x, 0.0, 1e-9);
            EXPECT_NEAR(sum.y, dome.projectedHeight(cell), 1e-5 * dome.solidAngle());
        }
    }
}

TEST(SkyModel, CieCheckValues)
{
    // colour-science, Kittler's general sky: zenith angle 45, sun at 30, azimuths 180 degrees apart.
    const glm::dvec3 sun = direction(0, 30), at = direction(180, 45), zenith(0, 0, 1);
    EXPECT_NEAR(cieSky(1, sun)(at) / cieSky(1, sun)(zenith), 0.8325846, 1e-7);
    EXPECT_NEAR(cieSky(12, sun)(at) / cieSky(12, sun)(zenith), 0.4544524, 1e-7);
    for (u32 type = 1; type <= 5; type += 2) // 1, 3, 5: no dependence on the sun
        EXPECT_NEAR(cieSky(type, sun)(at), cieSky(type, direction(77, 80))(at), 1e-12) << type;
    EXPECT_NEAR(cieSky(5, sun)(at), cieSky(5, sun)(direction(10, 89)), 1e-12) << "type 5 is uniform";
    EXPECT_EQ(cieSky(12, -zenith)(at), cieSky(12, direction(90, 90))(at)) << "a sun below the horizon is put on it";
}

TEST(SkyModel, TraditionalOvercastBehindObstructions)
{
    const SkyShape sky = cieSky(16, {0, 0, 1});
    const glm::dvec3 wall(1, 0, 0), up(0, 0, 1);
    const double horizontal = profileIrradiance(sky, up, 0.0, kPi);
    EXPECT_NEAR(horizontal, 7.0 * kPi / 9.0, 1e-4); // of unit radiance at the zenith
    const struct
    {
        double obstructionDeg, ratio;
    } walls[] = {{0, 0.396177078}, {10, 0.353482}, {20, 0.301610}, {25, 0.273129},
                 {30, 0.243561},   {45, 0.153709}, {60, 0.074182}};
    for (const auto& row : walls)
        EXPECT_NEAR(profileIrradiance(sky, wall, row.obstructionDeg * kPi / 180.0, kPi / 2) / horizontal, row.ratio,
                    1e-4)
            << row.obstructionDeg;
    const struct
    {
        double heightOverWidth, ratio;
    } canyons[] = {{0.5, 0.770651}, {1, 0.505843}, {2, 0.278659}};
    for (const auto& row : canyons) {
        const double edge = std::atan(2.0 * row.heightOverWidth);
        EXPECT_NEAR(profileIrradiance(sky, up, edge, kPi - edge) / horizontal, row.ratio, 1e-4) << row.heightOverWidth;
    }
}

TEST(SkyModel, PerezParametersOfGendaylit)
{
    // Radiance's gendaylit -ang ELEVATION 0 -W DNI DHI -O 1, its five parameters; it takes 1367 W/m2 and, without a
    // date, the eccentricity of the first of January, 1.03505 (Spencer 1971).
    struct Row
    {
        double elevation, dni, dhi, a, b, c, d, e;
    };
    const Row rows[] = {{45, 2, 150, 0.941023, -0.590334, 0.511848, -0.409556, -0.031017},
                        {45, 30, 200, -1.373014, -0.815314, 8.384407, -2.318136, 0.204070},
                        {45, 120, 240, -1.080193, -0.720542, 11.973021, -3.358152, 0.105771},
                        {45, 250, 250, -0.998214, -0.667115, 13.640249, -3.191607, 0.178732},
                        {45, 400, 200, -1.014863, -0.514322, 14.077688, -3.278168, 0.029915},
                        {45, 600, 100, -0.973404, -0.206849, 15.047479, -3.921188, 0.619500},
                        {45, 850, 70, -0.977848, -0.179717, 19.490973, -5.946360, 1.155901},
                        {12, 300, 60, -0.952429, -0.273629, 12.167947, -3.321733, 0.059128}};
    for (const Row& row : rows) {
        const SkyShape sky = perezSky(row.dni, row.dhi, 1367.0 * 1.03505, direction(180, 90 - row.elevation));
        EXPECT_NEAR(sky.a, row.a, 5e-5) << row.dni;
        EXPECT_NEAR(sky.b, row.b, 5e-5) << row.dni;
        EXPECT_NEAR(sky.c, row.c, 2e-4) << row.dni;
        EXPECT_NEAR(sky.d, row.d, 5e-5) << row.dni;
        EXPECT_NEAR(sky.e, row.e, 5e-5) << row.dni;
    }
}

TEST(SkyModel, EveryDomeGivesTheIrradianceAskedFor)
{
    for (const u32 count : {1u, 5u, 64u, 145u, 577u}) {
        const SkyDome dome(count);
        const auto check = [&](const SkyShape& shape, double dhi) {
            double sum = 0.0;
            for (const bool linear : {false, true}) {
                sum = 0.0;
                const std::vector<CellSky> radiance = domeRadiance(dome, shape, dhi, linear);
                for (u32 cell = 0; cell < count; ++cell) {
                    const CellSky& sky = radiance[cell];
                    EXPECT_GE(sky.mean, 0.5 * (std::abs(sky.slope.x) + std::abs(sky.slope.y)) - 1e-12);
                    sum += sky.mean * dome.projectedSolidAngle(cell) + sky.slope.y * dome.projectedHeight(cell);
                }
                EXPECT_NEAR(sum, dhi, 1e-12 * dhi);
            }
        };
        for (const double zenith : {0.0, 50.0, 89.0, 95.0}) {
            const glm::dvec3 sun = direction(200, zenith);
            for (u32 type = 1; type <= 16; ++type) check(cieSky(type, sun), 120.0);
            for (const double dni : {0.0, 20.0, 60.0, 150.0, 400.0, 800.0, 1000.0})
                for (const double dhi : {5.0, 60.0, 200.0, 500.0}) check(perezSky(dni, dhi, kSolarConstant, sun), dhi);
        }
        for (const CellSky& sky : domeRadiance(dome, SkyShape{}, 120.0)) EXPECT_NEAR(sky.mean, 120.0 / kPi, 1e-12);
        for (const CellSky& sky : domeRadiance(dome, SkyShape{}, 0.0)) EXPECT_EQ(sky.mean, 0.0);
    }
}

TEST(SkyModel, ReadsItsName)
{
    EXPECT_EQ(parseSky("uniform")->kind, SkyKind::Uniform);
    EXPECT_EQ(parseSky("perez")->kind, SkyKind::Perez);
    EXPECT_EQ(parseSky("cie:16")->cieType, 16u);
    EXPECT_EQ(parseSky("cie:3")->kind, SkyKind::Cie);
    for (const char* text : {"", "cie", "cie:", "cie:0", "cie:17", "cie:1x", "cie:-1", "Uniform", "cie:99999999999"})
        EXPECT_FALSE(parseSky(text).ok()) << text;
    EXPECT_EQ(parseSky("blue").error().message, "sky blue: expected uniform, cie:N with N of 1 to 16, or perez");
}

} // namespace
} // namespace helio
