// SPDX-License-Identifier: Apache-2.0
// The engine's pure parts: no device.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "engine/stream/draw_chunks.h"
#include "engine/stream/tile_tables.h"
#include "engine/stream/tree_levels.h"
#include "tests/support/tile_builder.h"

namespace helio {

namespace {

TEST(TreeLevels, OrdersByHeightAndWeighsByArea)
{
    TileBuilder b;
    for (const float area : {1.0f, 3.0f, 2.0f}) b.patch({0, 0, 1}, area, glm::vec4(0.5f));
    const u32 pair = b.group({0, 1});
    const u32 root = b.group({2, pair});
    const TileView view = b.view();
    const auto tree = buildTreeLevels(view.nodes, view.children, 3);
    ASSERT_TRUE(tree.ok());
    EXPECT_EQ(tree->levels, (std::vector<TreeLevel>{{pair, 1}, {root, 1}}));
    EXPECT_EQ(tree->childRows, (std::vector<u32>{0, 2, 4}));
    EXPECT_FLOAT_EQ(tree->children[1].weight, 0.75f);
    EXPECT_EQ(tree->children[3].node, pair);
    EXPECT_FLOAT_EQ(tree->children[3].weight, 4.0f / 6.0f);
}

TEST(TreeLevels, KeepsTheSlopesWithTheirChildren)
{
    // The pack lists the children of node 4 before those of node 3.
    const std::vector<gpu::NodeRecord> nodes{
        {3, 0, 0, 1.0f}, {3, 0, 0, 1.0f}, {4, 0, 0, 1.0f}, {4, 2, 2, 2.0f}, {kNoIndex, 0, 2, 3.0f}};
    const std::vector<u32> children{2, 3, 1, 0};
    std::vector<gpu::ChildSlopeRecord> slopes(4, gpu::ChildSlopeRecord{});
    for (u32 k = 0; k < 4; ++k) {
        slopes[k].offsetX = float(children[k]);
        slopes[k].yx = 10.0f * float(children[k]);
    }
    const auto tree = buildTreeLevels(nodes, children, 3, slopes);
    ASSERT_TRUE(tree.ok());
    ASSERT_EQ(tree->turns.size(), 4u);
    for (u32 k = 0; k < 4; ++k) {
        EXPECT_EQ(tree->children[k].offsetX, float(tree->children[k].node));
        EXPECT_EQ(tree->turns[k].z, 10.0f * float(tree->children[k].node));
    }
    EXPECT_EQ(tree->children[0].node, 1u);
}

TEST(TreeLevels, RefusesATreeOutOfOrder)
{
    const std::vector<u32> children{2, 0};
    // Node 1 is an inner node whose child 2 comes after it.
    const std::vector<gpu::NodeRecord> late{{2, 0, 0, 1.0f}, {kNoIndex, 0, 1, 1.0f}, {1, 1, 1, 1.0f}};
    EXPECT_FALSE(buildTreeLevels(late, children, 1).ok());
    // Child 0 names another parent than the node that lists it.
    const std::vector<gpu::NodeRecord> stray{{kNoIndex, 0, 0, 1.0f}, {kNoIndex, 1, 1, 1.0f}};
    EXPECT_FALSE(buildTreeLevels(stray, children, 1).ok());
}

/// A row of many boxes, with one asset in two places.
TileBuilder makeStreet()
{
    TileBuilder b;
    for (int i = 0; i < 800; ++i) b.box({10.0f * float(i), 0, 0}, {10.0f * float(i) + 5.0f, 5, 5}, glm::vec4(0.5f));
    const std::array<glm::vec3, 4> unit{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
    b.asset(0, unit, {{glm::vec4(1, 0, 0, 100), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 20)}});
    b.asset(1, unit, {{glm::vec4(1, 0, 0, 7000), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 20)}});
    return b;
}

u64 countTriangles(const std::vector<gpu::DrawRecord>& draws)
{
    u64 count = 0;
    for (const gpu::DrawRecord& draw : draws) count += u64(draw.indexCount) / 3 * draw.instanceCount;
    return count;
}

TEST(DrawChunks, CoverEveryTriangleOnceInsideTheirBoxes)
{
    TileBuilder b = makeStreet();
    const TileView view = b.view();
    std::vector<u32> indices(view.indices.begin(), view.indices.end());
    const std::vector<DrawChunk> chunks = buildDrawChunks(view, indices);
    std::set<std::pair<u32, u32>> seen; // index, instance
    for (const DrawChunk& chunk : chunks)
        for (u32 i = 0; i < chunk.draw.instanceCount; ++i)
            for (u32 k = 0; k < chunk.draw.indexCount; ++k) {
                const u32 instance = chunk.draw.firstInstance + i, index = chunk.draw.firstIndex + k;
                EXPECT_TRUE(seen.insert({index, instance}).second);
                const glm::vec4 p(view.vertices[indices[index] + chunk.draw.vertexOffset].position, 1.0f);
                for (int c = 0; c < 3; ++c) {
                    const float x = glm::dot(view.instances[instance].worldFromLocal[c], p);
                    EXPECT_GE(x, chunk.box.lo[c] - 1e-3f);
                    EXPECT_LE(x, chunk.box.hi[c] + 1e-3f);
                }
            }
    EXPECT_EQ(seen.size(), 800u * 36 + 12);
    EXPECT_GT(chunks.size(), 4u);
}

TEST(DrawChunks, CullWhatLiesBeyondAPlane)
{
    TileBuilder b = makeStreet();
    const TileView view = b.view();
    std::vector<u32> indices(view.indices.begin(), view.indices.end());
    const std::vector<DrawChunk> chunks = buildDrawChunks(view, indices);
    glm::mat4 all(0.0f), far(0.0f); // orthographic: x in [0, 8000], and x in [6500, 8500]
    for (glm::mat4* m : {&all, &far}) {
        (*m)[1][1] = (*m)[2][2] = 0.01f;
        (*m)[3][2] = 0.1f;
        (*m)[3][3] = 1.0f;
    }
    all[0][0] = 1.0f / 4000.0f, all[3][0] = -1.0f;
    far[0][0] = 1.0f / 1000.0f, far[3][0] = -7.5f;
    EXPECT_EQ(countTriangles(visibleDraws(chunks, all)), 800u * 12 + 4);
    EXPECT_EQ(visibleDraws(chunks, all).size(), 3u) << "neighbouring chunks of one draw are one draw again";
    const std::vector<gpu::DrawRecord> some = visibleDraws(chunks, far);
    EXPECT_LT(countTriangles(some), 400u * 12);
    EXPECT_GE(countTriangles(some), 150u * 12 + 2) << "the boxes beyond 6500 m and the asset at 7000 m";
    EXPECT_EQ(some.back().firstInstance, 2u);
}

} // namespace

} // namespace helio
