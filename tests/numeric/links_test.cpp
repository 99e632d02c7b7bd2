// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "city/light/bake_light.h"
#include "city/light/form_factor.h"
#include "city/light/links.h"
#include "city/light/reference_solver.h"
#include "city/light/sky.h"
#include "city/light/transfer.h"
#include "tests/numeric/fixtures.h"

using namespace helio;
using namespace helio::test;

namespace {

std::vector<glm::dvec4> none(const NodeTree& tree)
{
    return std::vector<glm::dvec4>(tree.patchCount(), glm::dvec4(0.0));
}

/// Flux that goes from one group of patches to another, per unit radiosity: sum of A_i F_ij, m2.
double groupExchange(const NodeTree& tree, const LinkTable& links, u32 fromBegin, u32 fromEnd, u32 toBegin, u32 toEnd)
{
    const std::vector<double> dense = denseFactors(tree, links);
    double sum = 0.0;
    for (u32 i = fromBegin; i < fromEnd; ++i)
        for (u32 j = toBegin; j < toEnd; ++j) sum += tree.patches[i].area * dense[size_t(i) * tree.patchCount() + j];
    return sum;
}

/// A street between two facades with windows of another reflectance, a ground and a free-standing wall in it.
std::vector<Face> street()
{
    std::vector<Face> faces = grid({0, 0, 0}, {12, 0, 0}, {0, 40, 0}, 3, 8, {{}, 0, glm::dvec4(0.2)});
    append(faces, grid({0, 0, 0}, {0, 40, 0}, {0, 0, 15}, 10, 5, {{}, 1, glm::dvec4(0.6)}));
    append(faces, grid({12, 0, 0}, {0, 0, 15}, {0, 40, 0}, 5, 10, {{}, 2, glm::dvec4(0.4)}));
    append(faces, grid({6, 10, 0}, {0, 0, 5}, {0, 8, 0}, 2, 2, {{}, 3, glm::dvec4(0.5)}));   // faces -x
    append(faces, grid({6.2, 10, 0}, {0, 8, 0}, {0, 0, 5}, 2, 2, {{}, 4, glm::dvec4(0.5)})); // faces +x
    for (u32 i = 5; i < faces.size(); i += 3) faces[i].rho *= 0.25;
    return faces;
}

/// Blocks of 6 x 6 x 9 m in n x n, 8 m apart, each wall and roof of 4 x 4 faces, on a ground of n x n.
std::vector<Face> blocks(u32 n)
{
    std::vector<Face> faces;
    u32 group = 0;
    const double extent = 14.0 * n;
    append(faces, grid({0, 0, 0}, {extent, 0, 0}, {0, extent, 0}, n, n, {{}, group++, glm::dvec4(0.2)}));
    const glm::dvec3 x(6, 0, 0), y(0, 6, 0), z(0, 0, 9);
    for (u32 block = 0; block < n * n; ++block) {
        const glm::dvec3 o(14.0 * (block % n) + 4.0, 14.0 * (block / n) + 4.0, 0.0);
        const auto side = [&](const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v) {
            append(faces, grid(corner, u, v, 4, 4, {{}, group++, glm::dvec4(0.5)}));
        };
        side(o, x, z);
        side(o + x, y, z);
        side(o + x + y, -x, z);
        side(o + y, -y, z);
        side(o + z, x, y);
    }
    return faces;
}

} // namespace

TEST(Transfer, FourPointsAgreeWithTheContourAndPartialNodesWithTheirPatches)
{
    std::vector<Face> faces = grid({0, 0, 0}, {3, 0, 0}, {0, 2, 0}, 1, 1, {{}, 0});
    append(faces, grid({40, 10, 30}, {0, 2, 0}, {4, 0, -1}, 1, 1, {{}, 1}));
    append(faces, grid({5, -3, 9}, {0, 2, 0}, {1, 0, 0}, 1, 1, {{}, 2})); // a facade with a gap: two squares 2 m apart
    append(faces, grid({8, -3, 9}, {0, 2, 0}, {1, 0, 0}, 1, 1, {{}, 2}));
    const NodeTree tree = makeTree(faces);
    const Transfer transfer(tree);
    const auto outline = [&](u32 node) { return planarShape(tree.outlineOf(node)); };
    EXPECT_NEAR(transfer.between(0, 1) / exchange(outline(0), outline(1)), 1.0, 1e-3);
    // The same sixteen terms in another order.
    EXPECT_NEAR(transfer.between(1, 0) / transfer.between(0, 1), 1.0, 1e-13);
    const u32 parent = tree.nodes[2].parent;
    ASSERT_EQ(tree.nodes[parent].kind, NodeKind::PlanarPartial);
    EXPECT_NEAR(tree.nodes[parent].coverage, 0.5, 1e-9);
    EXPECT_NEAR(transfer.between(0, parent) / (transfer.between(0, 2) + transfer.between(0, 3)), 1.0, 0.05);
}

