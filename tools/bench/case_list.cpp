// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/case_list.h"

#include <chrono>

namespace helio {

bool CaseList::wants(const std::string& name) const
{
    return options_.only.empty() || name.find(options_.only) != std::string::npos;
}

void CaseList::add(const std::string& name, const Body& body)
{
    if (!wants(name)) return;
    benchmark::RegisterBenchmark(name.c_str(),
                                 [body, warmedUp = false](benchmark::State& state) mutable {
                                     Figures ignored;
                                     if (!std::exchange(warmedUp, true)) (void)body(ignored);
                                     for ([[maybe_unused]] auto once : state)
                                         state.SetIterationTime(body(state.counters) / 1e3);
                                 })
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1)
        ->Repetitions(int(options_.repeats))
        ->UseManualTime();
}

void CaseList::addWall(const std::string& name, const std::function<void(Figures&)>& body)
{
    add(name, [body](Figures& figures) {
        const auto start = std::chrono::steady_clock::now();
        body(figures);
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    });
}

void CaseList::addGraph(const std::string& name, const std::function<void(FrameGraph&)>& build, const std::string& pass,
                        double bytes)
{
    if (!wants(name)) return;
    struct Run
    {
        explicit Run(Context& context) : recorder(context) {}
        FrameGraph graph{"case"};
        Recorder recorder;
    };
    auto run = std::make_shared<Run>(context_);
    build(run->graph);
    const Status compiled = run->graph.compile(context_);
    HELIO_CHECK(compiled.ok(), name, ": ", compiled.ok() ? "" : compiled.error().message);
    add(name, [run, pass, bytes](Figures& figures) {
        run->recorder.begin();
        run->graph.execute(run->recorder, true);
        run->recorder.submitAndWait();
        const double milliseconds = deviceTime(run->recorder, pass);
        if (bytes > 0.0 && milliseconds > 0.0) figures["GB/s"] = bytes / milliseconds / 1e6;
        return milliseconds;
    });
}

void runGraph(Context& context, Recorder& recorder, FrameGraph& graph)
{
    const Status compiled = graph.compile(context);
    HELIO_CHECK(compiled.ok(), compiled.ok() ? "" : compiled.error().message);
    recorder.begin();
    graph.execute(recorder, true);
    recorder.submitAndWait();
}

double deviceTime(Recorder& recorder, const std::string& pass)
{
    double total = 0.0;
    for (const PassTime& time : recorder.times())
        if (time.name.starts_with(pass)) total += time.milliseconds;
    return total;
}

} // namespace helio
