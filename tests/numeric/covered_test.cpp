// SPDX-License-Identifier: Apache-2.0
// Covered patches block light and exchange none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "city/light/bake_light.h"
#include "city/light/sun.h"
#include "tests/cities/tree_audit.h"
#include "tests/numeric/fixtures.h"

using namespace helio;
using namespace helio::test;

namespace {

/// A room with light from everywhere; one wall is marked as covered.
NodeTree roomWithCoveredWall()
{
    NodeTree tree = makeTree(room({4, 5, 3}, 3, glm::dvec4(0.5), glm::dvec4(1.0)));
    for (u32 i = 18; i < 27; ++i) tree.patches[i].covered = true; // wall 2
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        Node& node = tree.nodes[i];
        if (tree.isLeaf(i)) node.covered = tree.patches[i].covered;
        if (tree.isLeaf(i) || node.kind == NodeKind::Cluster) continue;
        node.covered = true;
        for (const u32 child : tree.childrenOf(i)) node.covered = node.covered && tree.nodes[child].covered;
    }
    return tree;
}

} // namespace

TEST(Covered, NoLinkAndNoSkyEndsAtACoveredPatch)
{
    const NodeTree tree = roomWithCoveredWall();
    for (const LinkMethod method : {LinkMethod::Heliopolis, LinkMethod::Paper}) {
        LightOptions options;
        options.method = method;
        options.raysPerPatch = 256;
        options.jobs = 1;
        const LightBake bake = bakeLight(tree, options);
        u32 links = 0;
        for (u32 i = 0; i < tree.nodeCount(); ++i) {
            const u32 begin = bake.links.rowBegin[i], end = bake.links.rowBegin[i + 1];
            EXPECT_TRUE(!tree.nodes[i].covered || begin == end) << "node " << i << " receives";
            for (u32 k = begin; k < end; ++k)
                EXPECT_FALSE(tree.nodes[bake.links.column[k]].covered) << "node " << bake.links.column[k] << " sends";
            links += end - begin;
        }
        EXPECT_GT(links, 0u);
        for (u32 i = 18; i < 27; ++i) EXPECT_EQ(bake.sky.rowBegin[i], bake.sky.rowBegin[i + 1]);
        EXPECT_EQ(bake.stats.coveredPatchCount, 9u);
        EXPECT_NEAR(bake.stats.coveredAreaShare, 15.0 / (2 * (20 + 15 + 12)), 1e-12);
    }
}

TEST(Covered, ItStillBlocksTheSunAndGetsNone)
{
    // A covered square 1 m over a patch of the same size, both facing up.
    std::vector<Face> faces = grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1, {{}, 0});
    append(faces, moved(grid({-5, -5, 0}, {11, 0, 0}, {0, 11, 0}, 1, 1, {{}, 1}), {0, 0, 1}));
    NodeTree tree = makeTree(faces);
    const Visibility visibility(tree);
    EXPECT_NEAR(raySun(tree, visibility, {0, 0, 1}, 16, 1)[1], 1.0, 1e-12);
    tree.patches[1].covered = true;
    const std::vector<double> sun = raySun(tree, visibility, {0, 0, 1}, 16, 1);
    EXPECT_EQ(sun[0], 0.0) << "in its shadow";
    EXPECT_EQ(sun[1], 0.0);
}

TEST(TreeAudit, FindsAPatchThatLooksIntoItsOwnBuilding)
{
    // A box seen from outside is a room whose faces are turned round.
    std::vector<Face> faces = room({4, 5, 3}, 2, glm::dvec4(0.5), glm::dvec4(0.0));
    for (Face& face : faces) std::reverse(face.ring.begin(), face.ring.end());
    ShapeTree none;
    NodeTreeBuild build;
    build.tree = makeTree(faces);
    EXPECT_EQ(auditTree(build, none, true, 1).facesInwards, 0u);
    std::reverse(faces[9].ring.begin(), faces[9].ring.end());
    build.tree = makeTree(faces);
    const TreeAudit audit = auditTree(build, none, true, 1);
    EXPECT_EQ(audit.facesInwards, 1u);
    EXPECT_FALSE(audit.good());
    ASSERT_EQ(audit.examples.size(), 1u);
    EXPECT_NE(audit.examples[0].find("node 9 "), std::string::npos) << audit.examples[0];
}

TEST(TreeAudit, FindsWhatIsWrongWithANode)
{
    const auto audit = [](auto&& spoil) {
        NodeTreeBuild build;
        build.tree = makeTree(room({4, 5, 3}, 2, glm::dvec4(0.5), glm::dvec4(0.0)));
        spoil(build.tree);
        return auditTree(build, {}, false, 1);
    };
    EXPECT_TRUE(audit([](NodeTree&) {}).good());
    EXPECT_EQ(audit([](NodeTree& t) { t.rings[0][1].x = NAN; }).notFinite, 1u);
    EXPECT_EQ(audit([](NodeTree& t) { t.nodes[3].area = 0.0; }).noArea, 1u);
    EXPECT_EQ(audit([](NodeTree& t) { t.nodes[3].normal *= 1.1; }).badNormal, 1u);
    EXPECT_EQ(audit([](NodeTree& t) { t.nodes[3].area *= 1.01; }).badOutline, 1u);
    EXPECT_GE(audit([](NodeTree& t) { t.nodes[3].area *= 1.01; }).badSum, 1u);
    EXPECT_EQ(audit([](NodeTree& t) { t.nodes[3].parent = 0; }).badLink, 2u) << "order, and not its parent's child";
    EXPECT_EQ(audit([](NodeTree& t) { t.nodes[3].covered = true; }).mixedCovered, 1u);
}
