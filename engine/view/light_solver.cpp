// SPDX-License-Identifier: Apache-2.0
#include "engine/view/light_solver.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
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

constexpr const char* kRasterStage = "1 sun raster";
constexpr const char* kHistogramStage = "2 histogram";
constexpr const char* kSunStage = "2 sun energy";
constexpr const char* kSkyStage = "  sky energy";
constexpr const char* kGatherStage = "3 gather";
constexpr std::array kStageOrder{kRasterStage, kHistogramStage, kSunStage, kSkyStage, kGatherStage};

/// Sweeps of the power iteration that estimates the eigenvalues of a sweep, and the contraction number from which on it
/// is worth the while.
constexpr u32 kPowerSweeps = 8;
constexpr double kSlowContraction = 0.5;

template <class T> T readHost(const Buffer& host)
{
    host.invalidate();
    T value;
    std::memcpy(&value, host.mapped(), sizeof(T));
    return value;
}

} // namespace

std::string stageOf(const std::string& pass, const std::string& other)
{
    constexpr std::array<std::pair<const char*, const char*>, 3> kStages{
        {{"sun raster", kRasterStage}, {"histogram", kHistogramStage}, {"sun ", kSunStage}}};
    for (const auto& [prefix, stage] : kStages)
        if (pass.starts_with(prefix)) return stage;
    return other;
}

LightSolver::LightSolver(Context& context, const TileTables& tile, const RendererOptions& options)
    : context_(context), tile_(tile), options_(options), recorder_(context),
      counts_(makeBuffer(context, "counts", std::vector<u32>(tile.patchCount, 0))),
      density_(makeZeros(context, "sun density", tile.nodeCount)), sun_(makeZeros(context, "E_sun", tile.patchCount)),
      tally_(makeBuffer(context, "sun tally", std::vector<gpu::SunTallyRecord>(1))),
      sky_(makeZeros(context, "E_sky", tile.patchCount)), b0_(makeZeros(context, "B0", tile.patchCount)),
      irradiance_(makeZeros(context, "E_indirect", tile.nodeCount)),
      parts_(context, {"residual parts", u64(residualParts(tile)) * sizeof(gpu::ResidualRecord)}),
      residual_(context, {"residual", sizeof(gpu::ResidualRecord)}),
      senders_{makeZeros(context, "B", tile.senderCount()), makeZeros(context, "B, other", tile.senderCount())},
      residualHost_(context, {"residual on the host", sizeof(gpu::ResidualRecord), Memory::Readback}),
      tallyHost_(context, {"tally on the host", sizeof(gpu::SunTallyRecord), Memory::Readback})
{
    if (options_.histogram)
        histogram_ = *options_.histogram;
    else
        histogram_ = fasterHistogram(context);
    options_.sun.maxViewSize = std::min(options_.sun.maxViewSize, context.facts().maxImageDimension2D);
    options_.sun.maxViews = std::min(options_.sun.maxViews, context.facts().maxImageArrayLayers);
    if (tile.contraction.largest() >= kSlowContraction) estimateSpectrum();
}

void LightSolver::execute(FrameGraph& graph, bool timed)
{
    const Status compiled = graph.compile(context_);
    HELIO_CHECK(compiled.ok(), compiled.ok() ? "" : compiled.error().message, "\n", graph.dump());
    if (options_.onGraph) options_.onGraph(graph.dump());
    recorder_.begin();
    graph.execute(recorder_, timed);
    recorder_.submitAndWait();
}

void LightSolver::estimateSpectrum()
{
    const auto radiosities = [&] {
        return asItems<glm::vec4>(download(context_, radiosity(), 0, u64(tile_.patchCount) * sizeof(glm::vec4)));
    };
    // B0 is zero as yet: a sweep is B = rho F B, and B starts as 1 everywhere.
    upload(context_, radiosity(), std::vector<glm::vec4>(tile_.patchCount, glm::vec4(1.0f)));
    std::vector<glm::vec4> before;
    for (u32 k = 0; k < kPowerSweeps; ++k) {
        FrameGraph graph("power iteration");
        LightRefs light = lightIn(graph);
        if (k == 0) light.senders = addPullSenders(graph, tile_, light.senders);
        if (k + 1 == kPowerSweeps) before = radiosities();
        (void)addSweepTo(graph, light);
        execute(graph, false);
    }
    spectrum_ = spectralBounds(downloadItems<glm::vec4>(context_, tile_.reflectance),
                               downloadItems<glm::vec4>(context_, tile_.planes), before, radiosities());
    radius_ = chebyshevRadius(spectrum_, tile_.contraction.number);
}

