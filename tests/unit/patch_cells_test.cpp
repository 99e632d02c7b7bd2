// SPDX-License-Identifier: Apache-2.0
// How leaves become patches: bays, slivers, strips, covered walls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "city/model/build_nodes.h"

using namespace helio;

namespace {

/// A wall in the plane y = 0 that faces south: x to the east, z up.
Polygon3 wall(double x0, double z0, double x1, double z1)
{
    return {{{x0, 0, z0}, {x1, 0, z0}, {x1, 0, z1}, {x0, 0, z1}}, {}};
}

const std::vector<AssetSummary> kWindow{{glm::dvec4(0.1, 0.1, 0.1, 0.12), glm::dvec3(0.0)}};

struct Scene
{
    ShapeTree tree;

    Scene()
    {
        tree.names = {"shape"};
        tree.surfaces = {{"stone", glm::dvec4(0.4, 0.3, 0.2, 0.35), glm::dvec4(0.0)},
                         {"brick", glm::dvec4(0.3, 0.1, 0.1, 0.2), glm::dvec4(0.0)},
                         {"lamp", glm::dvec4(0.5), glm::dvec4(10, 8, 6, 9)}};
        tree.assets = {"window.glb"};
        tree.buildingIds = {"house"};
        tree.shapes.push_back({.building = 0});
    }
    u32 add(u32 parent, ShapeOp op = ShapeOp::Split)
    {
        u32 child = 0;
        for (const Shape& shape : tree.shapes) child += shape.parent == parent ? 1 : 0;
        tree.shapes.push_back({.parent = parent, .building = 0, .op = op, .child = child});
        return u32(tree.shapes.size()) - 1;
    }
    u32 addLeaf(u32 parent, const Polygon3& polygon, u32 surface = 0, bool window = false)
    {
        const u32 index = add(parent, window ? ShapeOp::Insert : ShapeOp::Split);
        Shape& shape = tree.shapes[index];
        shape.polygonBegin = u32(tree.polygons.size());
        shape.polygonCount = 1;
        shape.surface = surface;
        if (window) {
            shape.asset = 0;
            shape.placement = AssetPlacement::Fill;
        }
        tree.polygons.push_back(polygon);
        return index;
    }
    /// A floor of n bays: pier, column of strip, window and strip, and a last pier, as grammars make it. 3 x 3 m a bay.
    void addFloor(u32 facade, u32 n, double z, u32 windowSurface = 0)
    {
        const u32 row = add(facade);
        for (u32 i = 0; i < n; ++i) {
            const double x = 3.0 * i;
            addLeaf(row, wall(x, z, x + 1.8, z + 3));
            const u32 column = add(row);
            addLeaf(column, wall(x + 1.8, z, x + 3, z + 1));
            addLeaf(column, wall(x + 1.8, z + 1, x + 3, z + 2.4), windowSurface, true);
            addLeaf(column, wall(x + 1.8, z + 2.4, x + 3, z + 3));
        }
        addLeaf(row, wall(3.0 * n, z, 3.0 * n + 1, z + 3));
    }
    u32 addFacade(u32 n, u32 floors, u32 windowSurface = 0)
    {
        const u32 facade = add(0, ShapeOp::Component);
        for (u32 f = 0; f < floors; ++f) addFloor(facade, n, 3.0 * f, windowSurface);
        return facade;
    }
};

struct Totals
{
    double area = 0.0;
    glm::dvec4 rho{0.0}, emission{0.0};
};

Totals totals(const NodeTree& tree)
{
    Totals t;
    for (const Patch& patch : tree.patches) {
        t.area += patch.area;
        t.rho += patch.area * patch.rho;
        t.emission += patch.area * patch.emission;
    }
    return t;
}

void checkOutlines(const NodeTree& tree)
{
    for (u32 i = 0; i < tree.patchCount(); ++i) {
        glm::dvec3 sum(0.0);
        for (const Ring3& ring : tree.outlineOf(i)) sum += vectorArea(ring);
        EXPECT_NEAR(glm::length(sum), tree.patches[i].area, 1e-9) << i;
    }
}

} // namespace

