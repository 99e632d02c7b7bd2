// SPDX-License-Identifier: Apache-2.0
// Whole solutions against the reference path tracer (tests/data/scenes/README.md); sun by shadow rays, so that what is
// judged are the links, the sky and the solver.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

#include "city/layout/surfaces.h"
#include "city/light/bake_light.h"
#include "city/light/error_metrics.h"
#include "city/light/reference_solver.h"
#include "city/light/sun.h"
#include "city/model/build_nodes.h"
#include "tests/accuracy/csv_table.h"
#include "tests/numeric/fixtures.h"

using namespace helio;
using namespace helio::test;

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kDni = 800.0, kDhi = 120.0; // W/m2, of the scenes
const char* const kChannels[] = {"r", "g", "b"};

struct Scene
{
    NodeTree tree;
    LightBake bake;
    CsvTable reference;
    std::vector<bool> keep;

    std::vector<double> perFace(const std::vector<glm::dvec4>& values, u32 channel) const
    {
        std::vector<double> out(tree.patchCount());
        for (u32 i = 0; i < tree.patchCount(); ++i) out[tree.patches[i].sourceFace] = values[i][channel];
        return out;
    }
};

Scene readScene(const std::string& name)
{
    const std::string base = std::string(HELIO_TEST_DATA) + "/scenes/" + name;
    Scene scene;
    const Result<ShapeTree> shapes = readSurfaces(base + ".obj", base + ".csv");
    EXPECT_TRUE(shapes.ok()) << (shapes.ok() ? "" : shapes.error().message);
    scene.tree = buildNodes(shapes.value(), {}).tree;
    scene.bake = bakeLight(scene.tree, {});
    scene.reference = readCsvTable(base + ".reference.csv");
    scene.keep.assign(scene.reference.rows, true);
    EXPECT_EQ(scene.reference.rows, scene.tree.patchCount());
    std::printf("%s: %u patches, %.1f links each, closure %.4f .. %.4f\n", name.c_str(), scene.tree.patchCount(),
                scene.bake.stats.linksPerPatch, scene.bake.stats.closure.min, scene.bake.stats.closure.max);
    return scene;
}

/// Mean over the colours of rms and bias of E_indirect.
ErrorMetrics judge(const Scene& scene, const char* what, const std::vector<glm::dvec4>& indirect,
                   const std::function<std::vector<double>(const std::string&)>& reference, const std::string& se)
{
    ErrorMetrics mean;
    for (u32 c = 0; c < 3; ++c) {
        const ErrorMetrics m = compare(scene.reference.column("area"), scene.perFace(indirect, c),
                                       reference(kChannels[c]), scene.reference.column(se), scene.keep);
        mean.rms += m.rms / 3.0;
        mean.bias += m.bias / 3.0;
        mean.p95 += m.p95 / 3.0;
    }
    std::printf("  E_indirect of %s: rms %.2f %%, bias %+.2f %%, P95 %.2f %%\n", what, 100 * mean.rms, 100 * mean.bias,
                100 * mean.p95);
    return mean;
}

