// SPDX-License-Identifier: Apache-2.0
#include "engine/stages/gather.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/graph/pass_context.h"
#include "shaders/embedded.h"

namespace helio {

LightRefs addFirstLight(FrameGraph& graph, const TileTables& tile, const DirectLight& direct, LightRefs light,
                        bool emission, bool warm)
{
    light = graph.addPass("first light", [&](PassBuilder& pass) {
        const auto patches = pass.read(pass.import(tile.patches), Use::ComputeRead);
        const auto sun = pass.read(direct.sun, Use::ComputeRead);
        const auto sky = pass.read(direct.sky, Use::ComputeRead);
        const auto indirect = pass.read(light.irradiance, Use::ComputeRead);
        const LightRefs out{pass.write(light.b0, Use::ComputeWrite), pass.write(light.radiosity, Use::ComputeWrite),
                            light.irradiance, light.slopes};
        const gpu::FirstLightParams params{tile.patchCount, emission ? 1.0f : 0.0f, warm ? 1.0f : 0.0f, 0};
        pass.record([=](PassContext& ctx) {
            ctx.dispatch(shaders::kFirstLightComp,
                         {storage(gpu::kFirstPatches, patches), storage(gpu::kFirstSun, sun),
                          storage(gpu::kFirstSky, sky), storage(gpu::kFirstIndirect, indirect),
                          storage(gpu::kFirstB0, out.b0), storage(gpu::kFirstRadiosity, out.radiosity)},
                         params, groupsFor(params.patchCount, gpu::kSolveGroup));
        });
        return out;
    });
    return addPullLight(graph, tile, light);
}

Ref<Buffer> addPull(FrameGraph& graph, const TileTables& tile, Ref<Buffer> values, const std::string& name)
{
    return graph.addPass(name, [&](PassBuilder& pass) {
        const auto rows = pass.read(pass.import(tile.childRows), Use::ComputeRead);
        const auto children = pass.read(pass.import(tile.children), Use::ComputeRead);
        const auto out = pass.write(values, Use::ComputeReadWrite);
        pass.record([=, levels = tile.levels, patchCount = tile.patchCount](PassContext& ctx) {
            for (const TreeLevel& level : levels) {
                ctx.dispatch(shaders::kPullComp,
                             {storage(gpu::kPullRows, rows), storage(gpu::kPullChildren, children),
                              storage(gpu::kPullValues, out)},
                             gpu::LevelParams{level.first, level.count, patchCount},
                             groupsFor(level.count, gpu::kSolveGroup));
                ctx.barrier();
            }
        });
        return out;
    });
}

LightRefs addPullLight(FrameGraph& graph, const TileTables& tile, LightRefs light)
{
    if (!tile.linear) {
        light.radiosity = addPull(graph, tile, light.radiosity);
        return light;
    }
    return graph.addPass("pull", [&](PassBuilder& pass) {
        const auto rows = pass.read(pass.import(tile.childRows), Use::ComputeRead);
        const auto children = pass.read(pass.import(tile.children), Use::ComputeRead);
        const auto childSlopes = pass.read(pass.import(tile.childSlopes), Use::ComputeRead);
        LightRefs out = light;
        out.radiosity = pass.write(light.radiosity, Use::ComputeReadWrite);
        out.slopes = pass.write(light.slopes, Use::ComputeReadWrite);
        pass.record([=, levels = tile.levels, patchCount = tile.patchCount](PassContext& ctx) {
            for (const TreeLevel& level : levels) {
                ctx.dispatch(shaders::kPullLinearComp,
                             {storage(gpu::kPullRows, rows), storage(gpu::kPullChildren, children),
                              storage(gpu::kPullChildSlopes, childSlopes), storage(gpu::kPullValues, out.radiosity),
                              storage(gpu::kPullSlopes, out.slopes)},
                             gpu::LevelParams{level.first, level.count, patchCount},
                             groupsFor(level.count, gpu::kSolveGroup));
                ctx.barrier();
            }
        });
        return out;
    });
}

Ref<Buffer> addPush(FrameGraph& graph, const TileTables& tile, Ref<Buffer> values)
{
    return graph.addPass("push", [&](PassBuilder& pass) {
        const auto parents = pass.read(pass.import(tile.parents), Use::ComputeRead);
        const auto out = pass.write(values, Use::ComputeReadWrite);
        // Downwards; the patches are one level more, and the top level is in it for roots only: it does nothing there.
        std::vector<TreeLevel> levels(tile.levels.rbegin(), tile.levels.rend());
        levels.push_back({0, tile.patchCount});
        pass.record([=, patchCount = tile.patchCount](PassContext& ctx) {
            for (const TreeLevel& level : levels) {
                ctx.dispatch(shaders::kPushComp, {storage(gpu::kPushParents, parents), storage(gpu::kPushValues, out)},
                             gpu::LevelParams{level.first, level.count, patchCount},
                             groupsFor(level.count, gpu::kSolveGroup));
                ctx.barrier();
            }
        });
        return out;
    });
}

LightRefs addGather(FrameGraph& graph, const TileTables& tile, LightRefs light)
{
    return graph.addPass("gather", [&](PassBuilder& pass) {
        struct Page
        {
            Ref<Buffer> records;
            gpu::GatherParams params;
        };
        std::vector<Page> pages;
        for (const LinkPageBuffer& links : tile.links)
            pages.push_back({pass.read(pass.import(links.records), Use::ComputeRead),
                             {links.page.rowFirst, links.page.rowCount, links.page.recordFirst, tile.patchCount}});
        const auto order = pass.read(pass.import(tile.linkOrder), Use::ComputeRead);
        const auto rows = pass.read(pass.import(tile.linkRows), Use::ComputeRead);
        const auto from = pass.read(light.radiosity, Use::ComputeRead);
        LightRefs out = light;
        if (tile.linear) out.slopes = pass.read(light.slopes, Use::ComputeRead);
        out.irradiance = pass.write(light.irradiance, Use::ComputeWrite);
        const ShaderCode& shader =
            tile.linear ? (tile.texelLinks ? shaders::kGatherTexelLinearComp : shaders::kGatherLinearComp)
                        : (tile.texelLinks ? shaders::kGatherTexelComp : shaders::kGatherComp);
        pass.record([=, &shader, linear = tile.linear](PassContext& ctx) {
            for (const Page& page : pages) {
                std::vector<Binding> bindings{storage(gpu::kGatherOrder, order), storage(gpu::kGatherRows, rows),
                                              texels(gpu::kGatherLinks, page.records, VK_FORMAT_R32G32B32A32_UINT),
                                              texels(gpu::kGatherRadiosity, from, VK_FORMAT_R32G32B32A32_SFLOAT),
                                              storage(gpu::kGatherIrradiance, out.irradiance)};
                if (linear) bindings.push_back(texels(gpu::kGatherSlopes, out.slopes, VK_FORMAT_R32G32B32A32_SFLOAT));
                ctx.dispatchBytes(shader, bindings, std::as_bytes(std::span(&page.params, 1)),
                                  groupsFor(page.params.rowCount, gpu::kSolveGroup), {});
            }
        });
        return out;
    });
}

u32 updateGroups(const TileTables& tile)
{
    constexpr u32 kPatches = gpu::kSolveGroup * gpu::kUpdateRun;
    return (tile.patchCount + kPatches - 1) / kPatches;
}

UpdateRefs addSweep(FrameGraph& graph, const TileTables& tile, LightRefs light, Ref<Buffer> partials,
                    Ref<Buffer> residual, const std::optional<ChebyshevRefs>& chebyshev)
{
    light = addGather(graph, tile, light);
    light.irradiance = addPush(graph, tile, light.irradiance);
    const u32 partialCount = updateGroups(tile);
    const auto updated = graph.addPass("update", [&](PassBuilder& pass) {
        const auto patches = pass.read(pass.import(tile.patches), Use::ComputeRead);
        const auto b0 = pass.read(light.b0, Use::ComputeRead);
        const auto irradiance = pass.read(light.irradiance, Use::ComputeRead);
        const auto radiosity = pass.write(light.radiosity, Use::ComputeReadWrite);
        const auto sums = pass.write(partials, Use::ComputeWrite);
        const Ref<Buffer> before = chebyshev ? pass.write(chebyshev->before, Use::ComputeReadWrite) : Ref<Buffer>{};
        const gpu::UpdateParams params{chebyshev ? chebyshev->weight : glm::vec4(1.0f), tile.patchCount};
        pass.record([=, accelerated = chebyshev.has_value()](PassContext& ctx) {
            std::vector<Binding> bindings{storage(gpu::kUpdatePatches, patches), storage(gpu::kUpdateB0, b0),
                                          storage(gpu::kUpdateIrradiance, irradiance),
                                          storage(gpu::kUpdateRadiosity, radiosity),
                                          storage(gpu::kUpdatePartials, sums)};
            if (accelerated) bindings.push_back(storage(gpu::kUpdateBefore, before));
            ctx.dispatchBytes(accelerated ? shaders::kUpdateChebyshevComp : shaders::kUpdateComp, bindings,
                              std::as_bytes(std::span(&params, 1)),
                              groupsFor(u64(partialCount) * gpu::kSolveGroup, gpu::kSolveGroup), {});
        });
        return std::pair(radiosity, sums);
    });
    light.radiosity = updated.first;
    light = addPullLight(graph, tile, light);
    const auto result = graph.addPass("residual", [&](PassBuilder& pass) {
        const auto from = pass.read(updated.second, Use::ComputeRead);
        const auto to = pass.write(residual, Use::ComputeWrite);
        pass.record([=, params = gpu::ResidualParams{partialCount}](PassContext& ctx) {
            ctx.dispatch(shaders::kResidualComp,
                         {storage(gpu::kResidualPartials, from), storage(gpu::kResidualResult, to)}, params, Groups{});
        });
        return to;
    });
    return {light, result};
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
