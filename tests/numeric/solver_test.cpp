// SPDX-License-Identifier: Apache-2.0
// The solver by itself: links are given, so every expectation is a closed form.
#include "city/light/reference_solver.h"

#include <gtest/gtest.h>

#include <cmath>

#include "city/base/hash.h"
#include "tests/numeric/fixtures.h"

using namespace helio;
using namespace helio::test;

namespace {

std::vector<glm::dvec4> none(const NodeTree& tree)
{
    return std::vector<glm::dvec4>(tree.patchCount(), glm::dvec4(0.0));
}

/// Patches of different sizes in two planes; sizes 1, 2, ... m2 in each.
NodeTree twoPlanes(u32 perPlane)
{
    std::vector<Face> faces;
    for (u32 plane = 0; plane < 2; ++plane) {
        double x = 0.0;
        for (u32 i = 0; i < perPlane; ++i) {
            const double width = double(i + 1);
            append(faces, grid({x, 0, double(plane) * 50.0}, {width, 0, 0}, {0, 1, 0}, 1, 1, {{}, plane}));
            x += width;
        }
    }
    return makeTree(faces);
}

/// Every patch sees every patch, itself too, as inside a sphere: F_ij = A_j / A. `level` links nodes of the hierarchy
/// in place of patches where it can: roots with roots, and the first root's children with the second root.
LinkTable sphereLinks(const NodeTree& tree, bool hierarchical)
{
    double area = 0.0;
    for (const Patch& patch : tree.patches) area += patch.area;
    std::vector<TestLink> links;
    std::vector<u32> receivers, senders;
    for (u32 i = 0; i < tree.nodeCount(); ++i)
        if (hierarchical ? tree.isPlanarRoot(i) : tree.isLeaf(i)) receivers.push_back(i);
    senders = receivers;
    if (hierarchical) {
        // The first root receives by its children, and sends as a whole.
        const std::span<const u32> children = tree.childrenOf(receivers[0]);
        receivers.erase(receivers.begin());
        receivers.insert(receivers.end(), children.begin(), children.end());
    }
    for (const u32 r : receivers)
        for (const u32 s : senders) links.push_back({r, s, tree.nodes[s].area / area});
    return makeLinks(tree, links);
}

} // namespace

TEST(Solver, SphereInteriorIsExactForAnyPatternOnAnyLevel)
{
    // H = <E> / (1 - <rho>), B_i = E_i + rho_i H, area means.
    NodeTree tree = twoPlanes(7);
    Random random(3);
    glm::dvec4 meanE(0.0), meanRho(0.0);
    double area = 0.0;
    for (Patch& patch : tree.patches) {
        patch.rho = {random.uniform(), 0.9 * random.uniform(), 0.5, 0.0};
        patch.emission = {random.uniform(), 1.0, random.uniform(), 3.0};
        meanE += patch.area * patch.emission;
        meanRho += patch.area * patch.rho;
        area += patch.area;
    }
    const glm::dvec4 h = (meanE / area) / (1.0 - meanRho / area);
    for (const bool hierarchical : {false, true}) {
        const Solution s =
            solveLight(tree, sphereLinks(tree, hierarchical), none(tree), none(tree), {.residual = 1e-9});
        for (u32 i = 0; i < tree.patchCount(); ++i) {
            for (u32 c = 0; c < 4; ++c) {
                EXPECT_NEAR(s.indirect[i][c], h[c], 2e-6 * h[c]) << hierarchical;
                EXPECT_NEAR(s.radiosity[i][c], tree.patches[i].emission[c] + tree.patches[i].rho[c] * h[c],
                            2e-6 * h[c]);
            }
        }
    }
}

TEST(Solver, AgreesWithEliminationOnAnUnevenHierarchy)
{
    NodeTree tree = twoPlanes(6);
    Random random(5);
    for (Patch& patch : tree.patches) {
        patch.rho = glm::dvec4(random.uniform());
        patch.emission = glm::dvec4(random.uniform());
    }
    // Links between all sorts of levels; row sums stay below 1.
    std::vector<TestLink> links;
    for (u32 i = 0; i < tree.nodeCount(); ++i)
        for (u32 j = 0; j < tree.nodeCount(); ++j)
            if (tree.nodes[i].kind != NodeKind::Cluster && tree.nodes[j].kind != NodeKind::Cluster &&
                random.uniform() < 0.3)
                links.push_back({i, j, 0.02 * random.uniform()});
    const LinkTable table = makeLinks(tree, links);
    const Solution s = solveLight(tree, table, none(tree), none(tree), {.residual = 1e-12, .maxSweeps = 500});
    std::vector<double> rho, b0;
    for (const Patch& patch : tree.patches) {
        rho.push_back(patch.rho.x);
        b0.push_back(patch.emission.x);
    }
    const std::vector<double> exact = solveDense(denseFactors(tree, table), rho, b0);
    for (u32 i = 0; i < tree.patchCount(); ++i) EXPECT_NEAR(s.radiosity[i].x, exact[i], 1e-9);
}

