// SPDX-License-Identifier: Apache-2.0
// Times of the kernels and of the stages on one device. A report, never a gate: compare figures of one run only.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "city/base/file.h"
#include "engine/view/renderer.h"
#include "tools/bench/commit.h"
#include "tools/bench/compare.h"
#include "tools/bench/gather_cases.h"
#include "tools/bench/histogram_cases.h"
#include "tools/bench/options.h"
#include "tools/bench/raster_cases.h"
#include "tools/bench/report.h"
#include "tools/bench/scene_cases.h"
#include "tools/support/complain.h"

namespace helio {
namespace {

/// Into the report's head and the JSON.
void tell(const char* key, const std::string& value)
{
    std::printf("%s: %s\n", key, value.c_str());
    benchmark::AddCustomContext(key, value);
}

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
    if (!o.compare.empty()) {
        const Result<std::string> table = compareRuns(o.compare[0], o.compare[1]);
        if (!table) return complain(table.error().message, kBadInput);
        std::printf("%s", table->c_str());
        return kOk;
    }
    std::optional<Pack> pack;
    Camera camera;
    if (!o.pack.empty()) {
        Result<Pack> opened = Pack::open(o.pack);
        if (!opened) return complain(opened.error().message, kBadInput);
        const Result<Camera> parsedCamera = parseCamera(o.camera, *opened);
        if (!parsedCamera) return complain(parsedCamera.error().message, kBadInput);
        pack = std::move(*opened);
        camera = *parsedCamera;
    }
    ContextOptions contextOptions;
    contextOptions.device = o.device;
    const Result<std::unique_ptr<Context>> context = Context::create(contextOptions);
    if (!context) return complain(context.error().message, kInternal);
    const DeviceFacts& facts = (*context)->facts();
    tell("device", facts.name);
    tell("driver", facts.driver);
    tell("commit", kCommit);
    std::unique_ptr<Renderer> renderer;
    if (pack) {
        RendererOptions options;
        if (o.sunTexel > 0.0) options.sun.texel = o.sunTexel;
        Result<std::unique_ptr<Renderer>> made = Renderer::create(**context, *pack, options);
        if (!made) return complain(concat(o.pack, ": ", made.error().message), kBadInput);
        renderer = std::move(*made);
        const TileTables& tile = renderer->tables();
        tell("pack", o.pack);
        tell("patches", concat(tile.patchCount));
        tell("nodes", concat(tile.nodeCount));
        tell("links", concat(tile.links.linkCount));
        tell("bytes a link", concat(double(tile.links.bytes) / double(std::max<u64>(tile.links.linkCount, 1))));
        tell("links in full precision", concat(tile.links.singles));
        tell("triangles", concat(trianglesOf(pack->tile())));
        tell("residual", concat(o.residual));
        tell("bytes of a sweep", concat(u64(bytesOfSweep(tile))));
    }

    const std::string part = o.json + ".part", out = "--benchmark_out=" + part;
    std::vector<std::string> words{"heliopolis-bench", "--benchmark_enable_random_interleaving=true"};
    if (!o.json.empty()) words.insert(words.end(), {out, "--benchmark_out_format=json"});
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    int count = int(pointers.size());
    benchmark::Initialize(&count, pointers.data());
    CaseList cases(**context, o);
    if (renderer)
        addSceneCases(cases, *pack, *renderer, camera);
    else {
        addHistogramCases(cases);
        addGatherCases(cases);
        addRasterCases(cases);
    }
    Report report(cases.ratios());
    if (benchmark::RunSpecifiedBenchmarks(&report) == 0)
        return complain(concat("no case has '", o.only, "' in its name"), kBadInput);
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
