// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/cases.h"

#include <algorithm>
#include <functional>

#include "engine/graph/pass_context.h"
#include "engine/stream/link_packing.h"

namespace helio {

namespace {

/// Exact sweeps of one repetition of the case "sweep": enough to hide what a solve does once.
constexpr u32 kSweepsTimed = 16;

/// Runs a graph to its end; returns the milliseconds on the device, 0 without timestamps.
double runGraph(Context& context, Recorder& recorder, FrameGraph& graph)
{
    const Status compiled = graph.compile(context);
    HELIO_CHECK(compiled.ok(), compiled.ok() ? "" : compiled.error().message);
    recorder.begin();
    graph.execute(recorder, true);
    recorder.submitAndWait();
    double total = 0.0;
    for (const PassTime& pass : recorder.times()) total += pass.milliseconds;
    return total;
}

/// The cases, which share one renderer. Every case is run once before it is timed.
class Cases
{
public:
    Cases(Context& context, const Pack& pack, Renderer& renderer, const Camera& camera, const BenchOptions& o)
        : context_(context), pack_(pack), renderer_(renderer), camera_(camera), o_(o), recorder_(context),
          from_(context, {"copy source", u64(o.copyMiB) << 20}), to_(context, {"copy target", u64(o.copyMiB) << 20})
    {
        add("pack open", [this](benchmark::State&) { return openPack(); });
        add(
            "stream copy", [this](benchmark::State& state) { return streamCopy(state); }, true);
        add("sun change, cold", [this](benchmark::State& state) { return moveSun(state, 0.0, false); });
        add("sun change of 1 degree, warm", [this](benchmark::State& state) { return moveSun(state, 1.0, true); });
        add("one warm sweep", [this](benchmark::State&) { return sweeps(1); });
        add(
            "sweep, mean of 16", [this](benchmark::State& state) { return timeSweep(state); }, true);
        add("camera move", [this](benchmark::State& state) { return moveCamera(state); });
    }

private:
    /// The body returns its milliseconds by the device's timestamps, 0 without them; deviceTime: they are what is
    /// reported, else the wall time is.
    void add(const char* name, const std::function<double(benchmark::State&)>& body, bool deviceTime = false)
    {
        auto* added = benchmark::RegisterBenchmark(name,
                                                   [body, warmedUp = false](benchmark::State& state) mutable {
                                                       if (!std::exchange(warmedUp, true)) {
                                                           body(state);
                                                           state.counters.clear();
                                                       }
                                                       for ([[maybe_unused]] auto once : state)
                                                           state.SetIterationTime(body(state) / 1e3);
                                                   })
                          ->Unit(benchmark::kMillisecond)
                          ->Iterations(1)
                          ->Repetitions(int(o_.repeats));
        if (deviceTime)
            added->UseManualTime();
        else
            added->UseRealTime();
    }

    double openPack()
    {
        HELIO_CHECK(Pack::open(o_.pack).ok(), o_.pack);
        return 0.0;
    }

    /// To and fro, so that every repetition does the same work: by an angle, or in strength alone for a cold start,
    /// which does not care what came before.
    double moveSun(benchmark::State& state, double degrees, bool warm)
    {
        const double step = double(++moves_ % 2);
        renderer_.setSun(150.0 + degrees * step, 40.0, 800.0 + step);
        renderer_.solveOptions() = {.residual = o_.residual, .warmStart = warm};
        const SolveReport& report = renderer_.solve();
        double total = 0.0;
        for (const PassTime& stage : report.stages) {
            state.counters[stage.name] = stage.milliseconds;
            total += stage.milliseconds;
        }
        state.counters["sweeps"] = report.sweeps;
        return total;
    }

    /// Sun and sky stand: only first light and this many sweeps run. Returns the device's milliseconds.
    double sweeps(u32 count)
    {
        // A changed limit, without effect here, tells the solver to work although the light is the same.
        renderer_.solveOptions() = {.maxSweeps = 100 + ++solves_ % 2, .exactSweeps = count, .warmStart = true};
        double total = 0.0;
        for (const PassTime& stage : renderer_.solve().stages) total += stage.milliseconds;
        return total;
    }

    double timeSweep(benchmark::State& state)
    {
        const double milliseconds = sweeps(kSweepsTimed) / kSweepsTimed;
        if (milliseconds <= 0.0) return 0.0;
        const double speed = bytesOfSweep(pack_.tile()) / milliseconds / 1e6;
        state.counters["GB/s"] = speed;
        if (copySpeed_ > 0.0) state.counters["of the stream copy"] = speed / copySpeed_;
        return milliseconds;
    }

    double streamCopy(benchmark::State& state)
    {
        FrameGraph graph("copy");
        const Ref<Buffer> filled = addFill(graph, graph.import(from_), 1);
        const Ref<Buffer> target = graph.import(to_);
        graph.addPass("stream copy", [&](PassBuilder& pass) {
            pass.read(filled, Use::CopyFrom);
            const Ref<Buffer> out = pass.write(target, Use::CopyTo);
            pass.record([=](PassContext& ctx) { ctx.copy(filled, out); });
        });
        (void)runGraph(context_, recorder_, graph);
        double milliseconds = 0.0;
        for (const PassTime& pass : recorder_.times())
            if (pass.name == "stream copy") milliseconds = pass.milliseconds;
        if (milliseconds <= 0.0) return 0.0;
        const double speed = 2.0 * double(from_.bytes()) / milliseconds / 1e6;
        copySpeed_ = std::max(copySpeed_, speed);
        state.counters["GB/s"] = speed;
        return milliseconds;
    }

    double moveCamera(benchmark::State& state)
    {
        camera_.eye.x += 0.1;
        FrameGraph graph("frame");
        (void)renderer_.addFrame(graph, camera_, o_.width, o_.height, {});
        return state.counters["device"] = runGraph(context_, recorder_, graph);
    }

    Context& context_;
    const Pack& pack_;
    Renderer& renderer_;
    Camera camera_;
    const BenchOptions& o_;
    Recorder recorder_;
    Buffer from_, to_;
    double copySpeed_ = 0.0; ///< GB/s read and written, the best repetition
    u32 moves_ = 0, solves_ = 0;
};

} // namespace

double bytesOfSweep(const TileView& tile)
{
    const u64 nodes = tile.nodes.size(), patches = tile.patches.size(), inner = nodes - patches, light = 16;
    const LinkRows links{tile.linkRows, tile.linkColumns, tile.linkFactors, tile.linkMoments, u32(patches)};
    u64 records = 0;
    for (u32 row = 0; row < links.rowCount(); ++row) records += recordsOfRow(links, row).all;
    const u64 gather = records * 16 + (2 * nodes + 1) * 4 + 2 * nodes * light;
    const u64 push = nodes * 4 + inner * light + 2 * nodes * light;
    const u64 update = patches * (sizeof(gpu::PatchRecord) + 4 * light);
    const u64 pull = tile.children.size() * 8 + inner * 8 + nodes * light;
    // Linear senders: where a row's moments begin, slopes read by the gather and written by the pull.
    const u64 slopes = links.linear() ? nodes * 4 + 4 * inner * light + tile.childSlopes.size_bytes() : 0;
    return double(gather + push + update + pull + slopes);
}

void runCases(Context& context, const Pack& pack, Renderer& renderer, const Camera& camera, const BenchOptions& options,
              benchmark::BenchmarkReporter& reporter)
{
    const Cases cases(context, pack, renderer, camera, options);
    benchmark::RunSpecifiedBenchmarks(&reporter);
    benchmark::ClearRegisteredBenchmarks();
}

} // namespace helio
