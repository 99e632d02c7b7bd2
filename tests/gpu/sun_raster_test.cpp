// SPDX-License-Identifier: Apache-2.0
// Stage 1 without the backs of closed surfaces gives the ids that it gives with everything, outlines aside: there a
// back that is moved a millimetre towards the sun, so that no light comes in along edges, wins a few texels from its
// front.
#include "engine/stages/sun_raster.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "city/base/hash.h"
#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tile_builder.h"

namespace helio {

namespace {

const glm::vec4 kGrey(0.5f);

class SunRasterTest : public GpuTest
{
protected:
    std::vector<u32> ids(const TileTables& tile, const SunView& sun, FacingDraws draws)
    {
        const FacingLists lists(context(), std::move(draws));
        const Image picture(context(), {"ids", sun.width, sun.height, kIdFormat, 1,
                                        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
        const Image depth(
            context(), {"depth", sun.width, sun.height, kDepthFormat, 1, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT});
        FrameGraph graph("sun");
        (void)addSunRaster(graph, tile, lists, sun, 0, {graph.import(picture), graph.import(depth)});
        const Status compiled = graph.compile(context());
        EXPECT_TRUE(compiled.ok()) << compiled.error().message;
        Recorder recorder(context());
        recorder.begin();
        graph.execute(recorder);
        recorder.submitAndWait();
        return downloadTexels<u32>(context(), picture);
    }
};

TEST_F(SunRasterTest, LeavingBacksOutChangesNothing)
{
    // Boxes that stand apart, closed assets on them that are turned, mirrored or stretched, and open things between.
    TileBuilder b;
    Random random(3);
    const auto between = [&](double lo, double hi) { return float(lo + (hi - lo) * random.uniform()); };
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 6; ++x) {
            const glm::vec3 foot(10.0f * float(x), 10.0f * float(y), 0.0f);
            const u32 box = b.box(foot, foot + glm::vec3(between(2, 6), between(2, 6), between(2, 9)), kGrey);
            const float turn = between(0, 6.3), c = std::cos(turn), s = std::sin(turn), mirror = x == 3 ? -1.0f : 1.0f;
            b.assetBox(box + 5, {0, 0, 0}, {1, 1, 1},
                       {{glm::vec4(mirror * c, -s, 0, foot.x + 8), glm::vec4(mirror * s, c, 0, foot.y + 2),
                         glm::vec4(0, 0, between(1, 3), foot.z + 1)}});
            const float z = foot.z + between(3, 8);
            b.quad(
                {{{foot.x - 2, foot.y, z}, {foot.x, foot.y, z}, {foot.x, foot.y + 2, z}, {foot.x - 2, foot.y + 2, z}}},
                kGrey);
        }
    b.quad({{{-5, -5, -0.5f}, {65, -5, -0.5f}, {65, 65, -0.5f}, {-5, 65, -0.5f}}}, kGrey);
    const TileView view = b.view();
    const auto tile = uploadTile(context(), view);
    ASSERT_TRUE(tile.ok());
    std::vector<Box> boxes;
    for (const DrawChunk& chunk : tile->chunks) boxes.push_back(chunk.box);
    for (const glm::dvec3 direction : {glm::dvec3(0.3, -0.5, 0.8), glm::dvec3(-0.9, 0.1, 0.2), glm::dvec3(0, 0, 1)}) {
        const glm::dvec3 towardsSun = glm::normalize(direction);
        const SunView sun = fitSunView(boxes, towardsSun, {.texel = 0.1, .maxViewSize = 2048});
        ASSERT_EQ(sun.viewCount(), 1u);
        const glm::mat4 clip = sun.clipFromWorld(0);
        FacingDraws all{{}, visibleDraws(tile->chunks, clip)},
            some = facingDraws(tile->chunks, clip, glm::vec4(towardsSun, 0.0));
        u64 closed = 0, everything = 0;
        for (const gpu::DrawRecord& draw : some.closed) closed += u64(draw.indexCount) * draw.instanceCount;
        for (const gpu::DrawRecord& draw : all.open) everything += u64(draw.indexCount) * draw.instanceCount;
        EXPECT_LT(closed, everything / 2 + 36) << "backs are left out";
        const std::vector<u32> expected = ids(*tile, sun, std::move(all)), seen = ids(*tile, sun, std::move(some));
        size_t apart = 0, lit = 0;
        for (size_t k = 0; k < seen.size(); ++k) {
            apart += seen[k] != expected[k];
            lit += seen[k] != kNoIndex;
        }
        EXPECT_LE(apart, lit / 10000) << direction.x;
        EXPECT_GT(lit, seen.size() / 4);
    }
}

} // namespace

} // namespace helio
