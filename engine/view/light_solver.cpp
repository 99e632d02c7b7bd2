// SPDX-License-Identifier: Apache-2.0
#include "engine/view/light_solver.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "engine/stages/gather.h"
#include "engine/stages/histogram.h"
#include "engine/stages/sky_energy.h"
#include "engine/stages/sun_energy.h"
#include "engine/stages/sun_raster.h"
#include "shaders/shared/sun.h"

namespace helio {

namespace {

Buffer makeZeros(Context& context, const char* name, u64 vectors)
{
    return makeBuffer(context, name, std::vector<glm::vec4>(vectors, glm::vec4(0.0f)));
}

/// Share of the tolerance that the estimated error may take: it is an estimate, in the mean over the patches.
constexpr double kErrorShare = 0.5;

/// The stage of the report that a pass belongs to.
const char* stageOf(const std::string& pass)
{
    constexpr std::array<std::pair<const char*, const char*>, 5> kStages{{{"sun raster", "1 sun raster"},
                                                                          {"histogram", "2 histogram"},
                                                                          {"sun ", "2 sun energy"},
                                                                          {"sky ", "  sky energy"},
                                                                          {"", "3 gather"}}};
    for (const auto& [prefix, stage] : kStages)
        if (pass.starts_with(prefix)) return stage;
    return "";
}

template <class T> T readHost(const Buffer& host)
{
    host.invalidate();
    T value;
    std::memcpy(&value, host.mapped(), sizeof(T));
    return value;
}

} // namespace

LightSolver::LightSolver(Context& context, const TileTables& tile, const RendererOptions& options)
    : context_(context), tile_(tile), options_(options), recorder_(context),
      counts_(makeBuffer(context, "counts", std::vector<u32>(tile.patchCount, 0))),
      density_(makeZeros(context, "sun density", tile.nodeCount)), sun_(makeZeros(context, "E_sun", tile.patchCount)),
      tally_(makeBuffer(context, "sun tally", std::vector<gpu::SunTallyRecord>(1))),
      sky_(makeZeros(context, "E_sky", tile.patchCount)), b0_(makeZeros(context, "B0", tile.patchCount)),
      radiosity_(makeZeros(context, "B", tile.nodeCount)),
      irradiance_(makeZeros(context, "E_indirect", tile.nodeCount)),
      partials_(context, {"residual parts", u64(updateGroups(tile)) * sizeof(gpu::ResidualRecord)}),
      residual_(context, {"residual", sizeof(gpu::ResidualRecord)}),
      residualHost_(context, {"residual on the host", sizeof(gpu::ResidualRecord), Memory::Readback}),
      tallyHost_(context, {"tally on the host", sizeof(gpu::SunTallyRecord), Memory::Readback})
{
    options_.sun.maxViewSize = std::min(options_.sun.maxViewSize, context.facts().maxImageDimension2D);
    options_.sun.maxViews = std::min(options_.sun.maxViews, context.facts().maxImageArrayLayers);
}

void LightSolver::run(FrameGraph& graph)
{
    const Status compiled = graph.compile(context_);
    HELIO_CHECK(compiled.ok(), compiled.ok() ? "" : compiled.error().message, "\n", graph.dump());
    recorder_.begin();
    graph.execute(recorder_, true);
    recorder_.submitAndWait();
    for (const PassTime& time : recorder_.times()) {
        const char* stage = stageOf(time.name);
        const auto found = std::find_if(report_.stages.begin(), report_.stages.end(),
                                        [&](const PassTime& t) { return t.name == stage; });
        if (found != report_.stages.end())
            found->milliseconds += time.milliseconds;
        else
            report_.stages.push_back({stage, time.milliseconds});
    }
}

void LightSolver::fitImages()
{
    const u32 layers = sunView_.viewCount();
    const auto fits = [&](const std::optional<Image>& image, u32 count) {
        return image && image->desc().width == sunView_.width && image->desc().height == sunView_.height &&
               image->desc().layers == count;
    };
    if (!fits(ids_, 1)) {
        ids_.reset();
        ids_.emplace(context_, ImageDesc{"sun ids", sunView_.width, sunView_.height, kIdFormat, 1,
                                         VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                             VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    }
    if (!fits(shadow_, layers)) {
        shadow_.reset();
        shadow_.emplace(context_, ImageDesc{"sun depth", sunView_.width, sunView_.height, kDepthFormat, layers,
                                            VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                                VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    }
}

void LightSolver::solveSun(const LightState& light)
{
    std::vector<Box> boxes;
    for (const DrawChunk& chunk : tile_.chunks) boxes.push_back(chunk.box);
    const bool raster = light.sunUp() && !boxes.empty();
    sunView_ = raster ? fitSunView(boxes, light.towardsSun, options_.sun) : SunView{};
    fitImages();

    FrameGraph graph("sun");
    SunPictures pictures{graph.import(*ids_), graph.import(*shadow_)};
    Ref<Buffer> counts = addFill(graph, graph.import(counts_), 0);
    std::vector<DrawList> lists;
    lists.reserve(sunView_.viewCount());
    for (u32 view = 0; view < sunView_.viewCount(); ++view) {
        lists.emplace_back(context_, raster ? visibleDraws(tile_.chunks, sunView_.clipFromWorld(view))
                                            : std::vector<gpu::DrawRecord>{});
        pictures = addSunRaster(graph, tile_, lists.back(), sunView_, view, pictures);
        counts = addHistogram(graph, pictures.ids, counts, sunView_.width, sunView_.height, tile_.patchCount,
                              {!options_.plainHistogram});
    }
    const SunEnergyInput input{glm::vec3(light.towardsSun), glm::vec4(raster ? float(light.dni) : 0.0f),
                               sunView_.texelArea(), float(light.sunRadius)};
    const SunEnergyRefs energy =
        addSunEnergy(graph, tile_, counts, graph.import(density_), {graph.import(sun_), graph.import(tally_)}, input);
    addReadback(graph, energy.tally, tallyHost_);
    run(graph);

    const auto tally = readHost<gpu::SunTallyRecord>(tallyHost_);
    report_.litPatches = tally.lit;
    report_.flaggedPatches = tally.flagged;
    report_.excessPatches = tally.excess;
    report_.sunTexelX = sunView_.texelX;
    report_.sunTexelY = sunView_.texelY;
    report_.sunViews = raster ? sunView_.viewCount() : 0;
    report_.sunWidth = sunView_.width;
    report_.sunHeight = sunView_.height;
}

void LightSolver::solveSky(const LightState& light)
{
    const Buffer radiance = makeBuffer(context_, "sky radiance", outsideRadiance(tile_.skyPatches, light));
    FrameGraph graph("sky");
    (void)addSkyEnergy(graph, tile_, graph.import(radiance), graph.import(sky_));
    run(graph);
}

void LightSolver::sweep(const LightState& light, bool warm)
{
    {
        FrameGraph graph("first light");
        (void)addFirstLight(graph, tile_, {graph.import(sun_), graph.import(sky_)},
                            {graph.import(b0_), graph.import(radiosity_), graph.import(irradiance_)}, light.emission,
                            warm);
        run(graph);
    }
    const SolveOptions& to = options_.solve;
    const u32 limit = std::max(to.exactSweeps > 0 ? to.exactSweeps : to.maxSweeps, 1u);
    gpu::ResidualRecord before{};
    for (report_.sweeps = 0; report_.sweeps < limit;) {
        FrameGraph graph("sweep");
        const UpdateRefs result =
            addSweep(graph, tile_, {graph.import(b0_), graph.import(radiosity_), graph.import(irradiance_)},
                     graph.import(partials_), graph.import(residual_));
        addReadback(graph, result.residual, residualHost_);
        run(graph);
        ++report_.sweeps;
        const auto sums = readHost<gpu::ResidualRecord>(residualHost_);
        report_.residual = residualOf(sums);
        report_.meanRadiosity = glm::dvec4(sums.radiosity);
        // The residual is the defect of one step; where light is reflected many times the steps still to come add up.
        const double error = remainingErrorOf(before, sums);
        if (to.exactSweeps == 0 && report_.residual <= to.residual && error <= kErrorShare * to.residual) break;
        before = sums;
    }
    report_.meanRadiosity /= tile_.patchArea;
}

const SolveReport& LightSolver::solve(const LightState& light)
{
    if (solved_ && *solved_ == light && solvedWith_ == options_.solve) {
        report_.cached = true;
        return report_;
    }
    report_.cached = false;
    report_.stages.clear();
    const bool sunMoved = !solved_ || solved_->towardsSun != light.towardsSun || solved_->dni != light.dni;
    if (sunMoved) solveSun(light);
    const bool sunOutside = sunMoved && skyCellCount(tile_.skyPatches) < tile_.skyPatches.size();
    if (!solved_ || solved_->dhi != light.dhi || solved_->skyRadiance != light.skyRadiance || sunOutside)
        solveSky(light);
    sweep(light, solved_.has_value() && options_.solve.warmStart);
    solved_ = light;
    solvedWith_ = options_.solve;
    return report_;
}

} // namespace helio