TEST(PatchCells, ABayIsOnePatchWithMeanReflectance)
{
    Scene scene;
    scene.addFacade(1, 1);
    const NodeTreeBuild build = buildNodes(scene.tree, kWindow, {.patch = PatchMode::Bay});
    ASSERT_EQ(build.tree.patchCount(), 1u) << "pier, column and last pier: 4 x 3 m";
    const Patch& patch = build.tree.patches[0];
    EXPECT_NEAR(patch.area, 12.0, 1e-12);
    const double glass = 1.2 * 1.4 / 12.0;
    EXPECT_NEAR(patch.rho.r, (1 - glass) * 0.4 + glass * 0.1, 1e-12);
    EXPECT_NEAR(patch.rho.a, (1 - glass) * 0.35 + glass * 0.12, 1e-12);
    EXPECT_EQ(build.tree.outlineOf(0).size(), 1u);
    EXPECT_EQ(build.tree.outlineOf(0)[0].size(), 4u) << "the union is a rectangle";
    // Each part keeps its own reflectance for the picture.
    ASSERT_EQ(build.pieces.size(), 5u);
    EXPECT_EQ(std::count_if(build.pieces.begin(), build.pieces.end(),
                            [](const DrawnPiece& p) { return p.rho == glm::dvec4(0.4, 0.3, 0.2, 0.35); }),
              4);
    ASSERT_EQ(build.instances.size(), 1u);
    EXPECT_EQ(build.pieces[build.instances[0].piece].asset, 0u);
    EXPECT_EQ(build.pieces[build.instances[0].piece].rho, kWindow[0].rho);
}

TEST(PatchCells, PiecesOfOneMaterialAroundAnOpeningAreOnePatch)
{
    Scene scene;
    scene.addFacade(1, 1);
    const NodeTreeBuild build = buildNodes(scene.tree, kWindow);
    ASSERT_EQ(build.tree.patchCount(), 2u);
    EXPECT_NEAR(build.tree.patches[0].area, 12.0 - 1.2 * 1.4, 1e-12);
    EXPECT_EQ(build.tree.patches[0].rho, glm::dvec4(0.4, 0.3, 0.2, 0.35)) << "to the last bit";
    EXPECT_EQ(build.tree.outlineOf(0).size(), 2u) << "a rectangle with a hole";
    EXPECT_EQ(build.tree.patches[1].rho, kWindow[0].rho);
    EXPECT_EQ(build.tree.nodes[2].kind, NodeKind::Tiling);
    EXPECT_EQ(build.mergedCount, 3u);
    checkOutlines(build.tree);
}

TEST(PatchCells, OtherMaterialsAndFacesStayApart)
{
    Scene scene;
    const u32 facade = scene.add(0, ShapeOp::Component);
    scene.addLeaf(facade, wall(0, 0, 1, 3), 0);
    scene.addLeaf(facade, wall(1, 0, 2, 3), 1);
    scene.addLeaf(facade, wall(3, 0, 4, 3), 1); // a gap of 1 m
    const u32 other = scene.add(0, ShapeOp::Component);
    scene.addLeaf(other, wall(2, 0, 3, 3), 1);
    EXPECT_EQ(buildNodes(scene.tree, kWindow).tree.patchCount(), 4u);
    EXPECT_EQ(buildNodes(scene.tree, kWindow, {.patch = PatchMode::Bay}).tree.patchCount(), 4u)
        << "walls without an opening are no bay";
}