TEST(Links, ExchangeIsReciprocalAndRowsDoNotExceedOne)
{
    const NodeTree tree = makeTree(street());
    const LightBake bake = bakeLight(tree, {});
    ASSERT_GT(bake.links.column.size(), 500u);
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        for (u32 k = bake.links.rowBegin[i]; k < bake.links.rowBegin[i + 1]; ++k) {
            ASSERT_GT(bake.links.factor[k], 0.0f);
            ASSERT_NE(tree.nodes[i].kind, NodeKind::Cluster);
            if (k > bake.links.rowBegin[i]) {
                ASSERT_LT(bake.links.column[k - 1], bake.links.column[k]) << "columns ascend";
            }
        }
    }
    // Each direction is refined on its own, so it is the exchange of whole planes that agrees: A_a F_ab = A_b F_ba.
    const std::vector<u32> root = planarRoots(tree);
    std::map<std::pair<u32, u32>, double> exchange;
    for (u32 i = 0; i < tree.nodeCount(); ++i)
        for (u32 k = bake.links.rowBegin[i]; k < bake.links.rowBegin[i + 1]; ++k)
            exchange[{root[i], root[bake.links.column[k]]}] += tree.nodes[i].area * double(bake.links.factor[k]);
    for (const auto& [pair, there] : exchange) {
        // A handful of links each way, whose visible shares are told by some hundred rays each.
        const double back = exchange[std::pair(pair.second, pair.first)],
                     smaller = std::min(tree.nodes[pair.first].area, tree.nodes[pair.second].area);
        EXPECT_NEAR(there, back, 0.06 * back + 1e-4 * smaller) << pair.first << " " << pair.second;
    }
    for (const double sum : patchRowSums(tree, bake.links)) EXPECT_LE(sum, 1.03);
    EXPECT_NEAR(bake.stats.closure.mean, 1.0, 2e-3);
    EXPECT_LT(std::abs(bake.stats.closureDefect), 5e-3);
}

TEST(Links, CoarseOnesAreFewerAndExchangeTheSame)
{
    const NodeTree tree = makeTree(blocks(3));
    const Visibility visibility(tree);
    const SkyScan scan = scanSky(tree, visibility, 256, 1, 1, {});
    const Training training = trainLights(tree, visibility, scan.sky, {}, 20, 1);
    const LinkBuild build = buildLinks(tree, visibility, training, {}, scan.rootPairs, {.epsilon = 2e-4, .jobs = 1});
    EXPECT_LT(build.coarse.size(), build.links.size() * 9 / 10);
    EXPECT_GT(build.coarse.size(), build.links.size() / 20);
    // Every exchange of a fine link is part of one coarse link: rows of planes add up to the same.
    const std::vector<double> fine = patchRowSums(tree, linkTable(tree, build.links, 1)),
                              coarse = patchRowSums(tree, linkTable(tree, build.coarse, 1));
    double sumFine = 0.0, sumCoarse = 0.0, differs = 0.0;
    for (u32 i = 0; i < tree.patchCount(); ++i) {
        sumFine += tree.patches[i].area * fine[i];
        sumCoarse += tree.patches[i].area * coarse[i];
        differs = std::max(differs, std::abs(fine[i] - coarse[i]));
    }
    EXPECT_NEAR(sumCoarse / sumFine, 1.0, 0.01);
    EXPECT_GT(differs, 1e-3) << "single patches show the difference";
}

