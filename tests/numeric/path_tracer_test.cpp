// SPDX-License-Identifier: Apache-2.0
// The path tracer against closed forms and against the scenes' own references, made by another renderer.
#include "city/light/path_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

#include "city/layout/surfaces.h"
#include "city/light/sun.h"
#include "city/model/build_nodes.h"
#include "tests/accuracy/csv_table.h"
#include "tests/numeric/fixtures.h"

using namespace helio;
using namespace helio::test;

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);
const glm::dvec4 kBlack(0.0);
constexpr double kDigits = 1e-5; // the references have six

PathReference trace(const NodeTree& tree, const PathOptions& options)
{
    const Visibility visibility(tree);
    const PathReference reference = tracePaths(tree, visibility, options);
    EXPECT_TRUE(reference.complete);
    EXPECT_EQ(reference.cutPaths, 0u);
    return reference;
}

/// A black receiver, patch 0, and an emitter of 1 W/m2: E_indirect of the receiver = its form factor to the emitter.
void expectFactor(const std::vector<Face>& faces, double factor)
{
    const PathReference r = trace(makeTree(faces), {.dni = 0.0, .dhi = 0.0, .samples = 65536});
    const PatchLight& light = r.patches[0];
    EXPECT_GT(light.indirectError.x, 0.0);
    EXPECT_LT(light.indirectError.x, 4e-3 * factor);
    EXPECT_NEAR(light.indirect.x, factor, 4.0 * light.indirectError.x);
}

/// Deviations from a reference in units of the standard error of both: their rms is 1 where the errors are honest and
/// nothing is biased.
struct Deviation
{
    double squares = 0.0, largest = 0.0, sum = 0.0, variance = 0.0;
    u32 count = 0;

    void add(double value, double expected, double error)
    {
        if (error < kDigits * (1.0 + expected)) {
            EXPECT_NEAR(value, expected, 4.0 * error + kDigits * (1.0 + expected));
            return;
        }
        const double z = (value - expected) / error;
        squares += z * z;
        raise(largest, std::abs(z));
        sum += value - expected;
        variance += error * error;
        ++count;
    }
    double rms() const { return std::sqrt(squares / count); }
    double meanInErrors() const { return sum / std::sqrt(variance); }
};

void judgeScene(const std::string& name, double azimuth, double elevation, bool emission,
                const std::function<bool(const CsvTable&, size_t)>& measured)
{
    const std::string base = std::string(HELIO_TEST_DATA) + "/scenes/" + name;
    const Result<ShapeTree> shapes = readSurfaces(base + ".obj", base + ".csv");
    ASSERT_TRUE(shapes.ok()) << shapes.error().message;
    const NodeTree tree = buildNodes(shapes.value(), {}).tree;
    const CsvTable reference = readCsvTable(base + ".reference.csv"), scene = readCsvTable(base + ".csv");
    const PathReference result = trace(
        tree, {.toSun = sunDirection(azimuth * kDegree, elevation * kDegree), .emission = emission, .samples = 1024});
    ASSERT_EQ(reference.rows, tree.patchCount());

    std::vector<double> indirect(reference.rows, 0.0), error(reference.rows, 0.0);
    std::vector<std::string> parts{"sun_ind_", "sky_ind_"};
    if (emission) parts.insert(parts.end(), {"em_dir_", "em_ind_"});
    for (const std::string& part : parts)
        for (size_t i = 0; i < reference.rows; ++i) {
            indirect[i] += reference.column(part + "g")[i];
            error[i] = std::hypot(error[i], reference.column(part + "se_g")[i]);
        }
    const std::vector<double> sun = reference.column("sun_dir_g"), sunError = reference.column("sun_dir_se_g"),
                              svf = reference.column("svf"), svfError = reference.column("svf_se");
    Deviation ofSun, ofSky, ofIndirect;
    for (u32 i = 0; i < tree.patchCount(); ++i) {
        const u32 face = tree.patches[i].sourceFace;
        if (!measured(scene, face)) continue;
        const PatchLight& light = result.patches[i];
        ofSun.add(light.sun, sun[face], std::hypot(light.sunError, sunError[face]));
        ofSky.add(light.sky.x, 120.0 * svf[face], std::hypot(light.skyError.x, 120.0 * svfError[face]));
        ofIndirect.add(light.indirect.y, indirect[face], std::hypot(light.indirectError.y, error[face]));
    }
    std::printf("%s, in standard errors:\n", name.c_str());
    for (const Deviation& d : {ofSun, ofSky, ofIndirect}) {
        if (d.count == 0) continue;
        std::printf("  rms %.2f, largest %.2f, mean %+.2f\n", d.rms(), d.largest, d.meanInErrors());
        // 31 degrees of freedom have wider tails than a normal distribution.
        EXPECT_LT(d.largest, 6.0);
        EXPECT_LT(d.rms(), 1.07 + 4.0 / std::sqrt(2.0 * d.count)) << d.count;
        EXPECT_LT(std::abs(d.meanInErrors()), 4.0);
    }
    ASSERT_GT(ofIndirect.count, 0u);
    EXPECT_GT(ofIndirect.rms(), 0.7) << "standard errors that are far too large hide every fault";
}

} // namespace