TEST(PatchCells, AWholeFacadeKeepsItsLedgerAndItsDepthIsLogarithmic)
{
    Scene scene;
    scene.addFacade(60, 40, 2); // the windows are lit
    const double area = 40 * (60 * 9.0 + 3.0), glass = 40 * 60 * 1.2 * 1.4;
    for (const PatchMode mode : {PatchMode::Piece, PatchMode::Bay}) {
        const NodeTreeBuild build = buildNodes(scene.tree, kWindow, {.patch = mode});
        const NodeTree& tree = build.tree;
        const Totals t = totals(tree);
        EXPECT_NEAR(t.area, area, 1e-9 * area);
        EXPECT_NEAR(t.rho.r, (area - glass) * 0.4 + glass * 0.1, 1e-9 * area);
        EXPECT_NEAR(t.rho.a, (area - glass) * 0.35 + glass * 0.12, 1e-9 * area);
        EXPECT_NEAR(t.emission.r, glass * 10, 1e-9 * area);
        EXPECT_NEAR(t.emission.a, glass * 9, 1e-9 * area);
        EXPECT_LE(build.areaDefect, 1e-9);
        EXPECT_EQ(build.overlapCount, 0u);
        checkOutlines(tree);
        const u32 bays = 60 * 40;
        EXPECT_LE(tree.patchCount(), (mode == PatchMode::Bay ? 1u : 2u) * bays + 40u) << "of 4 leaves a bay";
        EXPECT_LE(tree.nodes.back().height, 2u * 13u + 4u);
        EXPECT_NEAR(tree.nodes.back().coverage, 1.0, 1e-9);
        const u32 tiling = u32(std::count_if(tree.nodes.begin(), tree.nodes.end(),
                                             [](const Node& node) { return node.kind == NodeKind::Tiling; }));
        if (mode == PatchMode::Bay) {
            EXPECT_EQ(tiling, tree.nodeCount()) << "bays are rectangles, so are all above them";
        }
    }
}

TEST(PatchCells, RecursiveFloorsGiveABalancedTree)
{
    Scene scene;
    u32 at = scene.add(0, ShapeOp::Component);
    for (u32 f = 0; f < 150; ++f) {
        scene.addLeaf(at, wall(0, 3.0 * f, 12, 3.0 * f + 3), f % 2);
        at = scene.add(at);
    }
    const NodeTreeBuild build = buildNodes(scene.tree, kWindow);
    EXPECT_EQ(build.tree.patchCount(), 150u);
    EXPECT_EQ(build.tree.nodeCount(), 299u);
    EXPECT_EQ(build.tree.nodes.back().height, 8u);
}

TEST(PatchCells, SliversGoToANeighbourForLightOnly)
{
    Scene scene;
    const u32 facade = scene.add(0, ShapeOp::Component);
    scene.addLeaf(facade, wall(0, 0, 3, 3), 0);
    scene.addLeaf(facade, wall(3, 0, 3.03, 3), 1); // 3 cm
    const NodeTreeBuild build = buildNodes(scene.tree, kWindow);
    ASSERT_EQ(build.tree.patchCount(), 1u);
    EXPECT_EQ(build.sliverCount, 1u);
    EXPECT_NEAR(build.tree.patches[0].rho.r, (3.0 * 0.4 + 0.03 * 0.3) / 3.03, 1e-12);
    EXPECT_EQ(build.tree.patches[0].surface, 0u);
    ASSERT_EQ(build.pieces.size(), 2u);
    EXPECT_EQ(build.pieces[1].rho, glm::dvec4(0.3, 0.1, 0.1, 0.2)) << "drawn with its own";
    Scene wide;
    const u32 other = wide.add(0, ShapeOp::Component);
    wide.addLeaf(other, wall(0, 0, 3, 3), 0);
    wide.addLeaf(other, wall(3, 0, 3.06, 3), 1); // 6 cm
    EXPECT_EQ(buildNodes(wide.tree, kWindow).tree.patchCount(), 2u);
}