TEST(Links, OcclusionOfASquareByASquare)
{
    // Unit squares 1 m apart, opaque 0.5 m square half-way / at three quarters: 0.0995062946 / 0.1156206021.
    for (const auto& [height, expected] : {std::pair(0.5, 0.0995062945990), std::pair(0.75, 0.115620602132)}) {
        std::vector<Face> faces = grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8, 8, {{}, 0});
        append(faces, grid({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 8, 8, {{}, 1}));
        append(faces, grid({.25, .25, height}, {.5, 0, 0}, {0, .5, 0}, 1, 1, {{}, 2}));
        const NodeTree tree = makeTree(faces);
        const LightBake bake = bakeLight(tree, {.formFactorEpsilon = 2e-4, .raysPerLink = 16});
        EXPECT_NEAR(groupExchange(tree, bake.links, 0, 64, 64, 128) / expected, 1.0, 0.01) << height;
    }
}

TEST(Links, NearPlatesBehindAHalfScreen)
{
    // 10 x 10 m plates 0.2 m apart, one patch each; a screen half-way covers half of the gap. Points that exchange are
    // 0.2 m apart, so the visible share is 1/2 and a little leak at the screen's edge (0.1 m of 10 m).
    std::vector<Face> faces = grid({0, 0, 0}, {10, 0, 0}, {0, 10, 0}, 1, 1, {{}, 0});
    append(faces, grid({0, 0, 0.2}, {0, 10, 0}, {10, 0, 0}, 1, 1, {{}, 1}));
    append(faces, grid({0, 0, 0.1}, {5, 0, 0}, {0, 10, 0}, 1, 1, {{}, 2}));
    const NodeTree tree = makeTree(faces);
    const double open = exchange(planarShape(tree.outlineOf(0)), planarShape(tree.outlineOf(1)));
    const LightBake bake = bakeLight(tree, {});
    EXPECT_NEAR(groupExchange(tree, bake.links, 0, 1, 1, 2) / open, 0.5, 0.05);
}

TEST(Links, TwoLeavesAreAlwaysLinked)
{
    // However large the error of such a link is estimated: here the whole scene is two single patches.
    std::vector<Face> faces = grid({0, 0, 0}, {10, 0, 0}, {0, 10, 0}, 1, 1, {{}, 0});
    append(faces, grid({0, 0, 1}, {0, 10, 0}, {10, 0, 0}, 1, 1, {{}, 1}));
    const NodeTree tree = makeTree(faces);
    const LightBake bake = bakeLight(tree, {.formFactorEpsilon = 1e-9});
    ASSERT_EQ(bake.links.column.size(), 2u);
    EXPECT_NEAR(100.0 * double(bake.links.factor[0]),
                exchange(planarShape(tree.outlineOf(0)), planarShape(tree.outlineOf(1))), 1e-4);
}

TEST(Links, InfiniteParallelPlatesAndTwoPatches)
{
    // 1000 x 1000 m, 1 m apart: F = 0.998. B1 = (E1 + rho1 F E2) / (1 - rho1 rho2 F^2); F = 1 when infinite.
    std::vector<Face> faces =
        grid({0, 0, 0}, {1000, 0, 0}, {0, 1000, 0}, 1, 1, {{}, 0, glm::dvec4(0.6), glm::dvec4(2.0)});
    append(faces, grid({0, 0, 1}, {0, 1000, 0}, {1000, 0, 0}, 1, 1, {{}, 1, glm::dvec4(0.3), glm::dvec4(1.0)}));
    const NodeTree tree = makeTree(faces);
    const LightBake bake = bakeLight(tree, {});
    const Solution s = solveLight(tree, bake.links, none(tree), none(tree), {.residual = 1e-10});
    const double f = exchange(planarShape(tree.outlineOf(0)), planarShape(tree.outlineOf(1))) / 1e6;
    EXPECT_NEAR(s.radiosity[0].x, (2.0 + 0.6 * f * 1.0) / (1.0 - 0.18 * f * f), 1e-5);
    EXPECT_NEAR(s.radiosity[0].x, 2.6 / 0.82, 0.005 * 2.6 / 0.82);
    EXPECT_NEAR(s.radiosity[1].x, 1.6 / 0.82, 0.005 * 1.6 / 0.82);
}

