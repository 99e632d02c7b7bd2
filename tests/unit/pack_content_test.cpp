// SPDX-License-Identifier: Apache-2.0
// From a node tree to the records and meshes of a pack.
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "city/format/validate.h"
#include "city/pack/content_builder.h"
#include "city/pack/vertex_pack.h"

namespace helio {
namespace {

/// A facade of two tiles at y = 1000.3 that face south, a wall and a window that an asset fills, with a sill as
/// overlay; and 4 x 4 m of ground with a hole of 1 m2.
ShapeTree sampleShapes()
{
    const double y = 1000.3;
    ShapeTree t;
    t.names = {"Lot", "Facade", "Wall", "Window", "Sill", "Ground"};
    t.surfaces = {{"plaster", {0.6, 0.5, 0.4, 0.52}, glm::dvec4(0)}, {"asphalt", glm::dvec4(0.1), {0, 0, 3, 0}}};
    t.assets = {"unused.glb", "window.glb", "sill.glb"};
    t.buildingIds = {"a\nb"};
    t.polygons = {{{{0, y, 0}, {1, y, 0}, {1, y, 2}, {0, y, 2}}, {}},
                  {{{1, y, 0}, {3, y, 0}, {3, y, 2}, {1, y, 2}}, {}},
                  {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}, {{{1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}}}}};
    const auto add = [&](u32 parent, u32 name, u32 building, ShapeOp op) -> Shape& {
        Shape& shape = t.shapes.emplace_back();
        shape.parent = parent;
        shape.name = name;
        shape.building = building;
        shape.op = op;
        return shape;
    };
    add(kNoIndex, 0, 0, ShapeOp::Root);
    add(0, 1, 0, ShapeOp::Component);
    Shape& wall = add(1, 2, 0, ShapeOp::Split);
    wall.polygonBegin = 0, wall.polygonCount = 1, wall.surface = 0;
    Shape& window = add(1, 3, 0, ShapeOp::Insert);
    window.polygonBegin = 1, window.polygonCount = 1, window.surface = 0, window.asset = 1,
    window.placement = AssetPlacement::Fill;
    window.worldFromAsset =
        glm::dmat4x3(glm::dvec3(2, 0, 0), glm::dvec3(0, 0, 2), glm::dvec3(0, -1, 0), glm::dvec3(1, y, 0));
    Shape& sill = add(1, 4, 0, ShapeOp::Insert);
    sill.asset = 2, sill.placement = AssetPlacement::Overlay;
    sill.worldFromAsset =
        glm::dmat4x3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0), glm::dvec3(1.5, y, 0.2));
    add(kNoIndex, 5, kNoIndex, ShapeOp::Root);
    Shape& ground = add(5, 5, kNoIndex, ShapeOp::Split);
    ground.polygonBegin = 2, ground.polygonCount = 1, ground.surface = 1;
    return t;
}

/// A triangle with its box; the window's reaches one unit in front of the plane.
AssetMesh triangleAsset(float depth, const glm::dvec4& rho)
{
    AssetMesh mesh;
    mesh.positions = {{0, 0, depth}, {1, 0, depth}, {0, 1, depth}};
    mesh.normals.assign(3, {0, 0, 1});
    mesh.albedos.assign(3, {1, 0.5f, 0});
    mesh.isGlass.assign(3, depth > 0.0f);
    mesh.indices = {0, 1, 2};
    mesh.boxMin = {0, 0, 0};
    mesh.boxMax = {1, 1, double(depth)};
    mesh.rho = rho;
    return mesh;
}

struct Built
{
    NodeTreeBuild nodes;
    PackContent content;
    bool fits = false;
    std::string message{};
};

