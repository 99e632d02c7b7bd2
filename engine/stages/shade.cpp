// SPDX-License-Identifier: Apache-2.0
#include "engine/stages/shade.h"

#include "shaders/embedded.h"
#include "shaders/shared/solve.h"

namespace helio {

namespace {

constexpr VkFormat kVectors = VK_FORMAT_R32G32B32A32_SFLOAT;

const ReadVariants kSmoothLight{shaders::kSmoothLightComp, shaders::kSmoothLightImagesComp,
                                shaders::kSmoothLightStorageComp};
const ReadVariants kForwardVert{shaders::kForwardVert, shaders::kForwardImagesVert, shaders::kForwardStorageVert};
const ReadVariants kForwardFrag{shaders::kForwardFrag, shaders::kForwardImagesFrag, shaders::kForwardStorageFrag};

} // namespace

Ref<Buffer> addSmoothLight(FrameGraph& graph, const CornerTables& corners, Ref<Buffer> sky, Ref<Buffer> indirect,
                           Ref<Buffer> values, Reads reads)
{
    return graph.addPass("smooth light", [&](PassBuilder& pass) {
        const auto rows = pass.read(pass.import(corners.rows), Use::ComputeRead);
        const auto patches = pass.read(pass.import(corners.patches), Use::ComputeRead);
        const auto fromSky = pass.read(sky, Use::ComputeRead);
        const auto fromPatches = pass.read(indirect, Use::ComputeRead);
        const auto out = pass.write(values, Use::ComputeWrite);
        pass.record([=, count = corners.count](PassContext& ctx) {
            ctx.dispatch(kSmoothLight[reads],
                         {texels(gpu::kSmoothRows, rows, VK_FORMAT_R32_UINT),
                          texels(gpu::kSmoothPatches, patches, VK_FORMAT_R32_UINT),
                          texels(gpu::kSmoothSky, fromSky, kVectors),
                          texels(gpu::kSmoothIndirect, fromPatches, kVectors), storage(gpu::kSmoothValues, out)},
                         gpu::SmoothParams{count}, groupsFor(count, gpu::kSolveGroup));
        });
        return out;
    });
}

ShadeTargets addForward(FrameGraph& graph, const TileTables& tile, const DrawList& list, const ShadeInputs& in,
                        ShadeTargets targets)
{
    return graph.addPass("forward", [&](PassBuilder& pass) {
        const CityMesh mesh(pass, tile, list);
        const auto emission = pass.read(pass.import(tile.emission), Use::FragmentRead);
        const auto view = pass.read(in.view, Use::FragmentRead);
        const auto shadow = pass.read(in.shadow, Use::FragmentSample);
        const auto sun = pass.read(in.sun, Use::FragmentRead);
        const auto sky = pass.read(in.sky, Use::FragmentRead);
        const auto indirect = pass.read(in.indirect, Use::FragmentRead);
        const auto radiosity = pass.read(in.radiosity, Use::FragmentRead);
        const auto corners = pass.read(in.cornerOfVertex, Use::VertexRead);
        const auto smooth = pass.read(in.smooth, Use::VertexRead);
        const ShadeTargets out{pass.write(targets.radiance, Use::ColorTarget),
                               pass.write(targets.depth, Use::DepthTarget)};
        pass.record([=, params = in.params, mode = in.mode, interpolate = in.interpolate, emitters = in.emitters,
                     reads = tile.reads](PassContext& ctx) {
            RenderTargets to;
            to.colors = {{out.radiance, VkClearColorValue{}, 0}};
            to.depth = {out.depth, 0.0f, 0};
            ctx.render(to, [&](Drawing& drawing) {
                const auto drawPart = [&](bool smoothed, u32 first, u32 count) {
                    if (count == 0) return;
                    GraphicsPipelineDesc city;
                    city.vertex = &kForwardVert[reads];
                    city.fragment = &kForwardFrag[reads];
                    city.depthCompare = VK_COMPARE_OP_GREATER;
                    city.constants = {{0, mode}, {1, smoothed}, {2, emitters}};
                    CityMesh::describe(city, true);
                    drawing.pipeline(std::move(city));
                    drawing.bind({storage(gpu::kForwardView, view),
                                  sampled(gpu::kForwardShadow, shadow, Sampler::Nearest, {0, 0, true}),
                                  texels(gpu::kForwardEmission, emission, kVectors),
                                  texels(gpu::kForwardSun, sun, kVectors), texels(gpu::kForwardSky, sky, kVectors),
                                  texels(gpu::kForwardIndirect, indirect, kVectors),
                                  texels(gpu::kForwardRadiosity, radiosity, kVectors),
                                  texels(gpu::kForwardCorners, corners, VK_FORMAT_R32_UINT),
                                  texels(gpu::kForwardSmooth, smooth, kVectors)});
                    drawing.push(params);
                    mesh.draw(ctx, drawing, first, count);
                };
                drawPart(interpolate, 0, mesh.staticCount());
                drawPart(false, mesh.staticCount(), mesh.count() - mesh.staticCount());

                // The background lies at depth 0, where nothing was drawn.
                GraphicsPipelineDesc background;
                background.vertex = &shaders::kBackgroundVert;
                background.fragment = &shaders::kBackgroundFrag;
                background.depthCompare = VK_COMPARE_OP_GREATER_OR_EQUAL;
                background.depthWrite = false;
                background.constants = {{0, mode}};
                drawing.pipeline(std::move(background));
                drawing.bind({storage(gpu::kForwardView, view)});
                drawing.draw(3);
            });
        });
        return out;
    });
}

Ref<Image> addTone(FrameGraph& graph, Ref<Image> radiance, Ref<Image> display, const gpu::ToneParams& params)
{
    return graph.addPass("tone", [&](PassBuilder& pass) {
        const auto from = pass.read(radiance, Use::ComputeSample);
        const auto to = pass.write(display, Use::ComputeWrite);
        pass.record([=](PassContext& ctx) {
            ctx.dispatch(shaders::kToneComp,
                         {sampled(gpu::kToneInput, from, Sampler::Nearest), storage(gpu::kToneOutput, to)}, params,
                         groupsFor2D(params.width, params.height, gpu::kToneGroup, gpu::kToneGroup));
        });
        return to;
    });
}

} // namespace helio