void judgeSunAndSky(const Scene& scene, double azimuth, double elevation, double rms, double bias)
{
    const NodeTree& tree = scene.tree;
    const u32 n = tree.patchCount();
    const Visibility visibility(tree);
    const std::vector<double> share =
        raySun(tree, visibility, sunDirection(azimuth * kDegree, elevation * kDegree), 256);
    std::vector<glm::dvec4> sun(n), sky(n), zero(n, glm::dvec4(0.0));
    for (u32 i = 0; i < n; ++i) {
        sun[i] = glm::dvec4(kDni * share[i]);
        const u32 k = scene.bake.sky.rowBegin[i];
        sky[i] = glm::dvec4(scene.bake.sky.rowBegin[i + 1] > k ? kDhi * double(scene.bake.sky.factor[k]) : 0.0);
    }
    const ErrorMetrics direct =
        compare(scene.reference.column("area"), scene.perFace(sun, 1), scene.reference.column("sun_dir_g"),
                scene.reference.column("sun_dir_se_g"), scene.keep);
    EXPECT_LT(direct.rms, 0.01);
    std::vector<double> svf = scene.reference.column("svf"), svfSe = scene.reference.column("svf_se");
    for (double& v : svf) v *= kDhi;
    for (double& v : svfSe) v *= kDhi;
    const ErrorMetrics view = compare(scene.reference.column("area"), scene.perFace(sky, 1), svf, svfSe, scene.keep);
    std::printf("  E_sky: rms %.2f %%, bias %+.2f %%, P95 %.2f %%\n", 100 * view.rms, 100 * view.bias, 100 * view.p95);
    EXPECT_LT(view.rms, 0.015);
    EXPECT_LT(std::abs(view.bias), 0.005);

    const auto reference = [&](const std::string& prefix) {
        return [&, prefix](const std::string& channel) { return scene.reference.column(prefix + channel); };
    };
    const Solution bySun = solveLight(tree, scene.bake.links, sun, zero, {.residual = 1e-5});
    const Solution bySky = solveLight(tree, scene.bake.links, zero, sky, {.residual = 1e-5});
    for (const ErrorMetrics& m : {judge(scene, "sun", bySun.indirect, reference("sun_ind_"), "sun_ind_se_g"),
                                  judge(scene, "sky", bySky.indirect, reference("sky_ind_"), "sky_ind_se_g")}) {
        EXPECT_LT(m.rms, rms);
        EXPECT_LT(std::abs(m.bias), bias);
    }
}

} // namespace

TEST(ReferenceScenes, FourBuildings)
{
    // One radiosity a face: 4.2 % of the sun's rms stays with exact links.
    const Scene scene = readScene("S");
    judgeSunAndSky(scene, 150, 40, 0.05, 0.005);
    EXPECT_LT(scene.bake.stats.linksPerPatch, 100.0);
    EXPECT_LT(std::abs(scene.bake.stats.closureDefect), 2e-3);
}

TEST(ReferenceScenes, StreetCanyon)
{
    Scene scene = readScene("canyon");
    const CsvTable faces = readCsvTable(std::string(HELIO_TEST_DATA) + "/scenes/canyon.csv");
    for (size_t i = 0; i < faces.rows; ++i) scene.keep[i] = faces.column("bay")[i] == 1.0;
    judgeSunAndSky(scene, 120, 50, 0.01, 0.005);
}

TEST(ReferenceScenes, Furnace)
{
    const Scene scene = readScene("furnace");
    const std::vector<glm::dvec4> zero(scene.tree.patchCount(), glm::dvec4(0.0));
    const Solution s = solveLight(scene.tree, scene.bake.links, zero, zero, {.residual = 1e-6});
    double worst = 0.0;
    for (u32 i = 0; i < scene.tree.patchCount(); ++i)
        for (u32 c = 0; c < 3; ++c)
            raise(worst, std::abs(s.radiosity[i][c] * (1.0 - scene.tree.patches[i].rho[c]) - 1.0));
    std::printf("  B against 1 / (1 - rho): %.4f %% at most\n", 100 * worst);
    EXPECT_LT(worst, 1e-3);
}

TEST(ReferenceScenes, TwoBoxes)
{
    const Scene scene = readScene("twobox");
    const std::vector<glm::dvec4> zero(scene.tree.patchCount(), glm::dvec4(0.0));
    const Solution s = solveLight(scene.tree, scene.bake.links, zero, zero, {.residual = 1e-6});
    const auto reference = [&](const std::string& channel) {
        std::vector<double> sum = scene.reference.column("em_dir_" + channel);
        const std::vector<double>& later = scene.reference.column("em_ind_" + channel);
        for (size_t i = 0; i < sum.size(); ++i) sum[i] += later[i];
        return sum;
    };
    const ErrorMetrics m = judge(scene, "the emitter", s.indirect, reference, "em_dir_se_g");
    EXPECT_LT(std::abs(m.bias), 0.005);
    EXPECT_LT(m.rms, 0.02);
}
