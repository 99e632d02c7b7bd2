// SPDX-License-Identifier: Apache-2.0
#include "engine/stages/gather.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/graph/pass_context.h"
#include "shaders/embedded.h"

namespace helio {

namespace {

constexpr VkFormat kVectors = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkFormat kWords4 = VK_FORMAT_R32G32B32A32_UINT;
constexpr VkFormat kWords2 = VK_FORMAT_R32G32_UINT;
constexpr VkFormat kWords = VK_FORMAT_R32_UINT;

const ReadVariants kPull{shaders::kPullComp, shaders::kPullImagesComp, shaders::kPullStorageComp};
const ReadVariants kGather{shaders::kGatherComp, shaders::kGatherImagesComp, shaders::kGatherStorageComp};
const ReadVariants kGatherUpdate{shaders::kGatherUpdateComp, shaders::kGatherUpdateImagesComp,
                                 shaders::kGatherUpdateStorageComp};
const ReadVariants kFirstLight{shaders::kFirstLightComp, shaders::kFirstLightImagesComp,
                               shaders::kFirstLightStorageComp};
const ReadVariants kResidualParts{shaders::kResidualPartsComp, shaders::kResidualPartsImagesComp,
                                  shaders::kResidualPartsStorageComp};
const ReadVariants kResidual{shaders::kResidualComp, shaders::kResidualImagesComp, shaders::kResidualStorageComp};

Ref<Buffer> addPull(FrameGraph& graph, const TileTables& tile, Ref<Buffer> values, const std::string& name, u32 stride)
{
    return graph.addPass(name, [&](PassBuilder& pass) {
        const auto rows = pass.read(pass.import(tile.childRows), Use::ComputeRead);
        const auto children = pass.read(pass.import(tile.children), Use::ComputeRead);
        const auto turns = pass.read(pass.import(tile.turns), Use::ComputeRead);
        const auto out = pass.write(values, Use::ComputeReadWrite);
        const ShaderCode& shader = kPull[tile.reads];
        pass.record([=, &shader, levels = tile.levels, patchCount = tile.patchCount](PassContext& ctx) {
            for (const TreeLevel& level : levels) {
                ctx.dispatch(shader,
                             {texels(gpu::kPullRows, rows, kWords), texels(gpu::kPullChildren, children, kWords4),
                              texels(gpu::kPullTurns, turns, kVectors), texels(gpu::kPullValues, out, kWords4),
                              storage(gpu::kPullOut, out)},
                             gpu::PullParams{level.first, level.count, patchCount, stride},
                             groupsFor(level.count, gpu::kSolveGroup), {{0, stride > 1}});
                ctx.barrier();
            }
        });
        return out;
    });
}

/// What the rows of patches need to become new radiosities.
struct Update
{
    const Buffer& reflectance;
    Ref<Buffer> b0, senders;
    glm::vec4 weight{1.0f};
};
struct GatherRefs
{
    Ref<Buffer> irradiance, senders;
};

GatherRefs addRows(FrameGraph& graph, const LinkBuffers& links, Ref<Buffer> senders, Ref<Buffer> irradiance,
                   const GatherOptions& options, const std::optional<Update>& update)
{
    return graph.addPass(options.name, [&](PassBuilder& pass) {
        struct Page
        {
            Ref<Buffer> records, moments;
            LinkPage page;
        };
        std::vector<Page> pages;
        for (const LinkBuffers::Page& page : links.pages)
            pages.push_back({pass.read(pass.import(page.records), Use::ComputeRead),
                             pass.read(pass.import(page.moments), Use::ComputeRead), page.page});
        const auto rows = pass.read(pass.import(links.rows), Use::ComputeRead);
        const auto strips = pass.read(pass.import(links.strips), Use::ComputeRead);
        const auto from = pass.read(senders, Use::ComputeRead);
        const GatherRefs out{pass.write(irradiance, Use::ComputeReadWrite),
                             update ? pass.write(update->senders, Use::ComputeReadWrite) : Ref<Buffer>{}};
        Ref<Buffer> reflectance, b0;
        if (update) {
            reflectance = pass.read(pass.import(update->reflectance), Use::ComputeRead);
            b0 = pass.read(update->b0, Use::ComputeRead);
        }
        const ShaderCode& plain = kGather[options.reads];
        const ShaderCode& updates = kGatherUpdate[options.reads];
        const u32 lastLevel = links.dispatches.empty() ? 0 : links.dispatches.back().level;
        pass.record([=, &plain, &updates, dispatches = links.dispatches, stride = links.stride,
                     factorBits = links.factorBits, patchCount = links.senderPatches, scale = options.scale,
                     weight = update ? update->weight : glm::vec4(1.0f),
                     updating = update.has_value()](PassContext& ctx) {
            for (const LinkDispatch& dispatch : dispatches) {
                if (&dispatch != dispatches.data()) ctx.barrier();
                const Page& page = pages[dispatch.page];
                const gpu::GatherParams params{dispatch.rowFirst,
                                               dispatch.rowCount,
                                               page.page.recordFirst,
                                               page.page.momentFirst,
                                               patchCount,
                                               stride,
                                               scale,
                                               0,
                                               weight};
                std::vector<Binding> bindings{texels(gpu::kGatherRows, rows, kWords2),
                                              texels(gpu::kGatherStrips, strips, kWords4),
                                              texels(gpu::kGatherLinks, page.records, kWords4),
                                              texels(gpu::kGatherMoments, page.moments, kWords2),
                                              texels(gpu::kGatherSenders, from, kWords4),
                                              texels(gpu::kGatherParents, out.irradiance, kVectors),
                                              storage(gpu::kGatherIrradiance, out.irradiance)};
                std::vector<SpecConstant> constants{{1, factorBits}};
                const bool last = updating && dispatch.level == lastLevel; // the patches
                if (last) {
                    bindings.push_back(texels(gpu::kGatherReflectance, reflectance, kVectors));
                    bindings.push_back(texels(gpu::kGatherB0, b0, kVectors));
                    bindings.push_back(texels(gpu::kGatherBefore, out.senders, kVectors));
                    bindings.push_back(storage(gpu::kGatherOut, out.senders));
                    if (weight != glm::vec4(1.0f)) constants.push_back({0, 1u});
                }
                ctx.dispatchBytes(last ? updates : plain, bindings, std::as_bytes(std::span(&params, 1)),
                                  groupsFor(dispatch.rowCount, gpu::kSolveGroup), constants);
            }
        });
        return out;
    });
}

} // namespace

LightRefs addFirstLight(FrameGraph& graph, const TileTables& tile, const DirectLight& direct, LightRefs light,
                        bool emission, bool warm)
{
    light = graph.addPass("first light", [&](PassBuilder& pass) {
        const auto reflectance = pass.read(pass.import(tile.reflectance), Use::ComputeRead);
        const auto emitted = pass.read(pass.import(tile.emission), Use::ComputeRead);
        const auto sun = pass.read(direct.sun, Use::ComputeRead);
        const auto sky = pass.read(direct.sky, Use::ComputeRead);
        const auto indirect = pass.read(light.irradiance, Use::ComputeRead);
        const LightRefs out{pass.write(light.b0, Use::ComputeWrite), pass.write(light.senders, Use::ComputeWrite),
                            light.irradiance};
        const gpu::FirstLightParams params{tile.patchCount, emission ? 1.0f : 0.0f, warm ? 1.0f : 0.0f, 0};
        const ShaderCode& shader = kFirstLight[tile.reads];
        pass.record([=, &shader, emits = tile.emits](PassContext& ctx) {
            ctx.dispatch(shader,
                         {texels(gpu::kFirstReflectance, reflectance, kVectors), texels(gpu::kFirstSun, sun, kVectors),
                          texels(gpu::kFirstSky, sky, kVectors), texels(gpu::kFirstIndirect, indirect, kVectors),
                          texels(gpu::kFirstEmission, emitted, kVectors), storage(gpu::kFirstB0, out.b0),
                          storage(gpu::kFirstSenders, out.senders)},
                         params, groupsFor(params.patchCount, gpu::kSolveGroup), {{0, emits}});
        });
        return out;
    });
    light.senders = addPullSenders(graph, tile, light.senders);
    return light;
}

Ref<Buffer> addPull(FrameGraph& graph, const TileTables& tile, Ref<Buffer> values, const std::string& name)
{
    return addPull(graph, tile, values, name, 1);
}

Ref<Buffer> addPullSenders(FrameGraph& graph, const TileTables& tile, Ref<Buffer> senders)
{
    return addPull(graph, tile, senders, "pull", tile.links.stride);
}

Ref<Buffer> addGather(FrameGraph& graph, const LinkBuffers& links, Ref<Buffer> senders, Ref<Buffer> irradiance,
                      const GatherOptions& options)
{
    return addRows(graph, links, senders, irradiance, options, {}).irradiance;
}

LightRefs addGather(FrameGraph& graph, const TileTables& tile, LightRefs light)
{
    light.irradiance = addGather(graph, tile.links, light.senders, light.irradiance, {.reads = tile.reads});
    return light;
}

u32 residualParts(const TileTables& tile)
{
    constexpr u32 kPatches = gpu::kSolveGroup * gpu::kResidualRun;
    return (tile.patchCount + kPatches - 1) / kPatches * gpu::kSolveGroup;
}

SweepResult addSweep(FrameGraph& graph, const TileTables& tile, LightRefs light, SweepTargets to, glm::vec4 weight)
{
    const Ref<Buffer> before = light.senders;
    const GatherRefs rows = addRows(graph, tile.links, light.senders, light.irradiance, {.reads = tile.reads},
                                    Update{tile.reflectance, light.b0, to.senders, weight});
    light.irradiance = rows.irradiance;
    light.senders = addPullSenders(graph, tile, rows.senders);
    const u32 partCount = residualParts(tile);
    to.parts = graph.addPass("residual parts", [&](PassBuilder& pass) {
        const auto reflectance = pass.read(pass.import(tile.reflectance), Use::ComputeRead);
        const auto planes = pass.read(pass.import(tile.planes), Use::ComputeRead);
        const auto b0 = pass.read(light.b0, Use::ComputeRead);
        const auto irradiance = pass.read(light.irradiance, Use::ComputeRead);
        const auto from = pass.read(before, Use::ComputeRead);
        const auto out = pass.write(to.parts, Use::ComputeWrite);
        const ShaderCode& shader = kResidualParts[tile.reads];
        pass.record([=, &shader, params = gpu::CountParams{tile.patchCount}](PassContext& ctx) {
            ctx.dispatch(shader,
                         {texels(gpu::kPartsReflectance, reflectance, kVectors), texels(gpu::kPartsB0, b0, kVectors),
                          texels(gpu::kPartsIrradiance, irradiance, kVectors),
                          texels(gpu::kPartsSenders, from, kVectors), texels(gpu::kPartsPlanes, planes, kVectors),
                          storage(gpu::kPartsOut, out)},
                         params, groupsFor(partCount, gpu::kSolveGroup));
        });
        return out;
    });
    to.residual = graph.addPass("residual", [&](PassBuilder& pass) {
        const auto from = pass.read(to.parts, Use::ComputeRead);
        const auto out = pass.write(to.residual, Use::ComputeWrite);
        const ShaderCode& shader = kResidual[tile.reads];
        pass.record([=, &shader, params = gpu::CountParams{partCount}](PassContext& ctx) {
            ctx.dispatch(shader, {texels(gpu::kResidualParts, from, kVectors), storage(gpu::kResidualResult, out)},
                         params, Groups{});
        });
        return out;
    });
    to.senders = before;
    return {light, to};
}

namespace {

/// Sums that are not finite come from light beyond the range of a float: such a solve never counts as converged.
bool isFinite(const gpu::ResidualRecord& sums)
{
    bool finite = true;
    for (int c = 0; c < 4; ++c) finite = finite && std::isfinite(sums.change[c]) && std::isfinite(sums.scale[c]);
    return finite;
}

} // namespace

double residualOf(const gpu::ResidualRecord& sums)
{
    double worst = 0.0;
    if (!isFinite(sums)) return std::numeric_limits<double>::infinity();
    for (int c = 0; c < 4; ++c)
        if (sums.change[c] > 0.0f && sums.scale[c] > 0.0f)
            worst = std::max(worst, std::sqrt(double(sums.change[c]) / double(sums.scale[c])));
    return worst;
}

double remainingErrorOf(const gpu::ResidualRecord& before, const gpu::ResidualRecord& sums, const glm::dvec4& radius)
{
    constexpr double kSlowest = 0.9999;
    double worst = 0.0;
    if (!isFinite(sums)) return std::numeric_limits<double>::infinity();
    for (int c = 0; c < 4; ++c) {
        if (!(sums.change[c] > 0.0f && sums.scale[c] > 0.0f)) continue;
        const double residual = std::sqrt(double(sums.change[c]) / double(sums.scale[c]));
        double q = radius[c];
        if (!(q > 0.0))
            q = before.change[c] > 0.0f ? std::sqrt(double(sums.change[c]) / double(before.change[c])) : 1.0;
        worst = std::max(worst, residual * q / (1.0 - std::min(q, kSlowest)));
    }
    return worst;
}

glm::dvec4 errorBoundOf(const gpu::ResidualRecord& sums, const glm::dvec4& contraction)
{
    glm::dvec4 bound(std::numeric_limits<double>::infinity());
    if (!isFinite(sums)) return bound;
    for (int c = 0; c < 4; ++c)
        if (contraction[c] < 1.0) bound[c] = double(sums.largest[c]) / (1.0 - contraction[c]);
    return bound;
}

} // namespace helio