TEST(PathTracer, ParallelAndPerpendicularUnitSquares)
{
    std::vector<Face> faces = grid({0, 0, 0}, kX, kY, 1, 1, {{}, 0, kBlack});
    append(faces, grid({0, 0, 1}, kY, kX, 1, 1, {{}, 1, kBlack, glm::dvec4(1.0)}));
    expectFactor(faces, 0.19982489569838738);

    faces = grid({0, 0, 0}, kX, kY, 1, 1, {{}, 0, kBlack});
    append(faces, grid({0, 0, 0}, kY, kZ, 1, 1, {{}, 1, kBlack, glm::dvec4(1.0)}));
    expectFactor(faces, 0.20004377607540315);
}

TEST(PathTracer, BacksAreBlackAndBlock)
{
    std::vector<Face> faces = grid({0, 0, 0}, kX, kY, 1, 1, {{}, 0, kBlack});
    append(faces, grid({0, 0, 1}, kX, kY, 1, 1, {{}, 1, kBlack, glm::dvec4(1.0)})); // shines upwards
    append(faces, grid({-9, -9, 2}, 19.0 * kY, 19.0 * kX, 1, 1, {{}, 2, kBlack}));  // a roof over both
    const PathReference r = trace(makeTree(faces), {.samples = 256});
    EXPECT_EQ(r.patches[0].indirect, kBlack);
    EXPECT_EQ(r.patches[0].sun, 0.0);
    EXPECT_LT(r.patches[0].sky.x, 120.0);
}

TEST(PathTracer, FurnaceHasNoError)
{
    // Emission 1 W/m2 everywhere: E = 1 / (1 - rho), each channel with its own reflectance. Light that is the same
    // everywhere has no variance but that of the roulette.
    const glm::dvec4 rho(0.1, 0.5, 0.8, 0.95);
    const NodeTree tree = makeTree(room({3, 4, 5}, 2, rho, glm::dvec4(1.0)));
    const PathReference r = trace(tree, {.samples = 4096});
    Deviation deviation;
    for (const PatchLight& light : r.patches) {
        EXPECT_EQ(light.sun, 0.0);
        EXPECT_EQ(light.sky, kBlack);
        for (int c = 0; c < 4; ++c) {
            EXPECT_LT(light.indirectError[c], 0.02 / (1.0 - rho[c]));
            deviation.add(light.indirect[c], 1.0 / (1.0 - rho[c]), light.indirectError[c]);
        }
    }
    EXPECT_LT(deviation.largest, 5.0);
    EXPECT_LT(deviation.rms(), 1.4);
}

TEST(PathTracer, OpenGroundUnderSunAndSky)
{
    const NodeTree tree = makeTree(grid({0, 0, 0}, kX, kY, 1, 1, {{}, 0}));
    const glm::dvec3 toSun = sunDirection(2.0, 30.0 * kDegree);
    const PatchLight light = trace(tree, {.toSun = toSun, .samples = 64}).patches[0];
    EXPECT_NEAR(light.sun, 400.0, 1e-9);
    EXPECT_NEAR(light.sky.x, 120.0, 1e-9);
    EXPECT_EQ(light.indirect, kBlack);
    EXPECT_EQ(light.totalError, kBlack);
    const PatchLight night = trace(tree, {.toSun = -toSun, .samples = 64}).patches[0];
    EXPECT_EQ(night.sun, 0.0);
}