Built buildSample(const ContentLimits& limits = {}, const ShapeTree& shapes = sampleShapes(),
                  const NodeOptions& options = {})
{
    const std::vector<AssetMesh> meshes = {triangleAsset(9, glm::dvec4(0)), triangleAsset(1, {0.2, 0.2, 0.2, 0.3}),
                                           triangleAsset(0.25f, glm::dvec4(0))};
    std::vector<AssetSummary> summaries;
    for (const AssetMesh& mesh : meshes) summaries.push_back({mesh.rho, 0.5 * (mesh.boxMin + mesh.boxMax)});
    Built built{buildNodes(shapes, summaries, options), {}};
    LightBake light;
    light.links.rowBegin.assign(built.nodes.tree.nodeCount() + 1, 0);
    light.sky.skyPatches = {{{0, 0, 1}, 6.2831853f, {}}};
    light.sky.rowBegin = {0};
    for (u32 i = 0; i < built.nodes.tree.patchCount(); ++i) {
        light.sky.column.push_back(0);
        light.sky.factor.push_back(0.5f);
        light.sky.rowBegin.push_back(i + 1);
    }
    Result<PackContent> content = buildContent(built.nodes, meshes, std::move(light), limits);
    built.fits = content.ok();
    if (content)
        built.content = std::move(*content);
    else
        built.message = content.error().message;
    return built;
}

TEST(PackContent, IsValid)
{
    const Built built = buildSample();
    const Status status = validateTile(built.content.view(), built.content.index, {});
    EXPECT_TRUE(status.ok()) << status.error().message;
}

TEST(PackContent, MoreThanATileHoldsIsAnError)
{
    // Drawn are the wall (4 corners), the ground with its hole (8) and two assets of one triangle each.
    const Built all = buildSample();
    ASSERT_TRUE(all.fits);
    const size_t corners = all.content.outlinePoints.size(), vertices = all.content.vertices.size();
    EXPECT_EQ(vertices, 4u + 8u + 3u + 3u);
    EXPECT_TRUE(buildSample({.corners = corners}).fits);
    EXPECT_TRUE(buildSample({.vertices = vertices}).fits);
    const Built few = buildSample({.corners = corners - 1});
    EXPECT_FALSE(few.fits);
    EXPECT_NE(few.message.find("too many corners for one tile"), std::string::npos) << few.message;
    EXPECT_NE(buildSample({.vertices = vertices - 1}).message.find("too many vertices"), std::string::npos);
    EXPECT_NE(buildSample({.indices = all.content.indices.size() - 1}).message.find("too many indices"),
              std::string::npos);
}