TEST(PatchCells, CoveredPartsAreApartFromTheirNeighbours)
{
    Scene scene;
    const u32 facade = scene.add(0, ShapeOp::Component);
    for (u32 i = 0; i < 4; ++i) {
        const u32 leaf = scene.addLeaf(facade, wall(2.0 * i, 0, 2.0 * i + 2, 3), 0);
        scene.tree.shapes[leaf].covered = i % 2 == 1;
    }
    const u32 sliver = scene.addLeaf(facade, wall(8, 0, 8.01, 3), 0);
    scene.tree.shapes[sliver].covered = false; // beside a covered part only
    const NodeTreeBuild build = buildNodes(scene.tree, kWindow);
    const NodeTree& tree = build.tree;
    EXPECT_EQ(build.coveredPatchCount, 2u);
    EXPECT_NEAR(build.coveredArea, 12.0, 1e-12);
    ASSERT_EQ(tree.patchCount(), 5u);
    u32 planar = 0;
    for (u32 i = tree.patchCount(); i < tree.nodeCount(); ++i) {
        if (tree.nodes[i].kind == NodeKind::Cluster) continue;
        ++planar;
        for (const u32 child : tree.childrenOf(i)) EXPECT_EQ(tree.nodes[child].covered, tree.nodes[i].covered) << i;
    }
    EXPECT_EQ(planar, 1u + 2u) << "a pair of covered parts; three free ones";
    EXPECT_EQ(tree.nodes.back().kind, NodeKind::Cluster);
    EXPECT_FALSE(tree.nodes.back().covered);
}

TEST(PatchCells, HighWallsAreCutIntoFloors)
{
    Scene scene;
    const u32 facade = scene.add(0, ShapeOp::Component);
    scene.addLeaf(facade, wall(0, 0, 10, 20));
    const NodeTreeBuild build = buildNodes(scene.tree, kWindow);
    ASSERT_EQ(build.tree.patchCount(), 6u) << "20 / 3.5 rounded up";
    EXPECT_EQ(build.stripCount, 6u);
    for (u32 i = 0; i < 6; ++i) {
        EXPECT_NEAR(build.tree.patches[i].area, 200.0 / 6, 1e-9);
        EXPECT_NEAR(build.tree.nodes[i].centroid.z, (i + 0.5) * 20 / 6, 1e-9);
        EXPECT_EQ(build.pieces[i].patch, i);
    }
    EXPECT_EQ(buildNodes(scene.tree, kWindow, {.stripHeight = 0.0}).tree.patchCount(), 1u);
    scene.tree.shapes.back().sourceFace = 7;
    EXPECT_EQ(buildNodes(scene.tree, kWindow).tree.patchCount(), 1u) << "a face of an OBJ stays one";
    scene.tree.shapes.back().sourceFace = kNoIndex;
    scene.tree.polygons[0] = {{{0, 0, 9}, {10, 0, 9}, {10, 20, 9}, {0, 20, 9}}, {}};
    EXPECT_EQ(buildNodes(scene.tree, kWindow).tree.patchCount(), 1u) << "a flat roof";
}

TEST(PatchCells, ALedgeAlongTheFacadeIsNoPartOfABay)
{
    Scene scene;
    const u32 facade = scene.add(0, ShapeOp::Component);
    for (u32 i = 0; i < 10; ++i) scene.addLeaf(facade, wall(3.0 * i, 0, 3.0 * i + 3, 3), i % 2);
    scene.addLeaf(facade, wall(0, 3, 30, 3.04), 0);   // 4 cm x 30 m
    scene.addLeaf(facade, wall(0, 3.04, 4, 3.08), 1); // and a short one on top of it
    const NodeTreeBuild build = buildNodes(scene.tree, kWindow);
    ASSERT_EQ(build.tree.patchCount(), 11u);
    for (u32 i = 0; i < 10; ++i) EXPECT_NEAR(build.tree.patches[i].area, 9.0, 1e-12) << i;
    EXPECT_NEAR(build.tree.patches[10].area, 30 * 0.04 + 4 * 0.04, 1e-12);
}

