// SPDX-License-Identifier: Apache-2.0
// The reference of the picture tests, tested on scenes small enough to know the answer.
#include "tests/screens/ray_view.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace helio {
namespace {

/// A floor of 20 x 20 m (patch 0), and a mesh that holds a wall of 2 x 3 m in the plane y = 0 (patch 0 of the mesh),
/// placed twice: at x = -5 with patch 7 and, turned by 90 degrees about z, at x = 5 with patch 9.
struct TwoWalls
{
    std::vector<gpu::VertexRecord> vertices;
    std::vector<u32> indices{0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 2, 3};
    std::vector<gpu::InstanceRecord> instances;
    std::vector<gpu::DrawRecord> draws{{6, 1, 0, 0, 0}, {6, 2, 6, 4, 1}};
    TileView tile;

    TwoWalls()
    {
        for (glm::vec3 corner : {glm::vec3(-10, -10, 0),
                                 {10, -10, 0},
                                 {10, 10, 0},
                                 {-10, 10, 0}, //
                                 {-1, 0, 0},
                                 {1, 0, 0},
                                 {1, 0, 3},
                                 {-1, 0, 3}})
            vertices.push_back({corner, 0, 0, 0});
        const auto place = [&](glm::vec4 x, glm::vec4 y, u32 patch) {
            gpu::InstanceRecord record{};
            record.worldFromLocal[0] = x;
            record.worldFromLocal[1] = y;
            record.worldFromLocal[2] = {0, 0, 1, 0};
            record.patchId = patch;
            instances.push_back(record);
        };
        place({1, 0, 0, 0}, {0, 1, 0, 0}, 0);
        place({1, 0, 0, -5}, {0, 1, 0, 0}, 7);
        place({0, -1, 0, 5}, {1, 0, 0, 0}, 9);
        tile.vertices = vertices;
        tile.indices = indices;
        tile.instances = instances;
        tile.draws = draws;
    }
};

constexpr glm::dvec3 kDown{0, 0, -1};

TEST(RayView, FindsPatchesOfMeshAndInstances)
{
    const TwoWalls walls;
    const RayScene scene(walls.tile);
    EXPECT_EQ(scene.triangleCount(), 6u);
    EXPECT_EQ(scene.look({0, 0, 10}, kDown, {0, 0, 1}).patch, 0u);
    EXPECT_EQ(scene.look({-5, -4, 1}, {0, 1, 0}, {0, 0, 1}).patch, 7u);
    const RayHit turned = scene.look({0, 0.5, 1}, {1, 0, 0}, {0, 0, 1}); // the second wall lies in the plane x = 5
    EXPECT_EQ(turned.patch, 9u);
    EXPECT_NEAR(turned.position.x, 5, 1e-12);
    EXPECT_NEAR(turned.normal.x, -1, 1e-12);
    EXPECT_EQ(scene.look({0, 0, 10}, {0, 0, 1}, {0, 0, 1}).patch, kNoIndex);
}

TEST(RayView, ShadowOfAWallHasTheLengthOfItsHeightOverTheTangent)
{
    const TwoWalls walls;
    const RayScene scene(walls.tile);
    // Sun in the south at 45 degrees: the wall of 3 m at y = 0 shades y in (0, 3) behind it, x within 1 m of -5.
    const glm::dvec3 toSun = glm::normalize(glm::dvec3(0, -1, 1));
    const auto lit = [&](double x, double y) { return scene.look({x, y, 10}, kDown, toSun).lit; };
    EXPECT_TRUE(lit(-5, -0.01));
    EXPECT_FALSE(lit(-5, 0.01));
    EXPECT_FALSE(lit(-5, 2.98));
    EXPECT_TRUE(lit(-5, 3.02));
    EXPECT_FALSE(lit(-4.01, 1.0));
    EXPECT_TRUE(lit(-3.99, 1.0));
    // The wall itself: lit from the south, dark from the north.
    EXPECT_TRUE(scene.look({-5, -4, 1}, {0, 1, 0}, toSun).lit);
    EXPECT_FALSE(scene.look({-5, 4, 1}, {0, -1, 0}, toSun).lit);
}

TEST(RayView, PictureHasItsTopUpAndItsRightRight)
{
    const TwoWalls walls;
    const RayScene scene(walls.tile);
    const RayCamera camera{{-5, -4, 1.5}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 1.0, 0.5};
    // Seen from 4 m, the wall reaches from -1 to 1 m and from -1.5 to 1.5 m about the axis: columns 3/8 to 5/8 of the
    // width, rows 1/8 to 7/8. Below it is the floor, above the horizon nothing.
    const RayPicture picture = tracePicture(scene, camera, {0, 0, 1}, 80, 40);
    EXPECT_EQ(picture.at(31, 20).patch, 7u);
    EXPECT_EQ(picture.at(48, 20).patch, 7u);
    EXPECT_EQ(picture.at(40, 6).patch, 7u);
    EXPECT_EQ(picture.at(40, 3).patch, kNoIndex);
    EXPECT_EQ(picture.at(40, 38).patch, 0u);
    EXPECT_EQ(picture.at(60, 2).patch, kNoIndex);
    EXPECT_TRUE(nearEdge(picture, camera.eye, 31, 5));
    EXPECT_FALSE(nearEdge(picture, camera.eye, 40, 20));
}

TEST(RayView, AgreementCountsWhatDiffersAndSkipsEdges)
{
    const TwoWalls walls;
    const RayScene scene(walls.tile);
    const RayCamera camera{{0, 0, 12}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, 0.5, 0.5};
    const RayPicture picture = tracePicture(scene, camera, glm::normalize(glm::dvec3(0, -1, 1)), 64, 64);
    std::vector<float> visibility;
    for (const RayHit& hit : picture.pixels) visibility.push_back(hit.lit ? 1.0f : 0.0f);
    Agreement same = compareVisibility(picture, camera.eye, visibility);
    EXPECT_EQ(same.agreeing, same.compared);
    EXPECT_GT(same.nearEdge, 0u);
    EXPECT_EQ(same.background, 0u);
    EXPECT_EQ(same.compared + same.nearEdge, 64u * 64u);

    // Flipping the visibility of one pixel far from edges is one disagreement.
    ASSERT_FALSE(nearEdge(picture, camera.eye, 32, 4));
    visibility[4 * 64 + 32] = 1 - visibility[4 * 64 + 32];
    EXPECT_EQ(compareVisibility(picture, camera.eye, visibility).agreeing, same.compared - 1);
}

} // namespace
} // namespace helio
