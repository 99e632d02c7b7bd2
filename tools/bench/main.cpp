// SPDX-License-Identifier: Apache-2.0
// Times of the stages on one pack and one device. A report, never a gate: compare figures of one run only.
#include <algorithm>
#include <benchmark/benchmark.h>
#include <cstdio>
#include <filesystem>
#include <map>

#include "city/base/file.h"
#include "engine/view/renderer.h"
#include "tools/bench/cases.h"
#include "tools/bench/options.h"
#include "tools/support/complain.h"

namespace helio {
namespace {

/// What the figures of a report mean, beside milliseconds.
const char* unitOf(const std::string& figure)
{
    if (figure.ends_with("GB/s")) return "";
    return figure == "sweeps" || figure.ends_with("copy") ? "" : "ms";
}

/// Prints median, minimum and spread (largest - smallest) over the repetitions of each case and of its figures.
class Report : public benchmark::BenchmarkReporter
{
public:
    bool ReportContext(const Context&) override
    {
        std::printf("%-30s %12s %12s %12s\n", "", "median", "min", "spread");
        return true;
    }
    void ReportRuns(const std::vector<Run>& runs) override
    {
        std::map<std::string, std::vector<double>> figures;
        for (const Run& run : runs) {
            if (run.run_type != Run::RT_Iteration) continue;
            figures[""].push_back(run.GetAdjustedRealTime());
            for (const auto& [name, counter] : run.counters) figures[name].push_back(counter.value);
        }
        for (auto& [name, values] : figures) {
            std::sort(values.begin(), values.end());
            const size_t half = values.size() / 2;
            const double median = values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
            const std::string title = name.empty() ? runs.front().run_name.function_name : "    " + name;
            std::printf("%-30s %12.4g %12.4g %12.4g %s\n", title.c_str(), median, values.front(),
                        values.back() - values.front(), unitOf(name));
        }
    }
};

u64 trianglesOf(const TileView& tile)
{
    u64 count = 0;
    for (const gpu::DrawRecord& draw : tile.draws) count += u64(draw.indexCount) / 3 * draw.instanceCount;
    return count;
}

int runMain(int argc, char** argv)
{
    bool done = false;
    const Result<BenchOptions> parsed = parseCommandLine(argc, argv, done);
    if (!parsed) return complain(parsed.error().message, kBadInput);
    if (done) return kOk;
    const BenchOptions& o = *parsed;
    if (!o.json.empty())
        if (const Status free = checkFileTarget(o.json); !free) return complain(free.error().message, kBadInput);
    const Result<Pack> pack = Pack::open(o.pack);
    if (!pack) return complain(pack.error().message, kBadInput);
    const Result<Camera> camera = parseCamera(o.camera, *pack);
    if (!camera) return complain(camera.error().message, kBadInput);
    ContextOptions contextOptions;
    contextOptions.device = o.device;
    const Result<std::unique_ptr<Context>> context = Context::create(contextOptions);
    if (!context) return complain(context.error().message, kInternal);
    RendererOptions options;
    if (o.sunTexel > 0.0) options.sun.texel = o.sunTexel;
    const Result<std::unique_ptr<Renderer>> renderer = Renderer::create(**context, *pack, options);
    if (!renderer) return complain(concat(o.pack, ": ", renderer.error().message), kBadInput);

    const DeviceFacts& facts = (*context)->facts();
    const TileView& tile = pack->tile();
    for (const auto& [key, value] : std::initializer_list<std::pair<std::string, std::string>>{
             {"device", facts.name},
             {"driver", facts.driver},
             {"pack", o.pack},
             {"patches", std::to_string(tile.patches.size())},
             {"nodes", std::to_string(tile.nodes.size())},
             {"links", std::to_string(tile.linkColumns.size())},
             {"triangles", std::to_string(trianglesOf(tile))},
             {"residual", concat(o.residual)},
             {"bytes of a sweep", concat(u64(bytesOfSweep(tile)))}})
        benchmark::AddCustomContext(key, value);
    std::printf("%s, driver %s\n%s: %zu patches, %zu nodes, %zu links, %llu triangles; sweeps to residual %g\n"
                "A sweep moves %.4g MB if every array passes the memory once\n%u repetitions\n",
                facts.name.c_str(), facts.driver.c_str(), o.pack.c_str(), tile.patches.size(), tile.nodes.size(),
                tile.linkColumns.size(), static_cast<unsigned long long>(trianglesOf(tile)), o.residual,
                bytesOfSweep(tile) / 1e6, o.repeats);

    const std::string part = o.json + ".part", out = "--benchmark_out=" + part;
    std::vector<std::string> words{"heliopolis-bench"};
    if (!o.json.empty()) words.insert(words.end(), {out, "--benchmark_out_format=json"});
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    int count = int(pointers.size());
    benchmark::Initialize(&count, pointers.data());
    Report report;
    runCases(**context, *pack, **renderer, *camera, o, report);
    if (o.json.empty()) return kOk;
    std::error_code failure;
    std::filesystem::rename(part, o.json, failure);
    return failure ? complain(concat(o.json, ": cannot be written: ", failure.message()), kBadInput) : kOk;
}

} // namespace
} // namespace helio

int main(int argc, char** argv)
{
    try {
        return helio::runMain(argc, argv);
    } catch (const std::exception& error) {
        return helio::complain(helio::concat("internal error: ", error.what()), helio::kInternal);
    }
}