TEST(PatchCells, ASliverGoesWhereItsCommonSideIsLongest)
{
    Scene scene;
    const u32 facade = scene.add(0, ShapeOp::Component);
    scene.addLeaf(facade, wall(0, 0, 2, 3), 0);
    scene.addLeaf(facade, wall(2, 0, 3, 3), 1);
    scene.addLeaf(facade, wall(0, 3, 2.5, 3.04), 0); // 2 m above the first, 0.5 m above the second
    const NodeTree tree = buildNodes(scene.tree, kWindow).tree;
    ASSERT_EQ(tree.patchCount(), 2u);
    EXPECT_NEAR(tree.patches[0].area, 6.0 + 0.1, 1e-12);
    EXPECT_NEAR(tree.patches[1].area, 3.0, 1e-12);
}

TEST(PatchCells, ACubeOnTheFacadeIsAClusterBesideIt)
{
    Scene scene;
    const u32 facade = scene.add(0, ShapeOp::Component);
    scene.addLeaf(facade, wall(0, 0, 3, 3));
    const u32 sill = scene.add(facade, ShapeOp::Rule);
    Shape& shape = scene.tree.shapes[sill];
    shape.surface = 0;
    shape.polygonBegin = u32(scene.tree.polygons.size());
    // Its front lies in the wall's plane (a box let into the wall), so that only being a solid keeps it apart.
    const glm::dvec3 o(1, 0, 1), x(1, 0, 0), y(0, 0.2, 0), z(0, 0, 0.5);
    const auto quad = [&](const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
        scene.tree.polygons.push_back({{p, p + a, p + a + b, p + b}, {}});
    };
    quad(o, x, z);
    quad(o + x, y, z);
    quad(o + x + y, -x, z);
    quad(o + y, -y, z);
    quad(o + z, x, y);
    quad(o, y, x);
    scene.tree.shapes[sill].polygonCount = 6;
    scene.addLeaf(facade, wall(3, 0, 6, 3), 1);
    const NodeTreeBuild build = buildNodes(scene.tree, kWindow);
    const NodeTree& tree = build.tree;
    ASSERT_EQ(tree.patchCount(), 8u);
    const u32 cube = tree.nodes[1].parent;
    EXPECT_EQ(tree.nodes[cube].kind, NodeKind::Cluster);
    EXPECT_EQ(tree.nodes[cube].childCount, 6u);
    EXPECT_EQ(build.coveredPatchCount, 0u);
    const u32 plane = tree.nodes[0].parent;
    EXPECT_EQ(tree.nodes[plane].kind, NodeKind::Tiling);
    EXPECT_EQ(tree.nodes[7].parent, plane) << "both walls are one plane in spite of it";
    EXPECT_EQ(tree.nodes[plane].parent, tree.nodes[cube].parent);
}

TEST(PatchCells, WhatASolidPressesAgainstItsWallOrAnotherSolidExchangesNoLight)
{
    Scene scene;
    const u32 facade = scene.add(0, ShapeOp::Component);
    scene.addLeaf(facade, wall(0, 0, 3, 3));
    // Two fins, one on top of the other: back on the wall, front, and the end that touches the other fin.
    for (const double z : {0.0, 1.0}) {
        const u32 fin = scene.add(facade, ShapeOp::Rule);
        Shape& shape = scene.tree.shapes[fin];
        shape.surface = 0;
        shape.polygonBegin = u32(scene.tree.polygons.size());
        shape.polygonCount = 3;
        std::vector<Polygon3>& p = scene.tree.polygons;
        p.push_back({{{1, 0, z}, {1, 0, z + 1}, {2, 0, z + 1}, {2, 0, z}}, {}});
        p.push_back({{{1, -0.1, z}, {2, -0.1, z}, {2, -0.1, z + 1}, {1, -0.1, z + 1}}, {}});
        if (z == 0.0)
            p.push_back({{{1, -0.1, 1}, {2, -0.1, 1}, {2, 0, 1}, {1, 0, 1}}, {}}); // faces up
        else
            p.push_back({{{1, -0.1, 1}, {1, 0, 1}, {2, 0, 1}, {2, -0.1, 1}}, {}}); // faces down
    }
    const NodeTreeBuild build = buildNodes(scene.tree, kWindow);
    ASSERT_EQ(build.tree.patchCount(), 7u);
    const std::vector<bool> expected{false, true, false, true, true, false, true};
    for (u32 i = 0; i < 7; ++i) EXPECT_EQ(build.tree.patches[i].covered, expected[i]) << i;
}

