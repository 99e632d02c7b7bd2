// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "city/model/build_nodes.h"

using namespace helio;

namespace {

/// A wall in the plane y = 0 that faces south (-y): x to the east, z up.
Polygon3 wall(double x0, double z0, double x1, double z1)
{
    return {{{x0, 0, z0}, {x1, 0, z0}, {x1, 0, z1}, {x0, 0, z1}}, {}};
}

struct Scene
{
    ShapeTree tree;

    Scene()
    {
        tree.names = {"shape"};
        tree.surfaces = {{"stone", glm::dvec4(0.4, 0.3, 0.2, 0.35), glm::dvec4(0.0)}};
        tree.buildingIds = {"house"};
        tree.shapes.push_back({.building = 0});
    }
    u32 add(u32 parent, ShapeOp op)
    {
        tree.shapes.push_back({.parent = parent, .building = 0, .op = op});
        return u32(tree.shapes.size()) - 1;
    }
    u32 addLeaf(u32 parent, const std::vector<Polygon3>& polygons, ShapeOp op = ShapeOp::Split)
    {
        const u32 index = add(parent, op);
        Shape& shape = tree.shapes[index];
        shape.polygonBegin = u32(tree.polygons.size());
        shape.polygonCount = u32(polygons.size());
        shape.surface = 0;
        tree.polygons.insert(tree.polygons.end(), polygons.begin(), polygons.end());
        return index;
    }
};

/// Every leaf a patch of its own.
const NodeOptions kPlain{.patch = PatchMode::Piece, .mergeSize = 0.0, .stripHeight = 0.0};

/// Invariants of every node tree (city/model/node_tree.h).
void checkTree(const NodeTree& tree)
{
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        const Node& node = tree.nodes[i];
        EXPECT_EQ(tree.isLeaf(i), node.childCount == 0) << i;
        if (node.parent != kNoIndex) {
            EXPECT_GT(node.parent, i);
            EXPECT_GT(tree.nodes[node.parent].height, node.height);
        }
        double sum = 0.0;
        for (const u32 child : tree.childrenOf(i)) {
            EXPECT_EQ(tree.nodes[child].parent, i);
            sum += tree.nodes[child].area;
        }
        if (node.childCount == 0) continue;
        EXPECT_NEAR(sum, node.area, 1e-9 * node.area);
        EXPECT_TRUE(node.kind != NodeKind::Tiling || std::abs(node.coverage - 1.0) <= 1e-5) << node.coverage;
    }
}

} // namespace

TEST(BuildNodes, ARowOfBaysBecomesABalancedBinaryTreeOfRectangles)
{
    Scene scene;
    const u32 facade = scene.add(0, ShapeOp::Component);
    for (int i = 0; i < 8; ++i) scene.addLeaf(facade, {wall(i, 0, i + 1, 3)});
    const NodeTree tree = buildNodes(scene.tree, {}, kPlain).tree;
    checkTree(tree);
    ASSERT_EQ(tree.patchCount(), 8u);
    EXPECT_EQ(tree.nodeCount(), 8u + 7u);
    const Node& root = tree.nodes.back();
    EXPECT_EQ(root.height, 3u);
    EXPECT_EQ(root.kind, NodeKind::Tiling);
    EXPECT_NEAR(root.area, 24.0, 1e-12);
    EXPECT_NEAR(glm::length(root.centroid - glm::dvec3(4, 0, 1.5)), 0.0, 1e-12);
    EXPECT_NEAR(glm::length(root.normal - glm::dvec3(0, -1, 0)), 0.0, 1e-12);
    EXPECT_EQ(tree.outlineOf(tree.nodeCount() - 1)[0].size(), 4u);
}

