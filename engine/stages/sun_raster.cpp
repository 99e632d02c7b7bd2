// SPDX-License-Identifier: Apache-2.0
#include "engine/stages/sun_raster.h"

#include "shaders/embedded.h"
#include "shaders/shared/sun.h"

namespace helio {

namespace {

constexpr double kUnlitOffset = 0.001; // m

} // namespace

SunPictures addSunRaster(FrameGraph& graph, const TileTables& tile, const FacingLists& lists, const SunView& sun,
                         u32 view, SunPictures pictures)
{
    return graph.addPass(concat("sun raster ", view), [&](PassBuilder& pass) {
        const CityMesh closed(pass, tile, lists.closed), open(pass, tile, lists.open);
        SunPictures out;
        out.ids = pass.write(pictures.ids, Use::ColorTarget);
        out.depth = pass.write(pictures.depth, view == 0 ? Use::DepthTarget : Use::DepthTargetLoad);
        pass.record([=, params = gpu::SunRasterParams{sun.clipFromWorld(view),
                                                      glm::vec4(sun.towardsSun, float(kUnlitOffset / sun.depthRange))}](
                        PassContext& ctx) {
            RenderTargets targets;
            VkClearColorValue background{};
            background.uint32[0] = gpu::kNone;
            targets.colors = {{out.ids, background, 0}};
            targets.depth = {out.depth, 1.0f, view};
            ctx.render(targets, [&](Drawing& drawing) {
                const auto drawPart = [&](const CityMesh& mesh, VkCullModeFlags cull) {
                    if (mesh.count() == 0) return;
                    GraphicsPipelineDesc desc;
                    desc.vertex = &shaders::kSunRasterVert;
                    desc.fragment = &shaders::kSunRasterFrag;
                    desc.cull = cull;
                    desc.constants = {{0, cull == VK_CULL_MODE_NONE}};
                    CityMesh::describe(desc, false);
                    drawing.pipeline(std::move(desc));
                    drawing.push(params);
                    mesh.draw(ctx, drawing);
                };
                drawPart(open, VK_CULL_MODE_NONE);
                drawPart(closed, VK_CULL_MODE_BACK_BIT);
            });
        });
        return out;
    });
}

} // namespace helio