TEST(PatchCells, FacesOfOneBuildingThatLieOnEachOtherExchangeNoLight)
{
    // A square that faces south; in its plane, to the north: two halves that hide it, then what hides less of another.
    const auto north = [](double x0, double z0, double x1, double z1) {
        Polygon3 polygon = wall(x0, z0, x1, z1);
        std::reverse(polygon.outer.begin(), polygon.outer.end());
        return polygon;
    };
    Scene scene;
    scene.tree.buildingIds.push_back("neighbour");
    const auto face = [&](const Polygon3& polygon, u32 building = 0) {
        const u32 index = scene.addLeaf(scene.add(0, ShapeOp::Component), polygon);
        scene.tree.shapes[index].building = building;
        return index;
    };
    face(wall(0, 0, 1, 1));
    face(north(0, 0, 1, 0.5));
    face(north(0, 0.5, 1, 1));
    face(wall(2, 0, 4, 1));
    face(north(2, 0, 3.7, 1)); // hides 85 % of it, and is hidden by it
    face(wall(5, 0, 6, 1));
    face(wall(7, 0, 8, 1));
    Polygon3 apart = north(7, 0, 8, 1); // 5 mm behind: there is a gap
    for (glm::dvec3& corner : apart.outer) corner.y = 0.005;
    face(apart);
    face(north(5, 0, 6, 1), 1);
    const NodeTreeBuild build = buildNodes(scene.tree, kWindow);
    ASSERT_EQ(build.tree.patchCount(), 9u);
    const std::vector<bool> expected{true, true, true, false, true, false, false, false, false};
    for (u32 i = 0; i < 9; ++i) EXPECT_EQ(build.tree.patches[i].covered, expected[i]) << i;
    EXPECT_NEAR(build.coveredArea, 1 + 0.5 + 0.5 + 1.7, 1e-12);
}

TEST(PatchCells, WhatIsHiddenTwiceCountsOnce)
{
    const auto north = [](double x0, double z0, double x1, double z1) {
        Polygon3 polygon = wall(x0, z0, x1, z1);
        std::reverse(polygon.outer.begin(), polygon.outer.end());
        return polygon;
    };
    const auto isCovered = [](const std::vector<Polygon3>& polygons) {
        Scene scene;
        for (const Polygon3& polygon : polygons) scene.addLeaf(scene.add(0, ShapeOp::Component), polygon);
        const NodeTree tree = buildNodes(scene.tree, kWindow, {.stripHeight = 0.0}).tree;
        EXPECT_EQ(tree.patchCount(), polygons.size());
        return tree.patches[0].covered;
    };
    const Polygon3 square = wall(0, 0, 10, 10);
    EXPECT_FALSE(isCovered({square, north(0, 0, 5, 10), north(0, 0, 5, 10)})) << "the same half twice";
    EXPECT_FALSE(isCovered({square, north(0, 0, 6, 10), north(4, 0, 8.9, 10)})) << "89 of 100 m2, 109 with the overlap";
    EXPECT_TRUE(isCovered({square, north(0, 0, 6, 10), north(4, 0, 9.1, 10)})) << "91 of 100 m2";
    // An L of 75 m2 and a square, which cover 75 m2 together, then 100 m2.
    const Polygon3 ell{{{0, 0, 0}, {0, 0, 10}, {5, 0, 10}, {5, 0, 5}, {10, 0, 5}, {10, 0, 0}}, {}};
    EXPECT_FALSE(isCovered({square, ell, north(0, 0, 5, 5)}));
    EXPECT_TRUE(isCovered({square, ell, north(5, 5, 10, 10)}));
    // 30 strips of 0.6 m that overlap by half: 0.3 * 31 = 9.3 m of 10 m.
    std::vector<Polygon3> strips{square}, fewer{square};
    for (u32 i = 0; i < 30; ++i) strips.push_back(north(0.3 * i, 0, 0.3 * i + 0.6, 10));
    for (u32 i = 0; i < 29; ++i) fewer.push_back(north(0.29 * i, 0, 0.29 * i + 0.6, 10)); // 8.72 m
    EXPECT_TRUE(isCovered(strips));
    EXPECT_FALSE(isCovered(fewer));
}

