// SPDX-License-Identifier: Apache-2.0
// What the sun raster may leave out: backs of closed surfaces, and nothing else.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <set>

#include "engine/stream/draw_chunks.h"
#include "tests/support/tile_builder.h"

namespace helio {

namespace {

const glm::vec4 kGrey(0.5f);

/// An orthographic view that holds everything.
glm::mat4 wideView()
{
    glm::mat4 m(1e-6f);
    m[2][2] = 1e-9f;
    m[3] = glm::vec4(0.0f, 0.0f, 0.5f, 1.0f);
    return m;
}

/// Triangles, as the sets of their vertices, of a list of draws.
std::multiset<std::set<u32>> trianglesOf(const std::vector<gpu::DrawRecord>& draws, const std::vector<u32>& indices)
{
    std::multiset<std::set<u32>> out;
    for (const gpu::DrawRecord& draw : draws)
        for (u32 k = 0; k < draw.indexCount; k += 3) {
            const u32* const at = indices.data() + draw.firstIndex + k;
            for (u32 i = 0; i < draw.instanceCount; ++i)
                out.insert({at[0] + draw.vertexOffset, at[1] + draw.vertexOffset, at[2] + draw.vertexOffset});
        }
    return out;
}

struct Scene
{
    explicit Scene(TileBuilder& b) : view(b.view()), indices(view.indices.begin(), view.indices.end())
    {
        chunks = buildDrawChunks(view, indices);
    }
    FacingDraws draws(glm::vec3 sun) const { return facingDraws(chunks, wideView(), glm::vec4(sun, 0.0f)); }
    static u64 count(const std::vector<gpu::DrawRecord>& draws)
    {
        u64 all = 0;
        for (const gpu::DrawRecord& draw : draws) all += u64(draw.indexCount) / 3 * draw.instanceCount;
        return all;
    }