void LightSolver::run(FrameGraph& graph, const char* other)
{
    execute(graph, true);
    for (const PassTime& time : recorder_.times()) {
        const std::string stage = stageOf(time.name, other);
        // In the order of the stages, whichever pass came first.
        const auto rank = [](const std::string& name) {
            return std::find(kStageOrder.begin(), kStageOrder.end(), name) - kStageOrder.begin();
        };
        const auto place = std::find_if(report_.stages.begin(), report_.stages.end(),
                                        [&](const PassTime& t) { return rank(t.name) >= rank(stage); });
        if (place != report_.stages.end() && place->name == stage)
            place->milliseconds += time.milliseconds;
        else
            report_.stages.insert(place, {stage, time.milliseconds});
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
    fittedView_ = light.sunUp() && !boxes.empty() ? fitSunView(boxes, light.towardsSun, options_.sun) : SunView{};
    report_.sunSamples = 0;
    sampleSun(light);
}

void LightSolver::sampleSun(const LightState& light)
{
    const bool raster = light.sunUp() && !tile_.chunks.empty();
    sunView_ = shiftedView(fittedView_, report_.sunSamples);
    fitImages();

    FrameGraph graph("sun");
    SunPictures pictures{graph.import(*ids_), graph.import(*shadow_)};
    Ref<Buffer> counts = graph.import(counts_);
    if (report_.sunSamples == 0) counts = addFill(graph, counts, 0);
    std::vector<FacingLists> lists;
    lists.reserve(sunView_.viewCount());
    for (u32 view = 0; view < sunView_.viewCount(); ++view) {
        FacingDraws draws;
        if (raster) draws = facingDraws(tile_.chunks, sunView_.clipFromWorld(view), glm::vec4(light.towardsSun, 0.0));
        lists.emplace_back(context_, std::move(draws));
        pictures = addSunRaster(graph, tile_, lists.back(), sunView_, view, pictures);
        counts =
            addHistogram(graph, pictures.ids, counts, sunView_.width, sunView_.height, tile_.patchCount, histogram_);
    }
    ++report_.sunSamples;
    const SunEnergyInput input{glm::vec3(light.towardsSun), glm::vec4(raster ? float(light.dni) : 0.0f),
                               sunView_.texelArea() / report_.sunSamples, float(light.sunRadius)};
    const SunEnergyRefs energy =
        addSunEnergy(graph, tile_, counts, graph.import(density_), {graph.import(sun_), graph.import(tally_)}, input);
    addReadback(graph, energy.tally, tallyHost_);
    run(graph, kSunStage);

    const auto tally = readHost<gpu::SunTallyRecord>(tallyHost_);
    report_.litPatches = tally.lit;
    report_.flaggedPatches = tally.flagged;
    report_.excessPatches = tally.excess;
    report_.sunTexel = sunView_.texel;
    report_.sunViews = raster ? sunView_.viewCount() : 0;
    report_.sunWidth = sunView_.width;
    report_.sunHeight = sunView_.height;
}

void LightSolver::solveSky(const LightState& light)
{
    const Buffer senders =
        makeBuffer(context_, "sky radiance", skySenders(tile_, outsideRadiance(tile_.skyPatches, light)));
    FrameGraph graph("sky");
    (void)addSkyEnergy(graph, tile_, graph.import(senders), graph.import(sky_));
    run(graph, kSkyStage);
}

void LightSolver::takeGiven(const FirstLight& light)
{
    sunView_ = fittedView_ = SunView{};
    fitImages(); // pictures bind them, whatever they hold
    upload(context_, sun_, light.sun);
    upload(context_, sky_, light.sky);
    report_.litPatches = report_.flaggedPatches = report_.excessPatches = 0;
    report_.sunTexel = 0.0;
    report_.sunViews = report_.sunWidth = report_.sunHeight = 0;
}

LightRefs LightSolver::lightIn(FrameGraph& graph) const
{
    return {graph.import(b0_), graph.import(senders_[current_]), graph.import(irradiance_)};
}

SweepResult LightSolver::addSweepTo(FrameGraph& graph, LightRefs light, glm::vec4 weight)
{
    current_ = 1 - current_;
    return addSweep(graph, tile_, light,
                    {graph.import(senders_[current_]), graph.import(parts_), graph.import(residual_)}, weight);
}

void LightSolver::firstLight(const LightState& light, bool warm)
{
    FrameGraph graph("first light");
    (void)addFirstLight(graph, tile_, {graph.import(sun_), graph.import(sky_)}, lightIn(graph), light.emission, warm);
    run(graph, kGatherStage);
}

void LightSolver::sweep(const LightState& light, bool warm)
{
    firstLight(light, warm);
    const SolveOptions& to = options_.solve;
    const u32 limit = std::max(to.exactSweeps > 0 ? to.exactSweeps : to.maxSweeps, 1u);
    // A number of sweeps asked for is a number of reflections.
    const glm::dvec4 radius = to.exactSweeps > 0 ? glm::dvec4(0.0) : radius_;
    report_.accelerated = radius != glm::dvec4(0.0);
    report_.contraction = tile_.contraction.number;
    glm::dvec4 weight(1.0);
    gpu::ResidualRecord before{};
    for (report_.sweeps = 0; report_.sweeps < limit;) {
        FrameGraph graph("sweep");
        weight = chebyshevWeight(report_.sweeps, weight, radius);
        const SweepResult result = addSweepTo(graph, lightIn(graph), glm::vec4(weight));
        addReadback(graph, result.spent.residual, residualHost_);
        run(graph, kGatherStage);
        ++report_.sweeps;
        const auto sums = readHost<gpu::ResidualRecord>(residualHost_);
        report_.residual = residualOf(sums);
        report_.bound = errorBoundOf(sums, tile_.contraction.number);
        report_.meanRadiosity = glm::dvec4(sums.radiosity);
        // The residual is the defect of one step; where light is reflected many times the steps still to come add up.
        const double error = remainingErrorOf(before, sums, radius);
        if (to.exactSweeps == 0 && report_.residual <= to.residual && error <= kErrorShare * to.residual) break;
        before = sums;
    }
    report_.meanRadiosity /= tile_.patchArea;
    // The last B leans away from the one before; the result is what E_indirect makes, as after a plain sweep.
    if (report_.accelerated) firstLight(light, true);
}

const SolveReport& LightSolver::solve(const LightState& light)
{
    if (solved_ && *solved_ == light && solvedWith_ == options_.solve) {
        report_.cached = true;
        return report_;
    }
    report_.cached = false;
    ++solveCount_;
    report_.stages.clear();
    if (light.given) {
        if (!solved_ || solved_->given != light.given) takeGiven(*light.given);
    } else {
        const bool fresh = !solved_ || solved_->given;
        const bool sunMoved = fresh || solved_->towardsSun != light.towardsSun || solved_->dni != light.dni ||
                              solved_->sunRadius != light.sunRadius;
        if (sunMoved) solveSun(light);
        const bool sunOutside = sunMoved && skyCellCount(tile_.skyPatches) < tile_.skyPatches.size();
        if (fresh || solved_->dhi != light.dhi || solved_->skyRadiance != light.skyRadiance || sunOutside)
            solveSky(light);
    }
    // Without light the solution is 0, which no residual relative to itself leads to.
    const bool dark = !light.given && !light.sunUp() && light.dhi <= 0.0 && !(light.emission && tile_.emits);
    sweep(light, solved_.has_value() && options_.solve.warmStart && !dark);
    solved_ = light;
    solvedWith_ = options_.solve;
    return report_;
}

const SolveReport& LightSolver::refineSun(const LightState& light)
{
    solve(light);
    if (light.given || !light.sunUp()) return report_;
    report_.cached = false;
    ++solveCount_;
    report_.stages.clear();
    sampleSun(light);
    sweep(light, true);
    return report_;
}

} // namespace helio