TEST(PathTracer, TheGroundBeyondIsLitBySunAndSky)
{
    // A wall at the edge of a flat city sees nothing of it; its back side faces the city.
    const glm::dvec4 rho(0.1, 0.2, 0.3, 0.4), ground(0.12, 0.2, 0.3, 0.5);
    std::vector<Face> faces = grid({0, 0, 0}, kY, kZ, 1, 1, {{}, 0, rho});
    append(faces, grid({-2000, -1000, 0}, 2000.0 * kX, 2000.0 * kY, 1, 1, {{}, 1, rho}));
    const glm::dvec3 toSun = sunDirection(-1.0, 30.0 * kDegree);
    const NodeTree tree = makeTree(faces);
    const PathReference r = trace(tree, {.toSun = toSun, .farGround = ground, .samples = 4096});
    for (int c = 0; c < 4; ++c)
        EXPECT_NEAR(r.patches[0].sky[c], 0.5 * 120.0 + 0.5 * ground[c] * (800.0 * 0.5 + 120.0), 1e-2);
    EXPECT_EQ(r.patches[0].indirect, kBlack);
    EXPECT_NEAR(r.patches[1].sky.x, 120.0, 0.1);
    // After a bounce: between two walls, light from below as strong as that from above doubles everything.
    faces = grid({0, -0.5, -0.5}, kY, kZ, 1, 1, {{}, 0, rho});
    append(faces, grid({1, -0.5, -0.5}, kZ, kY, 1, 1, {{}, 1, rho}));
    const NodeTree walls = makeTree(faces);
    const PatchLight both = trace(walls, {.dni = 0.0, .farGround = glm::dvec4(1.0), .samples = 65536}).patches[0];
    const PatchLight above = trace(walls, {.dni = 0.0, .samples = 65536}).patches[0];
    EXPECT_NEAR(both.indirect.w, 2.0 * above.indirect.w,
                5.0 * std::hypot(both.indirectError.w, 2.0 * above.indirectError.w));
    EXPECT_LT(above.indirectError.w, 0.02 * above.indirect.w);
}

TEST(PathTracer, FirstHandLightIsThatOfWholePaths)
{
    std::vector<Face> faces = room({4, 3, 5}, 3, glm::dvec4(0.5), glm::dvec4(0.0));
    std::erase_if(faces, [](const Face& face) { return face.group == 1; }); // no ceiling
    const NodeTree open = makeTree(faces);
    const PathOptions whole{.toSun = sunDirection(1.0, 60.0 * kDegree), .farGround = glm::dvec4(0.2), .samples = 256};
    PathOptions firstHand = whole;
    firstHand.firstHand = true;
    const PathReference a = trace(open, whole), b = trace(open, firstHand);
    for (u32 i = 0; i < open.patchCount(); ++i) {
        EXPECT_EQ(b.patches[i].sun, a.patches[i].sun);
        EXPECT_EQ(b.patches[i].sky, a.patches[i].sky);
        EXPECT_EQ(b.patches[i].indirect, kBlack);
    }
    EXPECT_GT(a.patches[0].sky.w, 1.0);
    EXPECT_GT(a.patches[0].indirect.w, 1.0);
    EXPECT_LT(b.rays, a.rays / 2);
}