TEST(Links, FurnaceWithinItsRowSumError)
{
    const NodeTree tree = makeTree(room({10, 7, 4}, 4, {0.2, 0.5, 0.8, 0.0}, glm::dvec4(1.0)));
    const LightBake bake = bakeLight(tree, {});
    double defect = 0.0;
    for (const double sum : patchRowSums(tree, bake.links)) raise(defect, std::abs(sum - 1.0));
    EXPECT_LT(defect, 1e-3) << "no closure was applied: this is the factors' own error";
    const Solution s = solveLight(tree, bake.links, none(tree), none(tree), {.residual = 1e-8});
    for (u32 i = 0; i < tree.patchCount(); ++i) {
        for (u32 c = 0; c < 4; ++c) {
            const double rho = tree.patches[i].rho[c], exact = 1.0 / (1.0 - rho);
            EXPECT_NEAR(s.radiosity[i][c] / exact, 1.0, 1e-6 + rho * defect / (1.0 - rho * (1.0 + defect)));
        }
    }
}

TEST(Links, CubeWithGlowingFloorConverges)
{
    // Floor emits 1, rho 0.5: means 1.104362 / 0.171216 / 0.181106 (floor, ceiling, walls), converged to 2e-6.
    std::vector<Face> faces = room({1, 1, 1}, 8, glm::dvec4(0.5), glm::dvec4(0.0));
    for (Face& face : faces)
        if (face.group == 0) face.emission = glm::dvec4(1.0);
    const NodeTree tree = makeTree(faces);
    const LightBake bake = bakeLight(tree, {.formFactorEpsilon = 2e-4});
    const Solution s = solveLight(tree, bake.links, none(tree), none(tree), {.residual = 1e-8});
    const auto mean = [&](u32 begin, u32 end) {
        double sum = 0.0;
        for (u32 i = begin; i < end; ++i) sum += s.radiosity[i].x;
        return sum / double(end - begin);
    };
    EXPECT_NEAR(mean(0, 64) / 1.104362, 1.0, 1e-3);
    EXPECT_NEAR(mean(64, 128) / 0.171216, 1.0, 5e-3);
    EXPECT_NEAR(mean(128, 384) / 0.181106, 1.0, 5e-3);
}

TEST(Links, SameBytesForAnyNumberOfJobs)
{
    // More than one chunk of work in every step: 256 patches (sky), 16 pairs of roots (links), 4096 nodes (rows).
    const NodeTree tree = makeTree(blocks(7));
    ASSERT_GT(tree.patchCount(), 600u);
    ASSERT_GT(tree.nodeCount(), 4096u);
    for (const LinkMethod method : {LinkMethod::Heliopolis, LinkMethod::Paper, LinkMethod::PaperLiteral}) {
        const LightOptions options{
            .method = method, .formFactorEpsilon = method == LinkMethod::Heliopolis ? 2e-3 : 0.1, .raysPerPatch = 128};
        LightOptions serial = options, parallel = options;
        serial.jobs = 1;
        parallel.jobs = 3;
        const LightBake one = bakeLight(tree, serial), two = bakeLight(tree, parallel);
        EXPECT_GT(one.stats.rootPairCount, 40u);
        EXPECT_FALSE(one.links.column.empty());
        EXPECT_EQ(one.links.rowBegin, two.links.rowBegin);
        EXPECT_EQ(one.links.column, two.links.column);
        EXPECT_EQ(one.links.factor, two.links.factor);
        EXPECT_EQ(one.sky.factor, two.sky.factor);
    }
    const NodeTree small = makeTree(street());
    EXPECT_NE(bakeLight(small, {.seed = 2}).sky.factor, bakeLight(small, {}).sky.factor) << "the seed matters";
}

TEST(Links, TranslationToMapCoordinatesChangesNothingThatMatters)
{
    const NodeTree here = makeTree(street()), there = makeTree(moved(street(), {5e5, 4.5e6, 250.0}));
    const LightBake a = bakeLight(here, {}), b = bakeLight(there, {});
    const std::vector<double> rowsA = patchRowSums(here, a.links), rowsB = patchRowSums(there, b.links);
    for (u32 i = 0; i < here.patchCount(); ++i) EXPECT_NEAR(rowsA[i], rowsB[i], 0.02) << i;
    EXPECT_NEAR(a.stats.rowSum.mean, b.stats.rowSum.mean, 5e-4);
}

