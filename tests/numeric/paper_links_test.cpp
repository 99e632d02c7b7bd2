// SPDX-License-Identifier: Apache-2.0
#include "city/light/paper_links.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "city/light/bake_light.h"
#include "tests/numeric/fixtures.h"

using namespace helio;
using namespace helio::test;

namespace {

/// A floor of n x n and, `gap` above it, a ceiling of m x m, both 10 x 10 m.
NodeTree floorAndCeiling(u32 n, u32 m, double gap)
{
    std::vector<Face> faces = grid({0, 0, 0}, {10, 0, 0}, {0, 10, 0}, n, n, {{}, 0});
    append(faces, grid({0, 0, gap}, {0, 10, 0}, {10, 0, 0}, m, m, {{}, 1}));
    return makeTree(faces);
}

/// Of the links in one direction: receivers before senders, as paperLinks gives them.
double totalExchange(const NodeTree& tree, const std::vector<NodeLink>& links)
{
    double sum = 0.0;
    for (size_t k = 0; k < links.size(); k += 2) sum += tree.nodes[links[k].receiver].area * double(links[k].factor);
    return sum;
}

} // namespace

TEST(PaperLinks, DiscFactorByHand)
{
    // 1 m2 facing 4 m2 at 10 m: 4 / (100 pi + 4).
    std::vector<Face> faces = grid({-.5, -.5, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1, {{}, 0});
    append(faces, grid({-1, -1, 10}, {0, 2, 0}, {2, 0, 0}, 1, 1, {{}, 1}));
    const NodeTree tree = makeTree(faces);
    EXPECT_NEAR(discFactor(tree.nodes[0], tree.nodes[1]), 4.0 / (100.0 * std::numbers::pi + 4.0), 1e-15);
    EXPECT_NEAR(discFactor(tree.nodes[1], tree.nodes[0]), 1.0 / (100.0 * std::numbers::pi + 1.0), 1e-15);
}

TEST(PaperLinks, EachDirectionHasItsOwnEstimate)
{
    // 100 m2 and 1 m2, centres 1 m apart, in either order. A link back by reciprocity would be 100 / (pi + 1) = 24.1.
    const std::vector<Face> large = grid({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, 1, 1, {{}, 0});
    const std::vector<Face> small = grid({-.5, -.5, 1}, {0, 1, 0}, {1, 0, 0}, 1, 1, {{}, 1});
    for (const bool largeFirst : {true, false}) {
        std::vector<Face> faces = largeFirst ? large : small;
        append(faces, largeFirst ? small : large);
        const NodeTree tree = makeTree(faces);
        const u32 big = largeFirst ? 0 : 1;
        for (const LinkMethod method : {LinkMethod::Paper, LinkMethod::PaperLiteral}) {
            const LinkTable links = bakeLight(tree, {.method = method, .formFactorEpsilon = 1.0}).links;
            ASSERT_EQ(links.factor.size(), 2u);
            ASSERT_EQ(links.column[links.rowBegin[big]], 1 - big);
            ASSERT_EQ(links.column[links.rowBegin[1 - big]], big);
            EXPECT_NEAR(double(links.factor[links.rowBegin[big]]), 1.0 / (std::numbers::pi + 1.0), 1e-7);
            EXPECT_NEAR(double(links.factor[links.rowBegin[1 - big]]), 100.0 / (std::numbers::pi + 100.0), 1e-7);
        }
    }
}

TEST(PaperLinks, LeafRuleKeepsTheLightThatThePrintedAlgorithmLoses)
{
    // Two leaves nearer than the threshold allows: the printed recursion has no children to go to and makes no link.
    const NodeTree leaves = floorAndCeiling(1, 1, 5.0);
    ASSERT_GT(discFactor(leaves.nodes[0], leaves.nodes[1]), 0.1);
    EXPECT_TRUE(paperLinks(leaves, {.epsilon = 0.1, .literal = true}).empty());
    const std::vector<NodeLink> repaired = paperLinks(leaves, {.epsilon = 0.1});
    ASSERT_EQ(repaired.size(), 2u);
    EXPECT_NEAR(double(repaired[0].factor), 100.0 / (25.0 * std::numbers::pi + 100.0), 1e-6);
    EXPECT_NEAR(double(repaired[1].factor), 100.0 / (25.0 * std::numbers::pi + 100.0), 1e-6);

    // One leaf, the other with children: the leaf hands the refinement over.
    const NodeTree uneven = floorAndCeiling(1, 2, 5.0);
    EXPECT_TRUE(paperLinks(uneven, {.epsilon = 0.1, .literal = true}).empty());
    EXPECT_EQ(paperLinks(uneven, {.epsilon = 0.1}).size(), 8u);
    // With a threshold above every factor both agree.
    EXPECT_EQ(paperLinks(uneven, {.epsilon = 1.0, .literal = true}).size(), 2u);
}

TEST(PaperLinks, RefinesTheNodeThatLooksLarge)
{
    // A small square before a large one, both with children: F small -> large is large, F large -> small is not. The
    // large one is to be opened, the small one stays whole. The printed rule opens the small one, down to its leaves,
    // and the light is gone.
    std::vector<Face> faces = grid({4.5, 4.5, 0}, {1, 0, 0}, {0, 1, 0}, 2, 2, {{}, 0});
    append(faces, grid({0, 0, 4}, {0, 10, 0}, {10, 0, 0}, 4, 4, {{}, 1}));
    const NodeTree tree = makeTree(faces);
    const std::vector<NodeLink> repaired = paperLinks(tree, {.epsilon = 0.2});
    EXPECT_GT(repaired.size(), 2u);
    for (const NodeLink& link : repaired) {
        EXPECT_TRUE(tree.isPlanarRoot(std::min(link.receiver, link.sender)) ||
                    tree.isPlanarRoot(std::max(link.receiver, link.sender)));
        EXPECT_NEAR(std::min(tree.nodes[link.receiver].centroid.z, tree.nodes[link.sender].centroid.z), 0.0, 1e-9);
        const u32 small = tree.nodes[link.receiver].centroid.z < 1.0 ? link.receiver : link.sender;
        EXPECT_NEAR(tree.nodes[small].area, 1.0, 1e-9);
    }
    EXPECT_TRUE(paperLinks(tree, {.epsilon = 0.2, .literal = true}).empty());
}

TEST(PaperLinks, CutOffByBoxesIsMonotoneUnderRefinement)
{
    // Two long walls that meet at a corner: the centres are 28 m apart, the nearest patches touch.
    std::vector<Face> faces = grid({0, 0, 0}, {0, 40, 0}, {0, 0, 4}, 8, 1, {{}, 0}); // faces +x
    append(faces, grid({0, 0, 0}, {0, 0, 4}, {40, 0, 0}, 1, 8, {{}, 1}));            // faces +y
    const NodeTree tree = makeTree(faces);
    EXPECT_TRUE(paperLinks(tree, {.epsilon = 0.01, .cutoff = 22.5, .literal = true}).empty());
    const std::vector<NodeLink> near = paperLinks(tree, {.epsilon = 0.01, .cutoff = 22.5});
    const std::vector<NodeLink> all = paperLinks(tree, {.epsilon = 0.01, .cutoff = 0.0});
    EXPECT_GT(near.size(), 20u);
    EXPECT_LE(totalExchange(tree, near), totalExchange(tree, all));
    EXPECT_GT(totalExchange(tree, near), 0.5 * totalExchange(tree, all));
}
