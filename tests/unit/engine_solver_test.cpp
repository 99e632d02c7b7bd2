// SPDX-License-Identifier: Apache-2.0
// What the light solver decides on the host: contraction, acceleration, error bound, energy audit. By hand; no device.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/stages/acceleration.h"
#include "engine/stages/gather.h"
#include "engine/stream/contraction.h"
#include "engine/view/energy_audit.h"
#include "engine/view/light_solver.h"
#include "tests/support/tile_builder.h"

namespace helio {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Three patches, the first two under a group of slope coordinate -1 and 1.
struct Trio
{
    TileBuilder b;
    u32 group;
    Trio()
    {
        b.patch({0, 0, 1}, 1.0f, glm::vec4(0.5f, 0.25f, 0.0f, 0.5f), glm::vec4(10.0f));
        b.patch({0, 0, 1}, 1.0f, glm::vec4(0.125f));
        b.patch({0, 0, 1}, 2.0f, glm::vec4(0.75f, 0.5f, 0.0f, 0.25f));
        group = b.group({0, 1}, {{-1, 0, 0, 0, 0, 0}, {1, 0, 0, 0, 0, 0}});
    }
};

TEST(Contraction, CountsTheLinksOfAncestors)
{
    Trio t;
    t.b.link(0, 2, 0.25f);
    t.b.link(t.group, 2, 0.5f);
    t.b.link(2, t.group, 0.625f);
    t.b.link(2, 1, 0.125f);
    const TileView view = t.b.view();
    EXPECT_EQ(linkSums(view), (std::vector<double>{0.75, 0.5, 0.75}));
    EXPECT_EQ(absoluteLinkSums(view), linkSums(view));
    const Contraction c = contractionOf(view);
    EXPECT_EQ(c.number, glm::dvec4(0.5625, 0.375, 0.0625, 0.375));
    EXPECT_EQ(c.patch, 2u);
    EXPECT_EQ(c.largest(), 0.5625);
}

TEST(Contraction, MomentsCountWhereTheyCanMakeAFactorNegative)
{
    Trio t;
    t.b.linear = true;
    t.b.link(0, t.group, 0.4f, {0.3f, 9.0f});  // 0.4 -+ 0.3 >= 0; the second coordinate is 0 everywhere
    t.b.link(1, t.group, 0.3f, {-0.4f, 0.0f}); // 0.3 +- 0.4
    t.b.link(2, 0, 0.25f, {7.0f, 7.0f});       // a patch has no slope
    const TileView view = t.b.view();
    const std::vector<double> sums = absoluteLinkSums(view);
    EXPECT_NEAR(sums[0], 0.4, 1e-7);
    EXPECT_NEAR(sums[1], 0.5, 1e-7); // in truth (0.7 + 0.1) / 2 = 0.4: a bound
    EXPECT_NEAR(sums[2], 0.25, 1e-7);
    EXPECT_NEAR(linkSums(view)[1], 0.3, 1e-7);
}

TEST(Contraction, BoundsTheFactorsOfDeepTrees)
{
    // Four patches at -3, -1, 1, 3 in two pairs: deviations 1 in a pair, sqrt(5) in all. F + M x / sqrt(5) touches 0
    // at 3.
    TileBuilder b;
    b.linear = true;
    for (int i = 0; i < 4; ++i) b.patch({0, 0, 1}, 1.0f, glm::vec4(0.5f));
    const gpu::ChildSlopeRecord low{-1, 0, 0, 0, 0, 0}, high{1, 0, 0, 0, 0, 0};
    const u32 left = b.group({0, 1}, {low, high}), right = b.group({2, 3}, {low, high});
    const float s = 1.0f / std::sqrt(5.0f);
    const u32 root = b.group({left, right}, {{-2 * s, 0, s, 0, 0, 0}, {2 * s, 0, s, 0, 0, 0}});
    b.link(0, root, 0.3f, {-0.0999f / s, 0.0f});
    b.link(1, root, 0.3f, {-0.1001f / s, 0.0f});
    const std::vector<double> sums = absoluteLinkSums(b.view());
    EXPECT_NEAR(sums[0], 0.3, 1e-6);
    EXPECT_NEAR(sums[1], std::hypot(0.3, 0.1001 * std::sqrt(5.0)), 1e-6);
}

TEST(Acceleration, BoundsTheEigenvalueFromBothSides)
{
    // Two patches that see each other: B0 = rho0 f01 B1, B1 = rho1 f10 B0 with A0 f01 = A1 f10; eigenvalues +-sqrt(k0
    // k1).
    TileBuilder b;
    b.patch({0, 0, 1}, 1.0f, glm::vec4(0.5f, 0.5f, 0.0f, 0.8f));
    b.patch({0, 0, 1}, 2.0f, glm::vec4(0.9f, 0.5f, 0.0f, 0.8f));
    const std::vector<gpu::PatchRecord>& patches = b.patches;
    const double f01 = 0.8, f10 = 0.4;
    const std::vector<glm::vec4> before{glm::vec4(1.0f), glm::vec4(0.5f)};
    std::vector<glm::vec4> after(2);
    for (int c = 0; c < 4; ++c) {
        after[0][c] = float(double(patches[0].rho[c]) * f01 * 0.5);
        after[1][c] = float(double(patches[1].rho[c]) * f10 * 1.0);
    }
    std::vector<glm::vec4> reflectance, planes;
    for (const gpu::PatchRecord& patch : patches) {
        reflectance.push_back(patch.rho);
        planes.emplace_back(patch.normal, patch.area);
    }
    const SpectralBounds bounds = spectralBounds(reflectance, planes, before, after);
    for (const int c : {0, 1, 3}) {
        const double exact = std::sqrt(double(patches[0].rho[c]) * f01 * double(patches[1].rho[c]) * f10);
        EXPECT_GE(bounds.upper[c], exact);
        EXPECT_LE(bounds.lower[c], exact + 1e-7);
        EXPECT_GT(bounds.lower[c], 0.8 * exact);
        EXPECT_NEAR(bounds.upper[c], std::max(0.5 * f01 * patches[0].rho[c], 2.0 * f10 * patches[1].rho[c]), 1e-6);
    }
    EXPECT_EQ(bounds.upper[2], 0.0);
    EXPECT_EQ(bounds.lower[2], 0.0);
}

TEST(Acceleration, IsTakenWhereItPays)
{
    const glm::dvec4 contraction(0.99, 0.99, 0.6, 1.2);
    // Fast enough anyway; worth it; worth it, and the contraction number is the sharper bound; no contraction, but
    // eigenvalues below 1.
    EXPECT_EQ(chebyshevRadius({{0.49, 0.9, 0.55, 0.9}, {0.6, 0.95, 0.65, 0.98}}, contraction),
              glm::dvec4(0.0, 0.95, 0.6, 0.98));
    // An upper bound of 0.95 promises a rate of 0.72, no better than 0.7; eigenvalues of 1 promise nothing.
    EXPECT_EQ(chebyshevRadius({glm::dvec4(0.7), {0.95, 1.0, 0.6, 1.01}}, glm::dvec4(1.5)), glm::dvec4(0, 0, 0.6, 0));
}

TEST(Acceleration, WeightsDampEveryEigenvalueAlike)
{
    // The error of an eigenvalue x after n sweeps is T_n(x / m) / T_n(1 / m) times that before.
    const glm::dvec4 radius(0.9, 0.5, 0.99, 0.0);
    for (const double x : {-0.45, 0.1, 0.5}) {
        glm::dvec4 weight(1.0), last(0.0), error(1.0);
        for (u32 n = 0; n < 9; ++n) {
            weight = chebyshevWeight(n, weight, radius);
            const glm::dvec4 next = weight * x * error + (1.0 - weight) * last;
            last = error;
            error = next;
        }
        const auto t9 = [](double y) { // 256 y^9 - 576 y^7 + 432 y^5 - 120 y^3 + 9 y
            const double q = y * y;
            return y * (9 + q * (-120 + q * (432 + q * (-576 + q * 256))));
        };
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(error[c], t9(x / radius[c]) / t9(1.0 / radius[c]), 1e-9) << x;
        EXPECT_NEAR(error[3], std::pow(x, 9.0), 1e-12);
    }
}

TEST(Acceleration, SaysWhatKeepsTheErrorFromABound)
{
    Contraction c;
    c.patch = 17;
    c.reflectance = 0.9;
    c.linkSum = 1.1;
    EXPECT_EQ(contractionNote(c, {glm::dvec4(0.8), glm::dvec4(0.98)}), "");
    c.linkSum = 1.2;
    const std::string mild = contractionNote(c, {glm::dvec4(0.8), glm::dvec4(0.98)});
    EXPECT_NE(mild.find("patch 17 reflects 0.9 and its links add up to 1.2"), std::string::npos) << mild;
    EXPECT_NE(mild.find("converge all the same"), std::string::npos) << mild;
    const std::string severe = contractionNote(c, {glm::dvec4(0.8), glm::dvec4(0.9, 1.05, 0.9, 0.9)});
    EXPECT_NE(severe.find("may never converge"), std::string::npos) << severe;
    EXPECT_EQ(severe.find('\n'), std::string::npos);
}

TEST(ErrorBound, ByHand)
{
    gpu::ResidualRecord sums{};
    sums.change = glm::vec4(1.0f, 4.0f, 0.0f, 1.0f);
    sums.scale = glm::vec4(100.0f);
    sums.largest = glm::vec4(1.0f, 2.0f, 0.0f, 3.0f);
    EXPECT_EQ(errorBoundOf(sums, {0.5, 0.75, 0.9, 1.0}), glm::dvec4(2.0, 8.0, 0.0, kInfinity));
    sums.largest.x = std::numeric_limits<float>::infinity();
    sums.change.x = std::numeric_limits<float>::infinity();
    EXPECT_EQ(errorBoundOf(sums, glm::dvec4(0.5)), glm::dvec4(kInfinity));
    // Steps that halve: as much again is to come. An accelerated channel goes by the eigenvalues: 9 times as much.
    sums.change = glm::vec4(1.0f, 0.0f, 0.0f, 0.0f);
    gpu::ResidualRecord before = sums;
    before.change.x = 4.0f;
    EXPECT_NEAR(remainingErrorOf(before, sums), 0.1, 1e-12);
    EXPECT_NEAR(remainingErrorOf(before, sums, {0.9, 0.0, 0.0, 0.0}), 0.9, 1e-9);
}

TEST(EnergyAudit, ByHand)
{
    Trio t;
    t.b.link(0, 2, 0.5f);
    t.b.link(2, 0, 0.125f); // A F = 0.5 and 0.25: not reciprocal
    t.b.sky(0, 0.25f);
    const TileView view = t.b.view();
    // Patch 0 (1 m2, rho 0.5): E = 8 + 4 + 2; patch 2 (2 m2, rho 0.75): E = 0 + 0 + 16, red. Patch 1 is dark.
    LightTables light;
    light.sun = {glm::vec4(8.0f), glm::vec4(0.0f), glm::vec4(0.0f)};
    light.sky = {glm::vec4(4.0f), glm::vec4(0.0f), glm::vec4(0.0f)};
    light.indirect = {glm::vec4(2.0f), glm::vec4(0.0f), glm::vec4(16.0f)};
    light.radiosity = {glm::vec4(17.0f), glm::vec4(0.0f), glm::vec4(12.0f)}; // 10 + 0.5 x 14, 0.75 x 16
    const EnergyAudit audit = auditEnergy(view, light, true);
    EXPECT_DOUBLE_EQ(audit.sun.r, 8.0);
    EXPECT_DOUBLE_EQ(audit.sky.r, 4.0);
    EXPECT_DOUBLE_EQ(audit.emission.r, 10.0);
    EXPECT_DOUBLE_EQ(audit.absorbed.r, 0.5 * 14 + 2 * 0.25 * 16);
    EXPECT_DOUBLE_EQ(audit.toSky.r, 0.25 * 17);
    EXPECT_DOUBLE_EQ(audit.away.r, 0.25 * 17 + 0.875 * 24);
    // Sent to patches: 0.5 x 17 + 0.125 x 24 = 11.5; arrived: 2 + 2 x 16 = 34.
    EXPECT_DOUBLE_EQ(audit.unexplained().r, 11.5 - 34.0);
    EXPECT_DOUBLE_EQ(audit.unexplainedShare().r, -22.5 / 22.0);
    EXPECT_EQ(auditEnergy(view, light, false).emission, glm::dvec4(0.0));
    EXPECT_EQ(EnergyAudit{}.unexplainedShare(), glm::dvec4(0.0));
}

TEST(StageReport, BillsFillsAndReadBacksToTheirGraph)
{
    EXPECT_EQ(stageOf("sun raster 3", "2 sun energy"), "1 sun raster");
    EXPECT_EQ(stageOf("histogram", "2 sun energy"), "2 histogram");
    EXPECT_EQ(stageOf("sun pull", "3 gather"), "2 sun energy");
    EXPECT_EQ(stageOf("fill", "2 sun energy"), "2 sun energy");
    EXPECT_EQ(stageOf("read back", "2 sun energy"), "2 sun energy");
    EXPECT_EQ(stageOf("read back", "3 gather"), "3 gather");
    EXPECT_EQ(stageOf("pull", "3 gather"), "3 gather");
}

} // namespace

} // namespace helio
