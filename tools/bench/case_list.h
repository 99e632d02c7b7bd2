// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <benchmark/benchmark.h>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/gpu/recorder.h"
#include "engine/graph/frame_graph.h"
#include "tools/bench/options.h"

namespace helio {

/// How many times faster one case is than another, of their medians in one run.
struct Ratio
{
    std::string what; ///< "histogram: faster than one atomic a texel"
    std::string slower, faster;
};

/// The cases of a run, under Google Benchmark: each once untimed, then options.repeats times, all of them in random
/// order, so that a slow minute of the machine meets everybody.
class CaseList
{
public:
    using Figures = benchmark::UserCounters;
    /// Milliseconds that count. Further figures of the repetition go into the second argument.
    using Body = std::function<double(Figures&)>;

    CaseList(Context& context, const BenchOptions& options) : context_(context), options_(options) {}
    ~CaseList() { benchmark::ClearRegisteredBenchmarks(); }
    CaseList(const CaseList&) = delete;
    CaseList& operator=(const CaseList&) = delete;

    /// The body tells its milliseconds. Not added when --only asks for others.
    void add(const std::string& name, const Body& body);
    /// Wall time of the body.
    void addWall(const std::string& name, const std::function<void(Figures&)>& body);
    /// Time on the device of the passes of a graph whose names begin with `pass` (all: empty). bytes: moved by them;
    /// makes a figure GB/s. The graph is compiled once.
    void addGraph(const std::string& name, const std::function<void(FrameGraph&)>& build, const std::string& pass = {},
                  double bytes = 0.0);
    /// Keeps what the cases work on until the end of the run.
    template <class T> T& keep(const std::shared_ptr<T>& item)
    {
        kept_.push_back(item);
        return *item;
    }
    void addRatio(const Ratio& ratio) { ratios_.push_back(ratio); }
    const std::vector<Ratio>& ratios() const { return ratios_; }
    /// Would a case of this name be run?
    bool wants(const std::string& name) const;
    Context& context() const { return context_; }
    const BenchOptions& options() const { return options_; }

private:
    Context& context_;
    const BenchOptions& options_;
    std::vector<std::shared_ptr<void>> kept_;
    std::vector<Ratio> ratios_;
};

/// Compiles and runs a graph to its end.
void runGraph(Context& context, Recorder& recorder, FrameGraph& graph);
/// Milliseconds on the device of the passes whose names begin with `pass`; 0 without timestamps.
double deviceTime(Recorder& recorder, const std::string& pass = {});

} // namespace helio