    TileView view;
    std::vector<u32> indices;
    std::vector<DrawChunk> chunks;
};

TEST(Facing, ReorderingKeepsEveryTriangle)
{
    TileBuilder b;
    for (int i = 0; i < 900; ++i) b.box({3.0f * float(i), 0, 0}, {3.0f * float(i) + 1.0f, 1, 1}, kGrey);
    b.quad({{{0, 5, 0}, {1, 5, 0}, {1, 6, 0}, {0, 6, 0}}}, kGrey);
    const Scene scene(b);
    const std::vector<u32> before(scene.view.indices.begin(), scene.view.indices.end());
    const std::vector<gpu::DrawRecord> all(scene.view.draws.begin(), scene.view.draws.end());
    EXPECT_EQ(trianglesOf(all, scene.indices), trianglesOf(all, before));
}

TEST(Facing, OfAClosedBoxTheSidesInTheSunRemain)
{
    TileBuilder b;
    b.box({0, 0, 0}, {1, 1, 1}, kGrey);
    const Scene scene(b);
    EXPECT_EQ(Scene::count(scene.draws({1, 2, 3}).closed), 6u) << "three sides of two triangles";
    EXPECT_EQ(Scene::count(scene.draws({0.001f, 0.002f, 1}).closed), 6u);
    EXPECT_EQ(Scene::count(scene.draws({0, 0, 1}).closed), 2u) << "on edge is no light";
    EXPECT_TRUE(scene.draws({1, 2, 3}).open.empty());
    // Which sides: those whose normal faces the sun.
    for (const gpu::DrawRecord& draw : scene.draws({1, 2, 3}).closed)
        for (u32 k = 0; k < draw.indexCount; k += 3) {
            const auto at = [&](u32 j) { return scene.view.vertices[scene.indices[draw.firstIndex + k + j]].position; };
            EXPECT_GT(glm::dot(glm::cross(at(1) - at(0), at(2) - at(0)), glm::vec3(1, 2, 3)), 0.0f);
        }
}

TEST(Facing, WhatAnEyeMaySeeIsNeverLeftOut)
{
    // Boxes side by side in one chunk, looked at from between them, from aside and from far away.
    TileBuilder b;
    for (const float x : {0.0f, 10.0f, 20.0f}) b.box({x, 0, 0}, {x + 1, 1, 1}, kGrey);
    const Scene scene(b);
    const auto& vertices = scene.view.vertices;
    for (const glm::vec3 eye : {glm::vec3(5, 0.5f, 0.5f), glm::vec3(15, -3, 4), glm::vec3(-200, 0.5f, 0.5f)}) {
        const FacingDraws draws = facingDraws(scene.chunks, wideView(), glm::vec4(eye, 1.0f));
        EXPECT_TRUE(draws.open.empty());
        const auto drawn = trianglesOf(draws.closed, scene.indices);
        u32 seen = 0;
        for (size_t k = 0; k < scene.indices.size(); k += 3) {
            const u32* const at = scene.indices.data() + k;
            const glm::vec3 p = vertices[at[0]].position;
            const glm::vec3 normal = glm::cross(vertices[at[1]].position - p, vertices[at[2]].position - p);
            if (glm::dot(normal, eye - p) <= 0.0f) continue;
            ++seen;
            EXPECT_TRUE(drawn.contains({at[0], at[1], at[2]})) << "triangle " << k / 3 << " from x = " << eye.x;
        }
        EXPECT_GE(seen, 6u);
    }
    // From far away along x the ends that look away are left out, as the chunk's box alone tells.
    EXPECT_LT(Scene::count(facingDraws(scene.chunks, wideView(), {-200, 0.5f, 0.5f, 1}).closed), 36u);
}

TEST(Facing, AnEyeGetsNearChunksFirstAndTheStaticMeshBeforeAssets)
{
    // A row of plates, in several chunks, and an asset at each end: open all, for their draws to stand in one list.
    TileBuilder b;
    const float length = 3.0f * float(kChunkTriangles);
    for (float x = 0.0f; x < length; ++x) b.quad({{{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}}}, kGrey);
    const std::array<glm::vec3, 4> unit{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
    for (const u32 place : {0u, 1u})
        b.asset(place, unit,
                {{glm::vec4(1, 0, 0, length * float(place)), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 2)}});
    const Scene scene(b);
    const auto places = [&](const glm::vec4& viewer) { // x, of every draw's first corner
        std::vector<float> out;
        for (const gpu::DrawRecord& draw : facingDraws(scene.chunks, wideView(), viewer).open)
            out.push_back(scene.view.vertices[scene.indices[draw.firstIndex] + draw.vertexOffset].position.x +
                          scene.view.instances[draw.firstInstance].worldFromLocal[0].w);
        return out;
    };
    const float third = length / 3.0f;
    // Where chunks follow each other as they lie among the indices they are one draw.
    EXPECT_EQ(places({-10, 0, 5, 1}), (std::vector<float>{0, 0, length}));
    const std::vector<float> backwards = places({length + 10, 0, 5, 1});
    ASSERT_EQ(backwards.size(), 8u) << "six chunks and two assets";
    for (size_t k = 0; k < 6; ++k) EXPECT_EQ(backwards[k], 0.5f * third * float(5 - k));
    EXPECT_EQ(backwards[6], length);
    EXPECT_EQ(backwards[7], 0.0f);
    EXPECT_EQ(places({1, 0, 0, 0}), (std::vector<float>{0, 0, length})) << "the sun's stay as they are";
}

TEST(Facing, WhatIsOpenIsNeverLeftOut)
{
    TileBuilder b;
    b.box({0, 0, 0}, {1, 1, 1}, kGrey);                            // closed
    b.quad({{{5, 0, 0}, {6, 0, 0}, {6, 1, 0}, {5, 1, 0}}}, kGrey); // a plate
    b.box({8, 0, 0}, {9, 1, 1}, kGrey, glm::vec4(0.0f), true);     // a room: faces inwards
    for (int k = 0; k < 5; ++k) {                                  // a box without its lid
        const std::array<glm::vec3, 8> c{
            {{20, 0, 0}, {21, 0, 0}, {21, 1, 0}, {20, 1, 0}, {20, 0, 1}, {21, 0, 1}, {21, 1, 1}, {20, 1, 1}}};
        const u32 sides[5][4] = {{3, 2, 1, 0}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
        b.quad({{c[sides[k][0]], c[sides[k][1]], c[sides[k][2]], c[sides[k][3]]}}, kGrey);
    }
    const Scene scene(b);
    for (const glm::vec3 sun : {glm::vec3(1, 2, 3), glm::vec3(-3, 1, 0.2f), glm::vec3(0, 0, 1)}) {
        const FacingDraws draws = scene.draws(sun);
        EXPECT_EQ(Scene::count(draws.open), 2u + 12u + 10u);
        EXPECT_LE(Scene::count(draws.closed), 6u);
    }
}

TEST(Facing, GoesByTheTurnOfEachInstance)
{
    // An asset that is a closed box, as six quads of one draw.
    TileBuilder b;
    b.assetBox(b.patch({0, 0, 1}, 1.0f, kGrey), {0, 0, 0}, {1, 1, 1},
               {{glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0)}});
    const float s = std::sqrt(0.5f);
    TileBuilder turned;
    turned.assetBox(turned.patch({0, 0, 1}, 1.0f, kGrey), {0, 0, 0}, {1, 1, 1},
                    {{glm::vec4(s, -s, 0, 0), glm::vec4(s, s, 0, 0), glm::vec4(0, 0, 1, 0)}});
    TileBuilder mirrored;
    mirrored.assetBox(mirrored.patch({0, 0, 1}, 1.0f, kGrey), {0, 0, 0}, {1, 1, 1},
                      {{glm::vec4(-1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0)}});
    // A sun from +x +y +z lights three sides of a box; one from +y lights two walls of a box turned by 45 degrees.
    EXPECT_EQ(Scene::count(Scene(b).draws({1, 1, 1}).closed), 6u);
    EXPECT_EQ(Scene::count(Scene(turned).draws({0, 1, 1}).closed), 6u);
    EXPECT_EQ(Scene::count(Scene(turned).draws({0, 0, 1}).closed), 2u);
    EXPECT_EQ(Scene::count(Scene(mirrored).draws({1, 1, 1}).open), 12u) << "a mirror turns it inside out";
}

} // namespace

} // namespace helio