TEST(Solver, TwoPatchesByHand)
{
    // Eliminates by hand first, then by sweeps: B1 = (E1 + rho1 F12 E2) / (1 - rho1 rho2 F12 F21).
    NodeTree tree = twoPlanes(1);
    tree.patches[0].rho = glm::dvec4(0.5);
    tree.patches[1].rho = glm::dvec4(0.25);
    tree.patches[1].emission = glm::dvec4(8.0);
    const std::vector<double> exact =
        solveDense(std::vector<double>{0, 0.5, 0.5, 0}, std::vector<double>{0.5, 0.25}, std::vector<double>{2, 8});
    EXPECT_NEAR(exact[0], (2 + 0.5 * 0.5 * 8) / (1 - 0.5 * 0.25 * 0.25), 1e-12);
    const LinkTable links = makeLinks(tree, {{0, 1, 0.5}, {1, 0, 0.5}});
    std::vector<glm::dvec4> sun = none(tree), sky = none(tree);
    sun[0] = glm::dvec4(3.0);
    sky[0] = glm::dvec4(1.0); // rho (3 + 1) = 2
    const Solution s = solveLight(tree, links, sun, sky, {.residual = 1e-10});
    EXPECT_NEAR(s.radiosity[0].g, exact[0], 1e-8);
    EXPECT_NEAR(s.radiosity[1].g, exact[1], 1e-8);
    EXPECT_NEAR(s.indirect[0].g, 0.5 * exact[1], 1e-8);
}

TEST(Solver, ResidualBoundAndPaperErrorByHand)
{
    // One channel of a uniform enclosure: B = 1, 1.5, 1.75, ... for rho 0.5 and row sum 1.
    NodeTree tree = twoPlanes(1);
    for (Patch& patch : tree.patches) {
        patch.rho = {0.5, 0, 0, 0};
        patch.emission = {1, 0, 0, 0};
    }
    const LinkTable links = makeLinks(tree, {{0, 1, 1.0}, {1, 0, 1.0}});
    const Solution s = solveLight(tree, links, none(tree), none(tree), {.residual = 0.0, .maxSweeps = 3});
    ASSERT_EQ(s.sweeps.size(), 3u);
    // Changes 1/2, 1/4, 1/8 over rises 1/2, 3/4, 7/8.
    EXPECT_NEAR(s.sweeps[0].residual, 1.0, 1e-12);
    EXPECT_NEAR(s.sweeps[1].residual, 1.0 / 3.0, 1e-12);
    EXPECT_NEAR(s.sweeps[2].residual, 1.0 / 7.0, 1e-12);
    // Remaining error 2 - 1.875 = 1/8 = change x 0.5 / (1 - 0.5): the bound is sharp here.
    EXPECT_NEAR(s.sweeps[2].bound, 0.125, 1e-12);
    EXPECT_NEAR(s.sweeps[2].paperError, 0.125 * std::sqrt(2.0), 1e-12);
}