TEST(BuildNodes, TreeShapesShareThePatchesAndDifferAbove)
{
    // A row of four tiles that the rules take apart in a bad order (first and third, second and fourth), a lone tile on
    // a face of its own, and a solid of two planes.
    Scene scene;
    const u32 facade = scene.add(0, ShapeOp::Component);
    for (const int first : {0, 1}) {
        const u32 part = scene.add(facade, ShapeOp::Split);
        for (const int i : {first, first + 2}) scene.addLeaf(part, {wall(i, 0, i + 1, 3)});
    }
    scene.addLeaf(scene.add(0, ShapeOp::Component), {wall(9, 0, 10, 3)});
    scene.addLeaf(0, {wall(20, 0, 21, 1), {{{20, 0, 1}, {21, 0, 1}, {21, 1, 1}, {20, 1, 1}}, {}}});
    const auto build = [&](TreeShape shape) {
        NodeOptions options = kPlain;
        options.tree = shape;
        return buildNodes(scene.tree, {}, options).tree;
    };
    const NodeTree grammar = build(TreeShape::Grammar), free = build(TreeShape::Free), faces = build(TreeShape::Faces);
    const auto countIf = [](const NodeTree& tree, const auto& wanted) {
        u32 count = 0;
        for (u32 i = 0; i < tree.nodeCount(); ++i) count += wanted(i) ? 1 : 0;
        return count;
    };
    const auto partial = [&](const NodeTree& tree) {
        return countIf(tree, [&](u32 i) { return tree.nodes[i].kind == NodeKind::PlanarPartial; });
    };
    const auto planarRoots = [&](const NodeTree& tree) {
        return countIf(tree, [&](u32 i) { return tree.isPlanarRoot(i); });
    };
    for (const NodeTree* tree : {&grammar, &free, &faces}) {
        checkTree(*tree);
        ASSERT_EQ(tree->patchCount(), 7u);
        for (u32 i = 0; i < 7; ++i) {
            EXPECT_EQ(tree->patches[i].key, grammar.patches[i].key);
            EXPECT_EQ(tree->nodes[i].centroid, grammar.nodes[i].centroid);
        }
        EXPECT_EQ(countIf(*tree, [&](u32 i) { return tree->nodes[i].parent == kNoIndex; }), 1u);
    }
    EXPECT_EQ(planarRoots(grammar), 4u);
    EXPECT_EQ(partial(grammar), 2u) << "each with a gap as wide as a tile";
    EXPECT_EQ(planarRoots(free), 4u);
    EXPECT_EQ(partial(free), 0u);
    EXPECT_EQ(free.nodeCount(), grammar.nodeCount()) << "a binary tree over the same four";
    EXPECT_EQ(planarRoots(faces), 7u);
    EXPECT_EQ(countIf(faces, [&](u32 i) { return !faces.isLeaf(i) && faces.nodes[i].kind != NodeKind::Cluster; }), 0u);
}

TEST(BuildNodes, AFreeTreeIsBalancedOverAllPatchesOfAFacade)
{
    Scene scene;
    u32 rest = scene.add(0, ShapeOp::Component); // A rule that splits one tile off, again and again.
    scene.addLeaf(rest, {wall(0, 0, 1, 1)});
    for (int i = 1; i < 9; ++i) {
        rest = scene.add(rest, ShapeOp::Split);
        scene.addLeaf(rest, {wall(i, 0, i + 1, 1)});
    }
    NodeOptions options = kPlain;
    EXPECT_EQ(buildNodes(scene.tree, {}, options).tree.nodes.back().height, 8u);
    options.tree = TreeShape::Free;
    const NodeTree tree = buildNodes(scene.tree, {}, options).tree;
    checkTree(tree);
    EXPECT_EQ(tree.nodes.back().height, 4u);
    for (const Node& node : tree.nodes) EXPECT_EQ(node.kind, NodeKind::Tiling);
}

TEST(BuildNodes, AnOpeningMakesThePlanePartial)
{
    Scene scene;
    const u32 facade = scene.add(0, ShapeOp::Component);
    scene.addLeaf(facade, {wall(0, 0, 1, 3)});
    scene.addLeaf(facade, {wall(2, 0, 3, 3)}); // the middle third is NIL
    const NodeTree tree = buildNodes(scene.tree, {}).tree;
    checkTree(tree);
    EXPECT_EQ(tree.nodes.back().kind, NodeKind::PlanarPartial);
    EXPECT_NEAR(tree.nodes.back().coverage, 2.0 / 3.0, 1e-12);
}

TEST(BuildNodes, FacesOfASolidStayRootsOfTheirOwn)
{
    Scene scene;
    const u32 mass = scene.add(0, ShapeOp::Rule);
    const u32 front = scene.add(mass, ShapeOp::Component);
    scene.addLeaf(front, {wall(0, 0, 1, 3)});
    scene.addLeaf(front, {wall(1, 0, 2, 3)});
    const u32 coplanar = scene.add(mass, ShapeOp::Component); // another face in the same plane, 8 m away
    scene.addLeaf(coplanar, {wall(10, 0, 11, 3)});
    const NodeTree tree = buildNodes(scene.tree, {}).tree;
    checkTree(tree);
    u32 roots = 0;
    for (u32 i = 0; i < tree.nodeCount(); ++i) roots += tree.isPlanarRoot(i) ? 1 : 0;
    EXPECT_EQ(roots, 2u);
    EXPECT_EQ(tree.nodes.back().kind, NodeKind::Cluster);
}