TEST(Links, SmallerEpsilonGivesMoreLinksAndLessError)
{
    const NodeTree tree = makeTree(room({10, 10, 10}, 8, glm::dvec4(0.5), glm::dvec4(1.0)));
    double lastError = 1.0;
    u64 lastCount = 0;
    for (const double epsilon : {8e-3, 2e-3, 5e-4}) {
        const LightBake bake = bakeLight(tree, {.formFactorEpsilon = epsilon});
        double square = 0.0;
        for (const double sum : patchRowSums(tree, bake.links)) square += (sum - 1.0) * (sum - 1.0) / tree.patchCount();
        EXPECT_GT(bake.stats.linkCount, lastCount);
        EXPECT_LT(std::sqrt(square), lastError);
        lastCount = bake.stats.linkCount;
        lastError = std::sqrt(square);
    }
    EXPECT_LT(lastError, 0.01);
}

TEST(Links, StatisticsNameTheValuesInUse)
{
    const NodeTree tree = makeTree(street());
    const LightStats chosen = bakeLight(tree, {}).stats;
    EXPECT_EQ(chosen.formFactorEpsilon, 0.07 * 0.02);
    EXPECT_EQ(chosen.raysPerPatch, 1024u);
    EXPECT_EQ(chosen.raysPerLink, 2u);
    EXPECT_EQ(bakeLight(tree, {.error = 0.01}).stats.formFactorEpsilon, 0.07 * 0.01);
    const LightStats given = bakeLight(tree, {.formFactorEpsilon = 3e-3, .raysPerPatch = 200, .raysPerLink = 7}).stats;
    EXPECT_EQ(given.formFactorEpsilon, 3e-3);
    EXPECT_EQ(given.raysPerPatch, 200u);
    EXPECT_EQ(given.raysPerLink, 7u);
    const LightStats paper = bakeLight(tree, {.method = LinkMethod::Paper, .raysPerLink = 7}).stats;
    EXPECT_EQ(paper.formFactorEpsilon, 0.02);
    EXPECT_EQ(paper.raysPerLink, 0u) << "no visibility";
}

TEST(Links, StatisticsNameTheShareOfTheAreaThatIsInside)
{
    // A closed box of 2 m, lit outside (24 m2), and 1 m2 in it, which sees nothing but back sides.
    const glm::dvec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 2), o(0.0);
    std::vector<Face> faces;
    append(faces, grid(o, y, x, 1, 1, {{}, 0}));
    append(faces, grid(z, x, y, 1, 1, {{}, 1}));
    append(faces, grid(o, z, y, 1, 1, {{}, 2}));
    append(faces, grid(x, y, z, 1, 1, {{}, 3}));
    append(faces, grid(o, x, z, 1, 1, {{}, 4}));
    append(faces, grid(y, z, x, 1, 1, {{}, 5}));
    append(faces, grid({.5, .5, 1}, {1, 0, 0}, {0, 1, 0}, 1, 1, {{}, 6}));
    const LightStats stats = bakeLight(makeTree(faces), {}).stats;
    EXPECT_EQ(stats.insidePatchCount, 1u);
    EXPECT_NEAR(stats.insideAreaShare, 1.0 / 25.0, 1e-12);
}

TEST(LinksDeathTest, MoreLinksThanRowsCanCountAreRefusedWithAWayOut)
{
    // Address space only: the count is refused before a link is read.
    const size_t count = kNoIndex;
    void* room = mmap(nullptr, count * sizeof(NodeLink), PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    ASSERT_NE(room, MAP_FAILED);
    const std::span links(static_cast<const NodeLink*>(room), count);
    EXPECT_DEATH(linkTable({}, links, 1), "limit is 4294967294 .*larger form factor epsilon");
    munmap(room, count * sizeof(NodeLink));
}

TEST(Links, ProgressRunsFromZeroToOneInEveryStep)
{
    const NodeTree tree = makeTree(street());
    std::string last;
    double done = 0.0;
    int finished = 0;
    bakeLight(tree, {.jobs = 2, .progress = [&](const char* step, double share) {
                         if (last != step) {
                             EXPECT_EQ(share, 0.0) << step;
                         } else {
                             EXPECT_GE(share, done) << step;
                         }
                         last = step;
                         done = share;
                         finished += share == 1.0;
                     }});
    EXPECT_GE(finished, 5);
}
