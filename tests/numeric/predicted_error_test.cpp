// SPDX-License-Identifier: Apache-2.0
// The error that a bake expects of itself: its parts against closed forms, the whole against the reference of scene S.
#include "city/light/predicted_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
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

/// `count` patches of 1 m2, each a plane of its own.
NodeTree plates(u32 count, double rho)
{
    std::vector<Face> faces;
    for (u32 i = 0; i < count; ++i)
        append(faces, grid({0, 0, double(i)}, {1, 0, 0}, {0, 1, 0}, 1, 1, {{}, i, glm::dvec4(rho)}));
    return makeTree(faces);
}

/// E_indirect of each face in a channel, under the sun of the references: azimuth 150, elevation 40 degrees, 800 W/m2.
std::vector<double> indirectOfFaces(const NodeTree& tree, const LightBake& bake, u32 channel, size_t faces)
{
    const double degree = std::numbers::pi / 180.0;
    const std::vector<double> share = raySun(tree, Visibility(tree), sunDirection(150 * degree, 40 * degree), 256);
    std::vector<glm::dvec4> direct(tree.patchCount());
    for (size_t i = 0; i < direct.size(); ++i) direct[i] = glm::dvec4(800.0 * share[i]);
    const std::vector<glm::dvec4> none(tree.patchCount(), glm::dvec4(0.0));
    const Solution s = solveLight(tree, bake.links, direct, none, {.residual = 1e-5});
    std::vector<double> mean(faces, 0.0), area(faces, 0.0);
    for (u32 i = 0; i < tree.patchCount(); ++i) {
        mean[tree.patches[i].sourceFace] += tree.patches[i].area * s.indirect[i][glm::length_t(channel)];
        area[tree.patches[i].sourceFace] += tree.patches[i].area;
    }
    for (size_t f = 0; f < faces; ++f) mean[f] /= area[f];
    return mean;
}

double rmsOfSun(const NodeTree& tree, const LightBake& bake, const CsvTable& reference)
{
    double sum = 0.0;
    for (u32 c = 0; c < 3; ++c)
        sum += compare(reference.column("area"), indirectOfFaces(tree, bake, c, reference.rows),
                       reference.column(std::string("sun_ind_") + "rgb"[c]), reference.column("sun_ind_se_g"),
                       std::vector<bool>(reference.rows, true))
                   .rms /
               3.0;
    return sum;
}

} // namespace

TEST(PredictedError, HalfTheDifferenceThatCoarseLinksMake)
{
    // Two plates, rho = 1/2, one lit: E1 = x / (1 - x^2), E0 = x E1 with x = rho F; F = 0.4 against 0.3.
    const NodeTree tree = plates(2, 0.5);
    const LinkTable links = makeLinks(tree, {{0, 1, 0.4}, {1, 0, 0.4}}),
                    coarse = makeLinks(tree, {{0, 1, 0.3}, {1, 0, 0.3}});
    const std::vector<glm::dvec4> direct{glm::dvec4(3.0), glm::dvec4(0.0)};
    const PredictedError e = predictError(tree, links, coarse, direct, {{0, 1}, 0.0, 0.0}, 1);
    const double fine = 0.2 / 0.96, other = 0.15 / 0.9775;
    const double d1 = fine - other, d0 = 0.2 * fine - 0.15 * other;
    const double expected = 0.5 * std::sqrt(0.5 * (d0 * d0 + d1 * d1)) / (0.5 * (fine + 0.2 * fine));
    EXPECT_NEAR(e.links, expected, 1e-3 * expected);
    EXPECT_NEAR(e.sky, expected, 1e-3 * expected);
    EXPECT_EQ(e.patches, 0.0);
    EXPECT_NEAR(e.total, e.links, 1e-12);
    // A patch: half its own difference, half the rms of all in proportion to its light, in squares.
    const double mean = 0.5 * (fine + 0.2 * fine), square = 0.5 * (0.04 + 1.0) * fine * fine;
    const double own1 = 0.5 * d1 / mean, own0 = 0.5 * d0 / mean;
    const double light1 = expected * expected * fine * fine / square;
    ASSERT_EQ(e.ofPatch.size(), 2u);
    EXPECT_NEAR(e.ofPatch[1], std::sqrt(0.5 * (own1 * own1 + light1)), 2e-3 * expected);
    EXPECT_NEAR(e.ofPatch[0], std::sqrt(0.5 * (own0 * own0 + 0.04 * light1)), 2e-3 * expected);
    EXPECT_NEAR(0.5 * (double(e.ofPatch[0]) * e.ofPatch[0] + double(e.ofPatch[1]) * e.ofPatch[1]), e.total * e.total,
                1e-6 * e.total * e.total);
}

TEST(PredictedError, CoveredPatchesHaveNoErrorAndDiluteTheMean)
{
    // The two plates of above and a third of the same size that a neighbour covers: the mean over all is two thirds.
    NodeTree tree = plates(3, 0.5);
    tree.patches[2].covered = true;
    const std::vector<glm::dvec4> direct{glm::dvec4(3.0), glm::dvec4(0.0), glm::dvec4(0.0)};
    const PredictedError e =
        predictError(tree, makeLinks(tree, {{0, 1, 0.4}, {1, 0, 0.4}}), makeLinks(tree, {{0, 1, 0.3}, {1, 0, 0.3}}),
                     direct, {{0, 1, 2}, 0.1, 0.1}, 1);
    EXPECT_EQ(e.ofPatch[2], 0.0f);
    const double squares = double(e.ofPatch[0]) * e.ofPatch[0] + double(e.ofPatch[1]) * e.ofPatch[1];
    EXPECT_NEAR(0.5 * squares, 1.5 * 1.5 * e.total * e.total, 1e-6 * squares);
}

