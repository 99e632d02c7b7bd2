// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/histogram_cases.h"

#include <atomic>

#include "bench_shaders/embedded.h"
#include "city/base/hash.h"
#include "city/base/parallel.h"
#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "engine/stages/histogram.h"
#include "shaders/shared/sun.h"

namespace helio {

namespace {

constexpr u32 kSize = 4096, kPatches = 100000;
constexpr u32 kCells = 447; // along a side; half of the cells are background, as about a city

struct Picture
{
    std::vector<u32> ids, counts;
    Image image;
    Buffer device;
};

/// Rectangles of about 9 x 9 texels with borders that shift from row to row, as facades seen from the sun.
std::shared_ptr<Picture> makePicture(Context& context)
{
    auto picture = std::make_shared<Picture>();
    picture->ids.resize(size_t(kSize) * kSize);
    picture->counts.assign(kPatches, 0);
    Random random(5);
    std::vector<u32> patchOf(kCells * kCells, kNoIndex);
    // Background in blocks of eight by eight cells.
    u32 next = 0;
    std::vector<bool> city((kCells / 8 + 1) * (kCells / 8 + 1));
    for (size_t k = 0; k < city.size(); ++k) city[k] = random.uniform() < 0.501;
    for (u32 y = 0; y < kCells; ++y)
        for (u32 x = 0; x < kCells; ++x)
            if (city[y / 8 * (kCells / 8 + 1) + x / 8] && next < kPatches) patchOf[y * kCells + x] = next++;
    for (u32 y = 0; y < kSize; ++y)
        for (u32 x = 0; x < kSize; ++x) {
            const u32 column = (x + y / 3 % 5) * kCells / (kSize + 8), row = (y + x / 7 % 3) * kCells / (kSize + 8);
            const u32 id = patchOf[row * kCells + column];
            picture->ids[size_t(y) * kSize + x] = id;
            if (id != kNoIndex) ++picture->counts[id];
        }
    picture->image = Image(context, {"ids", kSize, kSize, VK_FORMAT_R32_UINT, 1,
                                     VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    uploadImage(context, picture->image, std::as_bytes(std::span(picture->ids)));
    picture->device = makeBuffer(context, "counts", std::vector<u32>(kPatches));
    return picture;
}

/// A pass of the benchmark's own over the picture.
void addOwn(FrameGraph& graph, const Picture& picture, const ShaderCode& shader, u32 groupWidth, u32 groupHeight)
{
    const Ref<Buffer> zero = addFill(graph, graph.import(picture.device), 0);
    graph.addPass("histogram", [&](PassBuilder& pass) {
        const auto ids = pass.read(pass.import(picture.image), Use::ComputeRead);
        const auto counts = pass.write(zero, Use::ComputeReadWrite);
        pass.record([=, &shader](PassContext& ctx) {
            ctx.dispatch(shader, {storage(gpu::kHistogramIds, ids), storage(gpu::kHistogramCounts, counts)},
                         gpu::HistogramParams{kSize, kSize, kPatches},
                         groupsFor2D(kSize, kSize, groupWidth, groupHeight));
        });
    });
}

/// Runs counted along the rows, by two threads.
void countOnHost(const Picture& picture, std::vector<std::atomic<u32>>& counts)
{
    for (std::atomic<u32>& count : counts) count.store(0, std::memory_order_relaxed);
    parallelFor(kSize, 64, 2, [&](u32 begin, u32 end) {
        const u32* at = picture.ids.data() + size_t(begin) * kSize;
        const u32* const last = picture.ids.data() + size_t(end) * kSize;
        while (at < last) {
            const u32* const first = at;
            while (at < last && *at == *first) ++at;
            if (*first < kPatches) counts[*first].fetch_add(u32(at - first), std::memory_order_relaxed);
        }
    });
}

} // namespace

void addHistogramCases(CaseList& cases)
{
    if (!cases.wants("histogram")) return;
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
            (void)addHistogram(graph, graph.import(picture.image), zero, kSize, kSize, kPatches, variant);
        };
    };
    checked("histogram, columns", engine(HistogramVariant::Columns));
    checked("histogram, subgroups", engine(HistogramVariant::Subgroups));
    auto& counts = cases.keep(std::make_shared<std::vector<std::atomic<u32>>>(kPatches));
    cases.addWall("histogram, host", [&](CaseList::Figures&) { countOnHost(picture, counts); });
    cases.addRatio({"histogram: columns over an atomic a texel", "histogram, an atomic a texel", "histogram, columns"});
    cases.addRatio({"histogram: reading alone over columns", "histogram, columns", "histogram, reads alone"});
    cases.addRatio({"histogram: columns over subgroups", "histogram, subgroups", "histogram, columns"});
    cases.addRatio({"histogram: host over columns", "histogram, columns", "histogram, host"});
}

} // namespace helio