TEST(Solver, PushPullKeepsAConstantAndTheFlux)
{
    // Furnace on sphere links: B0 = 1, rho = 0.5 gives B = 2 on every node, inner ones too.
    NodeTree tree = twoPlanes(9);
    for (Patch& patch : tree.patches) {
        patch.rho = glm::dvec4(0.5);
        patch.emission = glm::dvec4(1.0);
    }
    const Solution s =
        solveLight(tree, sphereLinks(tree, true), none(tree), none(tree), {.residual = 1e-10, .maxSweeps = 100});
    for (const glm::dvec4& b : s.radiosity) EXPECT_NEAR(b.x, 2.0, 1e-6);

    // Refining a link must not change the flux that arrives: one link to a root, or the same factor to each of its
    // children.
    Random random(9);
    for (Patch& patch : tree.patches) patch.emission = glm::dvec4(random.uniform());
    std::vector<u32> roots;
    for (u32 i = 0; i < tree.nodeCount(); ++i)
        if (tree.isPlanarRoot(i)) roots.push_back(i);
    ASSERT_EQ(roots.size(), 2u);
    std::vector<TestLink> refined;
    for (const u32 r : tree.childrenOf(roots[0]))
        for (const u32 c : tree.childrenOf(roots[1]))
            refined.push_back({r, c, 0.3 * tree.nodes[c].area / tree.nodes[roots[1]].area});
    const auto flux = [&](const LinkTable& links) {
        const Solution one = solveLight(tree, links, none(tree), none(tree), {.residual = 0.0, .maxSweeps = 1});
        double sum = 0.0;
        for (u32 i = 0; i < tree.patchCount(); ++i) sum += tree.patches[i].area * one.indirect[i].x;
        return sum;
    };
    const double coarse = flux(makeLinks(tree, {{roots[0], roots[1], 0.3}}));
    EXPECT_GT(coarse, 1.0);
    EXPECT_NEAR(flux(makeLinks(tree, refined)) / coarse, 1.0, 1e-6);
}

TEST(PaperMisprints, OwnRadiosityLightsAPatchByItself)
{
    // Patch 0 emits 1, patch 1 is dark. Printed: patch 0 lights itself, patch 1 stays dark.
    NodeTree tree = twoPlanes(1);
    for (Patch& patch : tree.patches) patch.rho = glm::dvec4(0.5);
    tree.patches[0].emission = glm::dvec4(1.0);
    const double f = 0.4;
    const LinkTable links = makeLinks(tree, {{0, 1, f}, {1, 0, f}});
    const Solution right = solveLight(tree, links, none(tree), none(tree), {.residual = 1e-12});
    EXPECT_NEAR(right.radiosity[0].x, 1.0 / (1.0 - 0.25 * f * f), 1e-7);
    EXPECT_NEAR(right.radiosity[1].x, 0.5 * f / (1.0 - 0.25 * f * f), 1e-7);
    const Solution printed =
        solveLight(tree, links, none(tree), none(tree), {.residual = 1e-12, .rule = UpdateRule::OwnRadiosity});
    EXPECT_NEAR(printed.radiosity[0].x, 1.0 / (1.0 - 0.5 * f), 1e-7);
    EXPECT_EQ(printed.radiosity[1].x, 0.0);
}

TEST(PaperMisprints, NeverResettingGivesBinomialsInPlaceOfAGeometricSeries)
{
    // x = rho x row sum = 0.2, three sweeps: 1 + x + x^2 + x^3 = 1.248; printed: (1 + x)^3 = 1.728.
    NodeTree tree = twoPlanes(4);
    for (Patch& patch : tree.patches) {
        patch.rho = glm::dvec4(0.2);
        patch.emission = glm::dvec4(1.0);
    }
    const LinkTable links = sphereLinks(tree, true);
    const Solution right = solveLight(tree, links, none(tree), none(tree), {.residual = 0.0, .maxSweeps = 3});
    const Solution printed = solveLight(tree, links, none(tree), none(tree),
                                        {.residual = 0.0, .maxSweeps = 3, .rule = UpdateRule::NeverReset});
    for (u32 i = 0; i < tree.patchCount(); ++i) {
        EXPECT_NEAR(right.radiosity[i].x, 1.248, 1e-6);
        EXPECT_NEAR(printed.radiosity[i].x, 1.728, 1e-6);
    }
}

TEST(PaperMisprints, EnergyIsNotRadiosity)
{
    // 100 W/m2 on 3 m2 of reflectance 0.25: 25 W/m2 leave it; printed: 300.
    NodeTree tree = twoPlanes(3);
    for (Patch& patch : tree.patches) patch.rho = glm::dvec4(0.25);
    std::vector<glm::dvec4> sun = none(tree);
    sun[2] = glm::dvec4(100.0);
    const LinkTable links = makeLinks(tree, {});
    EXPECT_NEAR(tree.patches[2].area, 3.0, 1e-12);
    EXPECT_NEAR(solveLight(tree, links, sun, none(tree), {}).radiosity[2].x, 25.0, 1e-12);
    EXPECT_NEAR(solveLight(tree, links, sun, none(tree), {.rule = UpdateRule::EnergyAsRadiosity}).radiosity[2].x, 300.0,
                1e-12);
}