TEST(BuildNodes, ProtrudingPartsDoNotBreakTheFacade)
{
    Scene scene;
    const u32 facade = scene.add(0, ShapeOp::Component);
    const u32 bay = scene.add(facade, ShapeOp::Split);
    scene.addLeaf(bay, {wall(0, 0, 1, 3)});
    const Polygon3 sillTop{{{0, 0, 1}, {0, -0.1, 1}, {1, -0.1, 1}, {1, 0, 1}}, {}};
    const Polygon3 sillFront{{{0, -0.1, 0.9}, {1, -0.1, 0.9}, {1, -0.1, 1}, {0, -0.1, 1}}, {}};
    scene.addLeaf(bay, {sillTop, sillFront}, ShapeOp::Rule);
    scene.addLeaf(facade, {wall(1, 0, 2, 3)});
    const NodeTree tree = buildNodes(scene.tree, {}, kPlain).tree;
    checkTree(tree);
    ASSERT_EQ(tree.patchCount(), 4u);
    // Both wall pieces hang under one planar node in spite of the sill between them.
    EXPECT_EQ(tree.nodes[0].parent, tree.nodes[3].parent);
    EXPECT_EQ(tree.nodes[tree.nodes[0].parent].kind, NodeKind::Tiling);
}

TEST(BuildNodes, AnAssetThatFillsItsTileGivesItsReflectanceAndAnOverlayTakesThePatchBehind)
{
    Scene scene;
    scene.tree.assets = {"window.glb", "balcony.glb"};
    const u32 facade = scene.add(0, ShapeOp::Component);
    scene.addLeaf(facade, {wall(0, 0, 1, 3)});
    const u32 window = scene.addLeaf(facade, {wall(1, 0, 2, 3)});
    scene.tree.shapes[window].asset = 0;
    scene.tree.shapes[window].placement = AssetPlacement::Fill;
    const u32 balcony = scene.add(facade, ShapeOp::Insert);
    scene.tree.shapes[balcony].asset = 1;
    scene.tree.shapes[balcony].placement = AssetPlacement::Overlay;
    scene.tree.shapes[balcony].worldFromAsset =
        glm::dmat4x3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0), glm::dvec3(1.5, -0.4, 1));
    const std::vector<AssetSummary> assets{{glm::dvec4(0.1), glm::dvec3(0.0)}, {glm::dvec4(0.9), glm::dvec3(0.0)}};
    const NodeTreeBuild build = buildNodes(scene.tree, assets);
    checkTree(build.tree);
    ASSERT_EQ(build.tree.patchCount(), 2u);
    EXPECT_EQ(build.tree.patches[0].rho, glm::dvec4(0.4, 0.3, 0.2, 0.35));
    EXPECT_EQ(build.tree.patches[1].rho, glm::dvec4(0.1));
    ASSERT_EQ(build.instances.size(), 2u);
    EXPECT_EQ(build.instances[1].asset, 1u);
    EXPECT_EQ(build.instances[1].patch, 1u);
    EXPECT_EQ(build.orphanOverlayCount, 0u);
}

TEST(BuildNodes, DegeneratePolygonsAreCountedNotKept)
{
    Scene scene;
    scene.addLeaf(0, {wall(0, 0, 1, 3), wall(1, 0, 1, 3)});
    const NodeTreeBuild build = buildNodes(scene.tree, {});
    EXPECT_EQ(build.degenerateCount, 1u);
    EXPECT_EQ(build.tree.patchCount(), 1u);
}

TEST(BuildNodes, AnEmptyDerivationIsAnEmptyTree)
{
    EXPECT_EQ(buildNodes(Scene().tree, {}).tree.nodeCount(), 0u);
}