TEST(PatchCells, ADerivationThatIsGivenAwayMakesTheSameNodes)
{
    Scene scene;
    const u32 facade = scene.add(0, ShapeOp::Component);
    scene.addFloor(facade, 5, 0.0);
    scene.addFloor(facade, 5, 3.0);
    scene.addLeaf(scene.add(0, ShapeOp::Component), wall(20, 0, 30, 20)); // cut into strips
    const NodeTreeBuild kept = buildNodes(scene.tree, kWindow, {.patch = PatchMode::Bay});
    const NodeTreeBuild given = buildNodes(std::move(scene.tree), kWindow, {.patch = PatchMode::Bay});
    ASSERT_GT(kept.stripCount, 0u);
    ASSERT_GT(kept.mergedCount, 0u);
    EXPECT_EQ(given.tree.rings, kept.tree.rings);
    EXPECT_EQ(given.tree.ringIsHole, kept.tree.ringIsHole);
    EXPECT_EQ(given.tree.children, kept.tree.children);
    ASSERT_EQ(given.tree.nodeCount(), kept.tree.nodeCount());
    for (u32 i = 0; i < kept.tree.nodeCount(); ++i) {
        EXPECT_EQ(given.tree.nodes[i].centroid, kept.tree.nodes[i].centroid) << i;
        EXPECT_EQ(given.tree.nodes[i].area, kept.tree.nodes[i].area) << i;
    }
}

TEST(PatchCells, NarrowFinsAreNotCut)
{
    Scene scene;
    const u32 facade = scene.add(0, ShapeOp::Component);
    scene.addLeaf(facade, wall(0, 0, 0.5, 20));
    EXPECT_EQ(buildNodes(scene.tree, kWindow).tree.patchCount(), 1u);
}

TEST(PatchCells, KeysAreStableAndDifferent)
{
    Scene scene;
    scene.addFacade(3, 3);
    const NodeTree tree = buildNodes(scene.tree, kWindow).tree;
    std::set<u64> keys;
    for (const Patch& patch : tree.patches) keys.insert(patch.key);
    EXPECT_EQ(keys.size(), tree.patches.size());
    // Another building before it, and another facade behind it, change no key.
    Scene more;
    more.tree.buildingIds = {"other", "house"};
    more.addFacade(1, 1);
    const u32 root = u32(more.tree.shapes.size());
    more.tree.shapes.push_back({.building = 1});
    const u32 facade = more.add(root, ShapeOp::Component);
    for (u32 f = 0; f < 3; ++f) more.addFloor(facade, 3, 3.0 * f);
    const u32 behind = more.add(root, ShapeOp::Component);
    more.addFloor(behind, 2, 0.0);
    for (u32 i = root; i < more.tree.shapes.size(); ++i) more.tree.shapes[i].building = 1;
    std::set<u64> now;
    for (const Patch& patch : buildNodes(more.tree, kWindow).tree.patches) now.insert(patch.key);
    EXPECT_TRUE(std::includes(now.begin(), now.end(), keys.begin(), keys.end()));
}