TEST(PredictedError, PartsThatSendAlikeTellWhatPatchesHide)
{
    // Two parts of one patch, one of them lit, send to a third plate, with F = 0.3 and 0.1: E = 0.15, and 0.1 from
    // their mean. Rms over 3 m2: 0.05 / sqrt(3); mean 0.05. The plan left 0.1 and resolved sqrt(0.2^2 - 0.1^2).
    const NodeTree tree = plates(3, 0.5);
    const LinkTable links = makeLinks(tree, {{2, 0, 0.3}, {2, 1, 0.1}});
    const std::vector<glm::dvec4> direct{glm::dvec4(1.0), glm::dvec4(0.0), glm::dvec4(0.0)};
    const PredictedError e = predictError(tree, links, links, direct, {{0, 0, 1}, 0.1, 0.2}, 1);
    EXPECT_EQ(e.links, 0.0);
    EXPECT_NEAR(e.patches, 1.0 / 3.0, 1e-7); // factors are floats
    // Where the cuts resolved next to nothing the plan's own figure counts, by half.
    EXPECT_NEAR(predictError(tree, links, links, direct, {{0, 0, 1}, 0.1, 0.11}, 1).patches, 0.05, 1e-12);
}

TEST(PredictedError, ErrorBarsOfPatchesHoldOnFourBuildings)
{
    const std::string base = std::string(HELIO_TEST_DATA) + "/scenes/S";
    const CsvTable reference = readCsvTable(base + ".reference.csv");
    const Result<ShapeTree> shapes = readSurfaces(base + ".obj", base + ".csv");
    ASSERT_TRUE(shapes.ok()) << shapes.error().message;
    NodeTreeBuild build = buildNodes(shapes.value(), {});
    const LightBake bake = bakeLight(build, {}, {});
    const NodeTree& tree = build.tree;
    const std::vector<double> mean = indirectOfFaces(tree, bake, 1, reference.rows);
    const std::vector<double>&truth = reference.column("sun_ind_g"), &noise = reference.column("sun_ind_se_g");
    std::vector<double> expected(reference.rows, 0.0);
    double light = 0.0, area = 0.0;
    for (size_t f = 0; f < reference.rows; ++f) {
        light += reference.column("area")[f] * truth[f];
        area += reference.column("area")[f];
    }
    for (u32 i = 0; i < tree.patchCount(); ++i)
        expected[tree.patches[i].sourceFace] = double(bake.stats.predicted.ofPatch[i]) * light / area;
    double within1 = 0.0, within2 = 0.0;
    for (size_t f = 0; f < reference.rows; ++f) {
        const double bar = std::hypot(expected[f], noise[f]), off = std::abs(mean[f] - truth[f]);
        within1 += off <= bar ? reference.column("area")[f] / area : 0.0;
        within2 += off <= 2.0 * bar ? reference.column("area")[f] / area : 0.0;
    }
    std::printf("within one error bar %.1f %% of the area, within two %.1f %%\n", 100 * within1, 100 * within2);
    // Of a normal distribution 68 and 95 %. Bars half as long would hold 38 and 68, twice as long 95 and 100.
    EXPECT_GT(within1, 0.55);
    EXPECT_LT(within1, 0.85);
    EXPECT_GT(within2, 0.90);
}

TEST(PredictedError, DoesNotDependOnTheNumberOfThreads)
{
    const std::string base = std::string(HELIO_TEST_DATA) + "/scenes/S";
    PredictedError of[2];
    for (const u32 jobs : {1u, 3u}) {
        const Result<ShapeTree> shapes = readSurfaces(base + ".obj", base + ".csv");
        ASSERT_TRUE(shapes.ok()) << shapes.error().message;
        NodeTreeBuild build = buildNodes(shapes.value(), {});
        LightOptions options;
        options.error = 0.08;
        options.jobs = jobs;
        of[jobs == 3 ? 1 : 0] = bakeLight(build, {}, options).stats.predicted;
    }
    EXPECT_GT(of[0].total, 0.0);
    EXPECT_EQ(of[0].total, of[1].total);
    EXPECT_EQ(of[0].sky, of[1].sky);
    EXPECT_EQ(of[0].links, of[1].links);
    EXPECT_EQ(of[0].patches, of[1].patches);
    EXPECT_EQ(of[0].ofPatch, of[1].ofPatch);
}

TEST(PredictedError, IsWithinAFactorOfTwoOfTheMeasuredOneOnFourBuildings)
{
    const std::string base = std::string(HELIO_TEST_DATA) + "/scenes/S";
    const CsvTable reference = readCsvTable(base + ".reference.csv");
    LightOptions coarse, whole;
    coarse.error = 0.08;
    whole.splitGrowth = 1.0;
    for (const LightOptions& options : {LightOptions{}, coarse, whole}) {
        const Result<ShapeTree> shapes = readSurfaces(base + ".obj", base + ".csv");
        ASSERT_TRUE(shapes.ok()) << shapes.error().message;
        NodeTreeBuild build = buildNodes(shapes.value(), {});
        const LightBake bake = bakeLight(build, {}, options);
        const u32 n = build.tree.patchCount();
        const double bySun = rmsOfSun(build.tree, bake, reference);
        const PredictedError& e = bake.stats.predicted;
        std::printf("%u patches: predicted %.2f %% (links %.2f, patches %.2f), sun %.2f %%\n", n, 100 * e.total,
                    100 * e.links, 100 * e.patches, 100 * bySun);
        EXPECT_LT(e.total, 2.0 * bySun);
        EXPECT_GT(e.total, 0.5 * bySun);
    }
}
