// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/scene_cases.h"

#include <algorithm>

namespace helio {

namespace {

/// Exact sweeps of one repetition of the case "sweep": enough to hide what a solve does once.
constexpr u32 kSweepsTimed = 16;

/// What the cases share.
class Scene
{
public:
    Scene(Context& context, const Pack& pack, Renderer& renderer, const Camera& camera, const BenchOptions& o)
        : context_(context), pack_(pack), renderer_(renderer), camera_(camera), o_(o), recorder_(context)
    {
    }

    void openPack() const { HELIO_CHECK(Pack::open(o_.pack).ok(), o_.pack); }

    /// To and fro, so that every repetition does the same work: by an angle, or in strength alone for a cold start,
    /// which does not care what came before.
    void moveSun(CaseList::Figures& figures, double degrees, bool warm)
    {
        if (degrees > 0.0) azimuth_ = azimuth_ > 150.0 ? 150.0 : 150.0 + degrees;
        renderer_.setSun(azimuth_, 40.0, 800.0 + double(++moves_ % 2));
        renderer_.solveOptions() = {.residual = o_.residual, .warmStart = warm};
        const SolveReport& report = renderer_.solve();
        for (const PassTime& stage : report.stages) figures[stage.name] = stage.milliseconds;
        figures["sweeps"] = report.sweeps;
    }

    /// Sun and sky stand: only first light and this many sweeps run. Returns the device's milliseconds.
    double sweeps(u32 count)
    {
        // A changed limit, without effect here, tells the solver to work although the light is the same.
        renderer_.solveOptions() = {.maxSweeps = 100 + ++solves_ % 2, .exactSweeps = count, .warmStart = true};
        return totalTime(renderer_.solve().stages);
    }

    double timeSweep(CaseList::Figures& figures)
    {
        const double milliseconds = sweeps(kSweepsTimed) / kSweepsTimed;
        if (milliseconds > 0.0) figures["GB/s"] = bytesOfSweep(renderer_.tables()) / milliseconds / 1e6;
        return milliseconds;
    }

    void moveCamera(CaseList::Figures& figures)
    {
        camera_.eye.x += 0.1;
        FrameGraph graph("frame");
        (void)renderer_.addFrame(graph, camera_, o_.width, o_.height, {});
        runGraph(context_, recorder_, graph);
        for (const PassTime& pass : recorder_.times()) figures[pass.name] = pass.milliseconds;
    }

private:
    Context& context_;
    const Pack& pack_;
    Renderer& renderer_;
    Camera camera_;
    const BenchOptions& o_;
    Recorder recorder_;
    double azimuth_ = 150.0; ///< of the sun
    u32 moves_ = 0, solves_ = 0;
};

} // namespace

double bytesOfSweep(const TileTables& tile)
{
    const double nodes = tile.nodeCount, patches = tile.patchCount, inner = tile.innerCount(), light = 16.0;
    const double senders = double(tile.senderCount()) * light;
    const double gather = double(tile.links.bytes) + nodes * 8.0 + senders + 2.0 * nodes * light;
    const double update = patches * 3.0 * light;
    const double pull = nodes * 16.0 + inner * 4.0 + (tile.linear ? nodes * 16.0 : 0.0) + 2.0 * senders;
    return gather + update + pull;
}

void addSceneCases(CaseList& cases, const Pack& pack, Renderer& renderer, const Camera& camera)
{
    Scene& scene = cases.keep(std::make_shared<Scene>(cases.context(), pack, renderer, camera, cases.options()));
    cases.addWall("pack open", [&](CaseList::Figures&) { scene.openPack(); });
    cases.addWall("sun change, cold", [&](CaseList::Figures& f) { scene.moveSun(f, 0.0, false); });
    cases.addWall("sun change of 1 degree, warm", [&](CaseList::Figures& f) { scene.moveSun(f, 1.0, true); });
    cases.add("sweep, mean of 16", [&](CaseList::Figures& f) { return scene.timeSweep(f); });
    cases.addWall("camera move", [&](CaseList::Figures& f) { scene.moveCamera(f); });
}

} // namespace helio
