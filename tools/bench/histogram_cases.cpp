// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/histogram_cases.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>

#include "bench_shaders/embedded.h"
#include "city/base/parallel.h"
#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "engine/stages/histogram.h"
#include "shaders/shared/sun.h"
#include "tools/bench/raster_cases.h"

namespace helio {

namespace {

constexpr u32 kSize = 4096, kTriangles = 1400000; // about 100,000 patches

struct Picture
{
    std::shared_ptr<SunScene> scene;
    u32 width = 0, height = 0, patchCount = 0;
    std::vector<u32> ids, counts;
    Buffer device;
};

/// The city as the sun raster shows it.
std::shared_ptr<Picture> makePicture(Context& context)
{
    auto picture = std::make_shared<Picture>();
    picture->scene = makeSunScene(context, BoxCity(kTriangles), kSize);
    SunScene& scene = *picture->scene;
    FrameGraph graph("picture");
    (void)addSunRaster(graph, scene.tile, scene.facing, scene.sun, 0,
                       {graph.import(scene.ids), graph.import(scene.depth)});
    Recorder recorder(context);
    runGraph(context, recorder, graph);
    picture->width = scene.sun.width;
    picture->height = scene.sun.height;
    picture->patchCount = scene.tile.patchCount;
    picture->ids = downloadTexels<u32>(context, scene.ids);
    picture->counts.assign(picture->patchCount, 0);
    for (const u32 id : picture->ids)
        if (id != kNoIndex) ++picture->counts[id];
    picture->device = makeBuffer(context, "counts", std::vector<u32>(picture->patchCount));
    std::printf("histogram: %u x %u texels, %u patches\n", picture->width, picture->height, picture->patchCount);
    return picture;
}

/// A pass of the benchmark's own over the picture.
void addOwn(FrameGraph& graph, const Picture& picture, const ShaderCode& shader, u32 groupWidth, u32 groupHeight)
{
    const Ref<Buffer> zero = addFill(graph, graph.import(picture.device), 0);
    graph.addPass("histogram", [&](PassBuilder& pass) {
        const auto ids = pass.read(pass.import(picture.scene->ids), Use::ComputeRead);
        const auto counts = pass.write(zero, Use::ComputeReadWrite);
        pass.record([=, &shader, params = gpu::HistogramParams{picture.width, picture.height, picture.patchCount}](
                        PassContext& ctx) {
            ctx.dispatch(shader, {storage(gpu::kHistogramIds, ids), storage(gpu::kHistogramCounts, counts)}, params,
                         groupsFor2D(params.width, params.height, groupWidth, groupHeight));
        });
    });
}

/// Runs counted along the rows, by two threads.
void countOnHost(const Picture& picture, std::vector<std::atomic<u32>>& counts)
{
    for (std::atomic<u32>& count : counts) count.store(0, std::memory_order_relaxed);
    parallelFor(picture.height, 64, 2, [&](u32 begin, u32 end) {
        const u32* at = picture.ids.data() + size_t(begin) * picture.width;
        const u32* const last = picture.ids.data() + size_t(end) * picture.width;
        while (at < last) {
            const u32* const first = at;
            while (at < last && *at == *first) ++at;
            if (*first < picture.patchCount) counts[*first].fetch_add(u32(at - first), std::memory_order_relaxed);
        }
    });
}

} // namespace

void addHistogramCases(CaseList& cases)
{
    const std::array names{"histogram, reads alone", "histogram, an atomic a texel", "histogram, columns",
                           "histogram, subgroups", "histogram, host"};
    if (std::none_of(names.begin(), names.end(), [&](const char* name) { return cases.wants(name); })) return;
    Context& context = cases.context();
    Picture& picture = cases.keep(makePicture(context));
    const double bytes = double(picture.ids.size()) * sizeof(u32);
    const auto checked = [&](const char* name, const std::function<void(FrameGraph&)>& build) {
        FrameGraph graph("check");
        build(graph);
        Recorder recorder(context);
        runGraph(context, recorder, graph);
        HELIO_CHECK(downloadItems<u32>(context, picture.device) == picture.counts, name, " counts wrongly");
        cases.addGraph(name, build, "histogram", bytes);
    };
    cases.addGraph(
        "histogram, reads alone",
        [&](FrameGraph& graph) {
            addOwn(graph, picture, bench_shaders::kReadIdsComp, gpu::kHistogramGroup, gpu::kHistogramRun);
        },
        "histogram", bytes);
    checked("histogram, an atomic a texel",
            [&](FrameGraph& graph) { addOwn(graph, picture, bench_shaders::kHistogramAtomicComp, 256, 1); });
    const auto engine = [&](HistogramVariant variant) {
        return [&picture, variant](FrameGraph& graph) {
            const Ref<Buffer> zero = addFill(graph, graph.import(picture.device), 0);
            (void)addHistogram(graph, graph.import(picture.scene->ids), zero, picture.width, picture.height,
                               picture.patchCount, variant);
        };
    };
    checked("histogram, columns", engine(HistogramVariant::Columns));
    checked("histogram, subgroups", engine(HistogramVariant::Subgroups));
    auto& counts = cases.keep(std::make_shared<std::vector<std::atomic<u32>>>(picture.patchCount));
    cases.addWall("histogram, host", [&](CaseList::Figures&) { countOnHost(picture, counts); });
    cases.addRatio({"histogram: columns over an atomic a texel", "histogram, an atomic a texel", "histogram, columns"});
    cases.addRatio({"histogram: reading alone over columns", "histogram, columns", "histogram, reads alone"});
    cases.addRatio({"histogram: columns over subgroups", "histogram, subgroups", "histogram, columns"});
    cases.addRatio({"histogram: host over columns", "histogram, columns", "histogram, host"});
}

} // namespace helio