TEST(BuildNodes, AFaceThatIsThereTwiceIsCounted)
{
    Scene scene;
    const u32 facade = scene.add(0, ShapeOp::Component);
    for (int i = 0; i < 4; ++i) scene.addLeaf(facade, {wall(i, 0, i + 1, 3)});
    const NodeTreeBuild good = buildNodes(scene.tree, {});
    EXPECT_EQ(good.overlapCount, 0u);
    EXPECT_LE(good.areaDefect, 1e-12);
    scene.addLeaf(facade, {wall(1, 0, 2, 3)});
    const NodeTreeBuild twice = buildNodes(scene.tree, {});
    EXPECT_GE(twice.overlapCount, 1u);
    EXPECT_GE(twice.areaDefect, 0.25 - 1e-12) << "15 m2 of wall in an outline of 12 m2, or more further down";
}

TEST(BuildNodes, TwentyThousandPlanesUnderOneShapeKeepTheirOrder)
{
    // Slats of 1 m x 0.1 m, one above the other, as one leaf's polygons and as leaves of their own. Each lies in its
    // own plane but for the last one, which continues the first to the east.
    constexpr u32 kCount = 20000;
    const auto slat = [](double x, double z) {
        return Polygon3{{{x, 0, z}, {x + 1, 0, z}, {x + 1, 0.1, z}, {x, 0.1, z}}, {}};
    };
    for (const bool oneLeaf : {true, false}) {
        Scene scene;
        const u32 face = scene.add(0, ShapeOp::Component);
        std::vector<Polygon3> slats;
        for (u32 i = 0; i < kCount; ++i) slats.push_back(slat(0, 0.01 * i));
        slats.push_back(slat(1, 0));
        if (oneLeaf)
            scene.addLeaf(face, slats);
        else
            for (const Polygon3& polygon : slats) scene.addLeaf(face, {polygon});
        const NodeTree tree = buildNodes(scene.tree, {}, kPlain).tree;
        ASSERT_EQ(tree.patchCount(), oneLeaf ? kCount : kCount + 1);
        const u32 root = tree.nodeCount() - 1;
        EXPECT_EQ(tree.nodes[root].kind, NodeKind::Cluster);
        ASSERT_EQ(tree.nodes[root].childCount, kCount);
        for (u32 i = 0; i < kCount; ++i)
            ASSERT_NEAR(tree.nodes[tree.childrenOf(root)[i]].centroid.z, 0.01 * i, 1e-9) << i;
        const Node& first = tree.nodes[tree.childrenOf(root)[0]];
        EXPECT_NEAR(first.area, 0.2, 1e-12);
        EXPECT_EQ(first.childCount, oneLeaf ? 0u : 2u);
    }
}

TEST(BuildNodes, TwentyThousandOverlaysHighAboveTheirTilesFindThem)
{
    // A roof of 3 x 3 m tiles in columns, each with a chimney 9 m above its middle: no patch is near enough for the
    // search to stop early. The last chimney stands beside the roof, 1 m south of the first tile and 4 m above it.
    constexpr u32 kSide = 141;
    Scene scene;
    scene.tree.assets = {"chimney.glb"};
    const auto place = [&](u32 parent, const glm::dvec3& at) {
        Shape& shape = scene.tree.shapes[scene.add(parent, ShapeOp::Insert)];
        shape.asset = 0;
        shape.placement = AssetPlacement::Overlay;
        shape.worldFromAsset[3] = at;
    };
    const u32 roof = scene.add(0, ShapeOp::Component);
    for (u32 x = 0; x < kSide; ++x) {
        const u32 column = scene.add(roof, ShapeOp::Split);
        for (u32 y = 0; y < kSide; ++y) {
            const glm::dvec3 o(3.0 * x, 3.0 * y, 20);
            const u32 tile = scene.add(column, ShapeOp::Split);
            scene.addLeaf(tile, {{{o, o + glm::dvec3(3, 0, 0), o + glm::dvec3(3, 3, 0), o + glm::dvec3(0, 3, 0)}, {}}});
            place(tile, o + glm::dvec3(1.5, 1.5, 9));
        }
    }
    place(0, {1.5, -1, 24});
    const std::vector<AssetSummary> assets{{glm::dvec4(0.5), glm::dvec3(0.0)}};
    const NodeTreeBuild build = buildNodes(scene.tree, assets, kPlain);
    ASSERT_EQ(build.tree.patchCount(), kSide * kSide);
    ASSERT_EQ(build.instances.size(), size_t(kSide * kSide + 1));
    for (u32 i = 0; i < kSide * kSide; ++i) ASSERT_EQ(build.instances[i].patch, i);
    EXPECT_EQ(build.instances.back().patch, 0u);
}