TEST(PackContent, PatchesCarrySurfaceOrAsset)
{
    const Built built = buildSample();
    const std::vector<gpu::PatchRecord>& patches = built.content.patches;
    ASSERT_EQ(patches.size(), 3u);
    EXPECT_EQ(patches[0].rho, glm::vec4(0.6f, 0.5f, 0.4f, 0.52f));
    EXPECT_FLOAT_EQ(patches[0].area, 2.0f);
    EXPECT_EQ(patches[1].rho, glm::vec4(0.2f, 0.2f, 0.2f, 0.3f)) << "the asset's reflectance, not the wall's";
    EXPECT_FLOAT_EQ(patches[1].area, 4.0f);
    EXPECT_FLOAT_EQ(patches[2].area, 15.0f);
    EXPECT_EQ(patches[2].building, gpu::kNone);
    EXPECT_EQ(patches[2].emission, glm::vec4(0, 0, 3, 0));
    EXPECT_EQ(patches[2].surface, 1u);
    EXPECT_EQ(patches[2].normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(built.content.buildingIds, "a b\n") << "a line break would make two names of one";
    EXPECT_EQ(built.content.surfaceNames, "plaster\nasphalt\n");
}

TEST(PackContent, OutlinesKeepDoublePrecision)
{
    const Built built = buildSample();
    const PackContent& c = built.content;
    EXPECT_NE(double(c.outlinePoints[0].y), 1000.3) << "1000.3 is no float: the sample must need the rest";
    EXPECT_NEAR(double(c.outlinePoints[0].y) + double(c.outlineRests[0].y), 1000.3, 1e-11);
    // The ground's outline: outer ring of four corners, then a hole of four.
    const u32 ring = c.outlineRows[2];
    EXPECT_EQ(c.outlineRows[3] - ring, 2u);
    EXPECT_EQ(c.outlineRings[ring] & 1u, 0u);
    EXPECT_EQ(c.outlineRings[ring + 1] & 1u, 1u);
    EXPECT_EQ((c.outlineRings[ring + 2] >> 1) - (c.outlineRings[ring + 1] >> 1), 4u);
}

TEST(PackContent, StaticMeshCoversWhatNoAssetFills)
{
    const Built built = buildSample();
    const PackContent& c = built.content;
    ASSERT_GE(c.draws.size(), 1u);
    std::vector<double> area(3, 0.0);
    for (u32 k = 0; k < c.draws[0].indexCount; k += 3) {
        const gpu::VertexRecord &v0 = c.vertices[c.indices[k]], &v1 = c.vertices[c.indices[k + 1]],
                                &v2 = c.vertices[c.indices[k + 2]];
        const glm::vec3 twice = glm::cross(v1.position - v0.position, v2.position - v0.position);
        EXPECT_GT(glm::dot(twice, c.patches[v0.patchId].normal), 0.0f) << "front faces run counter-clockwise";
        EXPECT_EQ(v0.patchId, v1.patchId);
        EXPECT_EQ(v0.patchId, v2.patchId);
        EXPECT_EQ(v0.normal, packNormal(c.patches[v0.patchId].normal));
        EXPECT_EQ(v0.albedo, packAlbedo(glm::dvec3(c.patches[v0.patchId].rho)));
        area[v0.patchId] += 0.5 * double(glm::length(twice));
    }
    EXPECT_NEAR(area[0], 2.0, 1e-4);
    EXPECT_EQ(area[1], 0.0) << "the window is drawn by its asset";
    EXPECT_NEAR(area[2], 15.0, 1e-4);
}

TEST(PackContent, AssetsAreDrawnOncePerMesh)
{
    const Built built = buildSample();
    const PackContent& c = built.content;
    ASSERT_EQ(c.draws.size(), 3u) << "static mesh, window, sill; the unused asset is left out";
    ASSERT_EQ(c.instances.size(), 3u);
    EXPECT_EQ(c.instances[0].patchId, 0u);
    for (u32 d = 1; d < 3; ++d) {
        EXPECT_EQ(c.draws[d].indexCount, 3u);
        EXPECT_EQ(c.draws[d].instanceCount, 1u);
        EXPECT_EQ(c.draws[d].firstInstance, d);
        EXPECT_EQ(c.instances[d].patchId, 1u) << "the window fills patch 1 and the sill hangs before it";
    }
    // Asset corner (1, 0, 1) of the window: x doubled, one unit to the front (south), at the tile's corner.
    const gpu::InstanceRecord& window = c.instances[1];
    const glm::vec4 corner(1, 0, 1, 1);
    EXPECT_FLOAT_EQ(glm::dot(window.worldFromLocal[0], corner), 3.0f);
    EXPECT_FLOAT_EQ(glm::dot(window.worldFromLocal[1], corner), 999.3f);
    EXPECT_FLOAT_EQ(glm::dot(window.worldFromLocal[2], corner), 0.0f);
    EXPECT_EQ(c.vertices[c.draws[1].vertexOffset].albedo, 255u | 128u << 8 | 0u << 16) << "alpha 0: glass";
}

TEST(PackContent, BoundsHoldMeshesAndInstances)
{
    const PackIndex index = buildSample().content.index;
    EXPECT_EQ(index.boundsMin, glm::vec3(0, 0, 0));
    EXPECT_FLOAT_EQ(index.boundsMax.x, 4.0f);
    EXPECT_FLOAT_EQ(index.boundsMax.y, 1000.3f);
    EXPECT_FLOAT_EQ(index.boundsMax.z, 2.0f);
}

TEST(PackContent, ABayIsOnePatchWhosePartsKeepTheirAlbedo)
{
    const Built built = buildSample({}, sampleShapes(), {.patch = PatchMode::Bay});
    const PackContent& c = built.content;
    const Status status = validateTile(c.view(), c.index, {});
    ASSERT_TRUE(status.ok()) << status.error().message;
    ASSERT_EQ(c.patches.size(), 2u) << "wall and window; the ground";
    // 2 m2 of wall and 4 m2 of window.
    EXPECT_FLOAT_EQ(c.patches[0].area, 6.0f);
    EXPECT_FLOAT_EQ(c.patches[0].rho.r, float((2 * 0.6 + 4 * 0.2) / 6));
    EXPECT_FLOAT_EQ(c.patches[0].rho.a, float((2 * 0.52 + 4 * 0.3) / 6));
    u32 corners = 0;
    for (u32 v = 0; v < c.draws[1].vertexOffset; ++v) {
        if (c.vertices[v].patchId != 0) continue;
        ++corners;
        EXPECT_EQ(c.vertices[v].albedo, packAlbedo({0.6, 0.5, 0.4})) << "drawn with the wall's own colour";
    }
    EXPECT_EQ(corners, 4u);
    EXPECT_EQ(c.instances[1].patchId, 0u);
    EXPECT_EQ(c.instances[2].patchId, 0u);
}

TEST(PackContent, ATrimmedAssetIsCutAndDrawnByItself)
{
    // The sill is a triangle of corners (1.5, 0.2), (2.5, 0.2), (1.5, 1.2) in x and z; what lies beyond x = 2 goes.
    ShapeTree shapes = sampleShapes();
    shapes.trimPlanes = {{0, 0, 1, 100}, {-1, 0, 0, 2}};
    shapes.shapes[4].trimBegin = 1;
    shapes.shapes[4].trimCount = 1;
    const Built built = buildSample({}, shapes);
    const PackContent& c = built.content;
    const Status status = validateTile(c.view(), c.index, {});
    ASSERT_TRUE(status.ok()) << status.error().message;
    ASSERT_EQ(c.draws.size(), 2u) << "static mesh and window: the sill has no whole instance";
    EXPECT_EQ(c.instances.size(), 2u);
    double area = 0.0;
    for (u32 k = 0; k < c.draws[0].indexCount; k += 3) {
        const gpu::VertexRecord &v0 = c.vertices[c.indices[k]], &v1 = c.vertices[c.indices[k + 1]],
                                &v2 = c.vertices[c.indices[k + 2]];
        if (v0.patchId != 1) continue;
        const glm::vec3 twice = glm::cross(v1.position - v0.position, v2.position - v0.position);
        EXPECT_LT(twice.y, 0.0f) << "it still faces south";
        area += 0.5 * double(glm::length(twice));
        for (const gpu::VertexRecord* v : {&v0, &v1, &v2}) {
            EXPECT_LE(v->position.x, 2.0f + 1e-6f);
            EXPECT_NEAR(v->position.y, 1000.3 - 0.25, 1e-4);
            EXPECT_EQ(v->normal, packNormal({0, -1, 0}));
            EXPECT_EQ(v->albedo, packAlbedo({1, 0.5, 0}, true));
        }
    }
    EXPECT_NEAR(area, 0.5 - 0.125, 1e-5);
    // A plane that keeps nothing leaves nothing to draw.
    shapes.trimPlanes[1] = {-1, 0, 0, 1};
    EXPECT_EQ(buildSample({}, shapes).content.vertices.size(), 4u + 8u + 3u);
}

TEST(PackVertex, NormalsAndAlbedosByHand)
{
    EXPECT_EQ(packNormal({1, 0, 0}), 511u);
    EXPECT_EQ(packNormal({-1, 0, 0}), 1024u - 511u);
    EXPECT_EQ(packNormal({0, 1, 0}), 511u << 10);
    EXPECT_EQ(packNormal({0, 0, -1}), (1024u - 511u) << 20);
    EXPECT_EQ(packAlbedo({1, 0, 0}), 0xFF0000FFu);
    EXPECT_EQ(packAlbedo({0, 0.5, 2}), 0xFFFF8000u);
}

} // namespace
} // namespace helio