TEST(PathTracer, TheSunIsADisc)
{
    const double radius = 0.26667 * kDegree, pi = std::numbers::pi;
    // On edge: 2 / (3 pi) radius. A quarter of a degree from a wall's plane nothing is left of the point either way.
    const NodeTree wall = makeTree(grid({0, 0, 0}, kY, kZ, 1, 1, {{}, 0}));
    const auto sunOn = [&](const NodeTree& tree, double azimuth, double elevation, double disc) {
        return trace(tree, {.toSun = sunDirection(azimuth * kDegree, elevation * kDegree),
                            .dni = 1000.0,
                            .sunRadius = disc,
                            .dhi = 0.0,
                            .samples = 65536})
            .patches[0];
    };
    const PatchLight edge = sunOn(wall, 180.0, 0.5, radius);
    EXPECT_NEAR(edge.sun, 1000.0 * 2.0 / (3.0 * pi) * radius, 5.0 * edge.sunError);
    EXPECT_LT(edge.sunError, 0.01 * edge.sun);
    EXPECT_EQ(sunOn(wall, 180.0, 0.5, 0.0).sun < 1e-9, true);
    EXPECT_EQ(sunOn(wall, 180.3, 0.5, radius).sun, 0.0);
    // The horizon cuts it: half of the disc, on a wall that faces it and on the ground.
    const PatchLight facing = sunOn(wall, 90.0, 0.0, radius);
    EXPECT_NEAR(facing.sun, 500.0, 5.0 * facing.sunError);
    // A shadow's edge across a patch that holds all of its penumbra moves no light out of it; along the patch's border
    // it does: a border of 0.21 of the penumbra's half width is exchanged.
    std::vector<Face> faces = grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, 1, {{}, 0});
    append(faces, grid({-20, -20, 10}, {20, 0, 0}, {0, 40, 0}, 1, 1, {{}, 1}));
    const NodeTree halved = makeTree(faces);
    const PatchLight point = sunOn(halved, 0.0, 90.0, 0.0), disc = sunOn(halved, 0.0, 90.0, radius);
    EXPECT_NEAR(point.sun, 500.0, 1.0);
    EXPECT_NEAR(disc.sun, point.sun, 5.0 * std::hypot(point.sunError, disc.sunError));
    faces[0].ring = grid({0, -1, 0}, {1, 0, 0}, {0, 2, 0}, 1, 1, {{}, 0})[0].ring;
    const NodeTree beside = makeTree(faces);
    const double width = 10.0 * radius; // half of the penumbra, m
    const PatchLight border = sunOn(beside, 0.0, 90.0, radius);
    EXPECT_NEAR(border.sun, 1000.0 * (1.0 - 2.0 / (3.0 * pi) * width), 5.0 * border.sunError + 0.05);
}

TEST(PathTracer, ErrorFallsWithTheRootOfThePaths)
{
    std::vector<Face> faces = room({3, 4, 5}, 1, glm::dvec4(0.5), kBlack);
    faces[0].emission = glm::dvec4(1.0);
    const NodeTree lit = makeTree(faces);
    const auto meanVariance = [&](u32 samples) {
        double sum = 0.0;
        for (u64 seed = 1; seed <= 8; ++seed)
            for (const PatchLight& light : trace(lit, {.samples = samples, .seed = seed}).patches)
                sum += light.indirectError.x * light.indirectError.x;
        return sum;
    };
    // 256 times the paths: 16 times less error, or a little less than that, for the strata.
    const double ratio = std::sqrt(meanVariance(64) / meanVariance(16384));
    EXPECT_GT(ratio, 14.0);
    EXPECT_LT(ratio, 40.0);
}

TEST(PathTracer, TheSameForAnyNumberOfThreadsAndStopsWhenTold)
{
    const NodeTree tree = makeTree(room({3, 4, 5}, 4, glm::dvec4(0.5), glm::dvec4(1.0)));
    const PathReference one = trace(tree, {.samples = 40, .jobs = 1}), four = trace(tree, {.samples = 40, .jobs = 4});
    EXPECT_EQ(one.samples, 40u);
    EXPECT_EQ(one.rays, four.rays);
    for (u32 i = 0; i < tree.patchCount(); ++i) {
        EXPECT_EQ(one.patches[i].indirect, four.patches[i].indirect);
        EXPECT_EQ(one.patches[i].indirectError, four.patches[i].indirectError);
    }
    const Visibility visibility(tree);
    const PathReference stopped =
        tracePaths(tree, visibility, {.samples = 40, .jobs = 1, .progress = [](double) { return false; }});
    EXPECT_FALSE(stopped.complete);
    EXPECT_EQ(stopped.patches.back().indirect, kBlack);
}

TEST(PathTracer, StreetCanyonAgainstAnotherRenderer)
{
    judgeScene("canyon", 120, 50, false, [](const CsvTable& s, size_t row) { return s.column("bay")[row] == 1.0; });
}

TEST(PathTracer, TwoBoxesAgainstAnotherRenderer)
{
    judgeScene("twobox", 150, 40, true, [](const CsvTable&, size_t) { return true; });
}
