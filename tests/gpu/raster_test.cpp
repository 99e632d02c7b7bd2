// SPDX-License-Identifier: Apache-2.0
// Ids and depths of a few triangles, against what follows from their corners.
#include <functional>

#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "test_shaders/embedded.h"
#include "tests/support/gpu_fixture.h"

namespace helio {
namespace {

using Raster = GpuTest;

struct Corner
{
    float x, y, z;
    u32 id;
};
static_assert(sizeof(Corner) == 16);

constexpr u32 kWidth = 17; // odd, and not square
constexpr u32 kHeight = 10;
constexpr VkClearColorValue kBackground{.uint32 = {kNoIndex, 0, 0, 0}};

/// Two triangles that fill [x0, x1] x [y0, y1] of clip space at depth z.
void addRectangle(std::vector<Corner>& corners, float x0, float x1, float y0, float y1, float z, u32 id)
{
    const Corner a{x0, y0, z, id}, b{x1, y0, z, id}, c{x1, y1, z, id}, d{x0, y1, z, id};
    for (const Corner& corner : {a, b, c, a, c, d}) corners.push_back(corner);
}

/// The scene of these tests. Far: id 3 over the left part, x < 0. Near: id 8 over the top part, y > 0.
std::vector<Corner> scene()
{
    std::vector<Corner> corners;
    addRectangle(corners, -1, 1, 0, 1, 0.25f, 8);
    addRectangle(corners, -1, 0, -1, 1, 0.75f, 3);
    return corners;
}

/// What the pixel centre of column x and row y (row 0 on top) sees of the scene: x < 0 is columns 0..7 of 17 (the
/// centre of column 8 lies on x = 0, on the edge that the left rectangle does not own), y > 0 is rows 0..4 of 10.
u32 expectedId(u32 x, u32 y)
{
    if (y < 5) return 8;
    return x < 8 ? 3 : kNoIndex;
}

float expectedDepth(u32 x, u32 y)
{
    if (y < 5) return 0.25f;
    return x < 8 ? 0.75f : 1.0f;
}

bool isOnTheEdge(u32 x)
{
    return x == 8;
}

struct Pictures
{
    std::vector<u32> ids;
    std::vector<float> depths;
    std::vector<float> otherLayer;
};

/// Renders into layer 1 of two depth layers; layer 0 is cleared to 0.5.
Pictures renderScene(Context& context, const std::function<void(PassBuilder&)>& declare,
                     const std::function<void(Drawing&)>& draw)
{
    FrameGraph graph("raster");
    Ref<Image> ids, depths;
    graph.addPass("raster", [&](PassBuilder& pass) {
        declare(pass);
        ids = pass.write(pass.create(ImageDesc{"ids", kWidth, kHeight, VK_FORMAT_R32_UINT}), Use::ColorTarget);
        depths =
            pass.write(pass.create(ImageDesc{"depths", kWidth, kHeight, VK_FORMAT_D32_SFLOAT, 2}), Use::DepthTarget);
        pass.sideEffect();
        pass.record([=](PassContext& ctx) {
            ctx.render({.colors = {}, .depth = DepthAttachment{depths, 0.5f, 0}}, [](Drawing&) {});
            ctx.render({.colors = {{ids, kBackground}}, .depth = DepthAttachment{depths, 1.0f, 1}}, draw);
        });
    });
    const Status compiled = graph.compile(context);
    EXPECT_TRUE(compiled) << compiled.error().message;
    Recorder recorder(context);
    recorder.begin();
    graph.execute(recorder);
    recorder.submitAndWait();
    return {downloadTexels<u32>(context, graph.image(ids)), downloadTexels<float>(context, graph.image(depths), 1),
            downloadTexels<float>(context, graph.image(depths), 0)};
}

void expectScene(const Pictures& pictures)
{
    for (u32 y = 0; y < kHeight; ++y) {
        for (u32 x = 0; x < kWidth; ++x) {
            if (isOnTheEdge(x) && y >= 5) continue; // either neighbour is right
            EXPECT_EQ(pictures.ids[y * kWidth + x], expectedId(x, y)) << x << ", " << y;
            EXPECT_EQ(pictures.depths[y * kWidth + x], expectedDepth(x, y)) << x << ", " << y;
        }
    }
    EXPECT_EQ(pictures.otherLayer, std::vector<float>(kWidth * kHeight, 0.5f)) << "the other layer was touched";
}

GraphicsPipelineDesc pulling()
{
    return {.vertex = &test_shaders::kTrianglesVert, .fragment = &test_shaders::kTrianglesFrag};
}

TEST_F(Raster, PulledVertices)
{
    const Buffer corners = makeBuffer(context(), "corners", scene());
    Ref<Buffer> from;
    expectScene(renderScene(
        context(), [&](PassBuilder& pass) { from = pass.read(pass.import(corners), Use::VertexRead); },
        [&from](Drawing& draw) {
            draw.pipeline(pulling());
            draw.bind({storage(0, from)});
            draw.draw(12);
        }));
}

/// Attributes, indices and one instance that adds to the id, drawn by `draw`.
Pictures renderIndexed(Context& context, const std::function<void(Drawing&, Ref<Buffer> arguments)>& drawAll)
{
    std::vector<Corner> corners = scene();
    for (Corner& corner : corners) corner.id -= 2;
    std::vector<u32> indices(corners.size());
    for (u32 i = 0; i < indices.size(); ++i) indices[i] = u32(indices.size()) - 1 - i;
    const Buffer vertexBuffer = makeBuffer(context, "corners", corners);
    const Buffer indexBuffer = makeBuffer(context, "indices", indices);
    const Buffer instances = makeBuffer(context, "instances", std::vector<u32>{100, 2});
    // The last six indices are the first rectangle and the other way round.
    const std::vector<VkDrawIndexedIndirectCommand> commands{{6, 1, 6, 0, 1}, {6, 1, 0, 0, 1}};
    const Buffer arguments = makeBuffer(context, "arguments", commands);
    GraphicsPipelineDesc desc{.vertex = &test_shaders::kTrianglesAttributesVert,
                              .fragment = &test_shaders::kTrianglesFrag};
    desc.vertexSlots = {{sizeof(Corner), false}, {sizeof(u32), true}};
    desc.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                       {1, 0, VK_FORMAT_R32_UINT, offsetof(Corner, id)},
                       {2, 1, VK_FORMAT_R32_UINT, 0}};
    Ref<Buffer> vertices, index, instance, indirect;
    return renderScene(
        context,
        [&](PassBuilder& pass) {
            vertices = pass.read(pass.import(vertexBuffer), Use::VertexAttribute);
            instance = pass.read(pass.import(instances), Use::VertexAttribute);
            index = pass.read(pass.import(indexBuffer), Use::Index);
            indirect = pass.read(pass.import(arguments), Use::Indirect);
        },
        [&](Drawing& draw) {
            draw.pipeline(desc);
            draw.vertices(0, vertices);
            draw.vertices(1, instance);
            draw.indices(index);
            drawAll(draw, indirect);
        });
}

TEST_F(Raster, AttributesIndicesAndInstances)
{
    expectScene(renderIndexed(context(), [](Drawing& draw, Ref<Buffer>) {
        draw.drawIndexed(6, 1, 6, 0, 1);
        draw.drawIndexed(6, 1, 0, 0, 1);
    }));
}

TEST_F(Raster, IndirectDraws)
{
    if (!context().facts().drawIndirectFirstInstance) GTEST_SKIP() << "the device has no drawIndirectFirstInstance";
    expectScene(renderIndexed(context(),
                              [](Drawing& draw, Ref<Buffer> arguments) { draw.drawIndexedIndirect(arguments, 0, 2); }));
}

TEST_F(Raster, CullingKeepsCounterClockwise)
{
    // The same rectangle in both orders: with back faces culled only the counter-clockwise one (y up) is left.
    std::vector<Corner> corners;
    addRectangle(corners, -1, 1, -1, 1, 0.5f, 4);
    std::vector<Corner> flipped(corners.rbegin(), corners.rend());
    for (Corner& corner : flipped) corner.id = 6;
    corners.insert(corners.end(), flipped.begin(), flipped.end());
    const Buffer buffer = makeBuffer(context(), "corners", corners);
    Ref<Buffer> from;
    const Pictures pictures = renderScene(
        context(), [&](PassBuilder& pass) { from = pass.read(pass.import(buffer), Use::VertexRead); },
        [&from](Drawing& draw) {
            GraphicsPipelineDesc desc = pulling();
            desc.cull = VK_CULL_MODE_BACK_BIT;
            draw.pipeline(desc);
            draw.bind({storage(0, from)});
            draw.draw(12);
        });
    EXPECT_EQ(pictures.ids, std::vector<u32>(kWidth * kHeight, 4));
}

TEST_F(Raster, DepthBiasMovesDepth)
{
    std::vector<Corner> corners;
    addRectangle(corners, -1, 1, -1, 1, 0.5f, 4);
    const Buffer buffer = makeBuffer(context(), "corners", corners);
    Ref<Buffer> from;
    const auto depthOf = [&](float constant) {
        return renderScene(
                   context(), [&](PassBuilder& pass) { from = pass.read(pass.import(buffer), Use::VertexRead); },
                   [&](Drawing& draw) {
                       GraphicsPipelineDesc desc = pulling();
                       desc.depthBias = true;
                       draw.pipeline(desc);
                       draw.depthBias(constant, 0.0f);
                       draw.bind({storage(0, from)});
                       draw.draw(6);
                   })
            .depths[0];
    };
    EXPECT_EQ(depthOf(0.0f), 0.5f);
    EXPECT_GT(depthOf(1000.0f), 0.5f);
    EXPECT_LT(depthOf(-1000.0f), 0.5f);
}

TEST_F(Raster, ShadowSamplerComparesDepthLayers)
{
    const Buffer corners = makeBuffer(context(), "corners", scene());
    FrameGraph graph("shadow");
    const Ref<Image> depths = graph.addPass("depth only", [&](PassBuilder& pass) {
        const Ref<Buffer> from = pass.read(pass.import(corners), Use::VertexRead);
        const Ref<Image> to =
            pass.write(pass.create(ImageDesc{"depths", kWidth, kHeight, VK_FORMAT_D32_SFLOAT, 2}), Use::DepthTarget);
        pass.record([=](PassContext& ctx) {
            ctx.render({.colors = {}, .depth = DepthAttachment{to, 0.0f, 0}}, [](Drawing&) {});
            ctx.render({.colors = {}, .depth = DepthAttachment{to, 1.0f, 1}}, [=](Drawing& draw) {
                draw.pipeline({.vertex = &test_shaders::kTrianglesVert});
                draw.bind({storage(0, from)});
                draw.draw(12);
            });
        });
        return to;
    });
    const Ref<Buffer> lit = graph.addPass("compare", [&](PassBuilder& pass) {
        pass.read(depths, Use::ComputeSample);
        const Ref<Buffer> to =
            pass.write(pass.create(BufferDesc{"lit", kWidth * kHeight * sizeof(float)}), Use::ComputeWrite);
        pass.sideEffect();
        pass.record([=](PassContext& ctx) {
            struct Params
            {
                u32 layer;
                float reference;
            };
            ctx.dispatch(test_shaders::kCompareComp, {sampled(0, depths, Sampler::Shadow), storage(1, to)},
                         Params{1, 0.6f}, groupsFor(kWidth * kHeight, 64));
        });
        return to;
    });
    ASSERT_TRUE(graph.compile(context()));
    Recorder recorder(context());
    recorder.begin();
    graph.execute(recorder);
    recorder.submitAndWait();
    const std::vector<float> values = downloadItems<float>(context(), graph.buffer(lit));
    for (u32 y = 0; y < kHeight; ++y) {
        for (u32 x = 0; x < kWidth; ++x) {
            if (isOnTheEdge(x)) continue;
            EXPECT_EQ(values[y * kWidth + x], expectedDepth(x, y) >= 0.6f ? 1.0f : 0.0f) << x << ", " << y;
        }
    }
}

} // namespace
} // namespace helio
