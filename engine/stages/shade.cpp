// SPDX-License-Identifier: Apache-2.0
#include "engine/stages/shade.h"

#include "shaders/embedded.h"
#include "shaders/shared/solve.h"

namespace helio {

namespace {

constexpr VkFormat kVectors = VK_FORMAT_R32G32B32A32_SFLOAT;

const ReadVariants kSoftLight{shaders::kSoftLightComp, shaders::kSoftLightImagesComp, shaders::kSoftLightStorageComp};
const ReadVariants kSmoothCorners{shaders::kSmoothCornersComp, shaders::kSmoothCornersImagesComp,
                                  shaders::kSmoothCornersStorageComp};
const ReadVariants kSmoothPatches{shaders::kSmoothPatchesComp, shaders::kSmoothPatchesImagesComp,
                                  shaders::kSmoothPatchesStorageComp};
const ReadVariants kSmoothFans{shaders::kSmoothFansComp, shaders::kSmoothFansImagesComp,
                               shaders::kSmoothFansStorageComp};
const ReadVariants kForwardVert{shaders::kForwardVert, shaders::kForwardImagesVert, shaders::kForwardStorageVert};
const ReadVariants kForwardFrag{shaders::kForwardFrag, shaders::kForwardImagesFrag, shaders::kForwardStorageFrag};
const ReadVariants kDebugViewFrag{shaders::kDebugViewFrag, shaders::kDebugViewImagesFrag,
                                  shaders::kDebugViewStorageFrag};

} // namespace

Ref<Buffer> addSoftLight(FrameGraph& graph, const TileTables& tile, Ref<Buffer> sky, Ref<Buffer> indirect,
                         const glm::vec4& skyTint, Ref<Buffer> light)
{
    return graph.addPass("soft light", [&](PassBuilder& pass) {
        const auto fromSky = pass.read(sky, Use::ComputeRead);
        const auto fromPatches = pass.read(indirect, Use::ComputeRead);
        const auto out = pass.write(light, Use::ComputeWrite);
        const gpu::SoftLightParams params{skyTint, tile.patchCount};
        pass.record([=, reads = tile.reads](PassContext& ctx) {
            ctx.dispatch(kSoftLight[reads],
                         {texels(gpu::kSoftSky, fromSky, kVectors), texels(gpu::kSoftIndirect, fromPatches, kVectors),
                          storage(gpu::kSoftLight, out)},
                         params, groupsFor(params.patchCount, gpu::kSolveGroup));
        });
        return out;
    });
}

Ref<Buffer> addSmoothLight(FrameGraph& graph, const SmoothTables& mesh, Ref<Buffer> means)
{
    return graph.addPass("smooth light", [&](PassBuilder& pass) {
        const auto read = [&](const Buffer& buffer) { return pass.read(pass.import(buffer), Use::ComputeRead); };
        const auto cornerRows = read(mesh.cornerRows), cornerPatches = read(mesh.cornerPatches);
        const auto patchRows = read(mesh.patchRows), patchWeights = read(mesh.patchWeights);
        const auto fanRows = read(mesh.fanRows), fanWeightRows = read(mesh.fanWeightRows);
        const auto fanWeights = read(mesh.fanWeights);
        const auto from = pass.read(means, Use::ComputeRead);
        const auto out = pass.write(pass.import(mesh.values), Use::ComputeReadWrite);
        pass.record([=, reads = mesh.reads, corners = mesh.cornerCount, patches = mesh.patchCount](PassContext& ctx) {
            const std::vector<Binding> bindings{texels(gpu::kSmoothMeans, from, kVectors),
                                                texels(gpu::kSmoothBefore, out, kVectors),
                                                storage(gpu::kSmoothValues, out)};
            const auto dispatch = [&](const ReadVariants& shader, u32 count, u32 round, std::vector<Binding> own) {
                own.insert(own.end(), bindings.begin(), bindings.end());
                const gpu::SmoothParams params{corners, patches, round};
                ctx.dispatchBytes(shader[reads], own, std::as_bytes(std::span(&params, 1)),
                                  groupsFor(count, gpu::kSolveGroup), {});
            };
            for (u32 round = 0; round < gpu::kSmoothRounds; ++round) {
                dispatch(kSmoothCorners, corners, round,
                         {texels(gpu::kSmoothRows, cornerRows, VK_FORMAT_R32_UINT),
                          texels(gpu::kSmoothItems, cornerPatches, VK_FORMAT_R32_UINT)});
                ctx.barrier();
                dispatch(kSmoothPatches, patches, round,
                         {texels(gpu::kSmoothRows, patchRows, VK_FORMAT_R32_UINT),
                          texels(gpu::kSmoothItems, patchWeights, VK_FORMAT_R32G32_UINT)});
                ctx.barrier();
            }
            dispatch(kSmoothFans, patches, 0,
                     {texels(gpu::kSmoothFans, fanRows, VK_FORMAT_R32_UINT),
                      texels(gpu::kSmoothRows, fanWeightRows, VK_FORMAT_R32_UINT),
                      texels(gpu::kSmoothItems, fanWeights, VK_FORMAT_R32G32_UINT)});
        });
        return out;
    });
}

ShadeTargets addForward(FrameGraph& graph, const TileTables& tile, const FacingLists& lists,
                        const SmoothTables& smoothMesh, const FacingLists& smoothLists, const ShadeInputs& in,
                        ShadeTargets targets)
{
    return graph.addPass("forward", [&](PassBuilder& pass) {
        const CityMesh closed(pass, tile, lists.closed), open(pass, tile, lists.open);
        const auto refined = [&](const DrawList& list) {
            return CityMesh(pass, smoothMesh.vertices, smoothMesh.indices, tile.instances, list);
        };
        const CityMesh smoothClosed = refined(smoothLists.closed), smoothOpen = refined(smoothLists.open);
        const auto view = pass.read(in.view, Use::VertexAndFragmentRead);
        const bool lit = in.mode == gpu::kModeFinal || in.mode == gpu::kModeSunVisibility;
        const auto shown = pass.read(lit ? pass.import(tile.emission) : in.shown, Use::FragmentRead);
        const auto shadow = lit ? pass.read(in.shadow, Use::FragmentSample) : in.shadow;
        const auto valueOfVertex = pass.read(pass.import(smoothMesh.valueOfVertex), Use::VertexRead);
        const auto light = pass.read(in.light, Use::VertexRead);
        const auto smooth = pass.read(in.smooth, Use::VertexRead);
        const ShadeTargets out{pass.write(targets.radiance, Use::ColorTarget),
                               pass.write(targets.depth, Use::DepthTarget)};
        pass.record([=, params = in.params, mode = in.mode, emitters = in.emitters, reads = tile.reads,
                     smoothReads = smoothMesh.reads](PassContext& ctx) {
            RenderTargets to;
            to.colors = {{out.radiance, VkClearColorValue{}, 0}};
            to.depth = {out.depth, 0.0f, 0};
            ctx.render(to, [&](Drawing& drawing) {
                const auto draw = [&](const CityMesh& mesh, bool twoSided, bool smoothed) {
                    if (mesh.count() == 0) return;
                    GraphicsPipelineDesc city;
                    city.vertex = &kForwardVert[smoothReads];
                    city.fragment = &(lit ? kForwardFrag : kDebugViewFrag)[reads];
                    city.cull = twoSided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT;
                    city.depthCompare = VK_COMPARE_OP_GREATER;
                    city.constants = {{0, mode}, {1, smoothed}, {2, emitters}};
                    CityMesh::describe(city, true);
                    drawing.pipeline(std::move(city));
                    std::vector<Binding> bindings{storage(gpu::kForwardView, view),
                                                  texels(gpu::kForwardShown, shown, kVectors),
                                                  texels(gpu::kForwardLight, smoothed ? smooth : light, kVectors),
                                                  texels(gpu::kForwardValueOf, valueOfVertex, VK_FORMAT_R32_UINT)};
                    if (lit) bindings.push_back(sampled(gpu::kForwardShadow, shadow, Sampler::Nearest, {0, 0, true}));
                    drawing.bind(bindings);
                    drawing.push(params);
                    mesh.draw(ctx, drawing);
                };
                draw(smoothOpen, true, true);
                draw(smoothClosed, false, true);
                draw(open, true, false);
                draw(closed, false, false);

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

Ref<Image> addTone(FrameGraph& graph, Ref<Image> radiance, Ref<Image> display, u32 mode, u32 samples,
                   const gpu::ToneParams& params)
{
    return graph.addPass("tone", [&](PassBuilder& pass) {
        const auto from = pass.read(radiance, Use::ComputeSample);
        const auto to = pass.write(display, Use::ComputeWrite);
        pass.record([=](PassContext& ctx) {
            ctx.dispatch(shaders::kToneComp,
                         {sampled(gpu::kToneInput, from, Sampler::Nearest), storage(gpu::kToneOutput, to)}, params,
                         groupsFor2D(params.width, params.height, gpu::kToneGroup, gpu::kToneGroup),
                         {{0, mode}, {1, samples}});
        });
        return to;
    });
}

} // namespace helio
