// SPDX-License-Identifier: Apache-2.0
#include "engine/stages/histogram.h"

#include <algorithm>
#include <array>
#include <limits>

#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "shaders/embedded.h"
#include "shaders/shared/sun.h"

namespace helio {

Ref<Buffer> addHistogram(FrameGraph& graph, Ref<Image> ids, Ref<Buffer> counts, u32 width, u32 height, u32 patchCount,
                         HistogramVariant variant)
{
    return graph.addPass("histogram", [&](PassBuilder& pass) {
        const auto from = pass.read(ids, Use::ComputeRead);
        const auto to = pass.write(counts, Use::ComputeReadWrite);
        const ShaderCode& shader =
            variant == HistogramVariant::Subgroups ? shaders::kHistogramSubgroupsComp : shaders::kHistogramComp;
        pass.record([=, &shader, params = gpu::HistogramParams{width, height, patchCount}](PassContext& ctx) {
            ctx.dispatch(shader, {storage(gpu::kHistogramIds, from), storage(gpu::kHistogramCounts, to)}, params,
                         groupsFor2D(width, height, gpu::kHistogramGroup, gpu::kHistogramRun));
        });
        return to;
    });
}

HistogramVariant fasterHistogram(Context& context)
{
    constexpr u32 kSize = 512, kPatch = 12, kAcross = kSize / kPatch + 1, kRuns = 3;
    std::vector<u32> ids(kSize * kSize);
    for (u32 y = 0; y < kSize; ++y)
        for (u32 x = 0; x < kSize; ++x) ids[y * kSize + x] = y / kPatch * kAcross + x / kPatch;
    std::vector<u32> twice(kAcross * kAcross, 0); // after one count of each variant
    for (const u32 id : ids) twice[id] += 2;
    const Image picture(context, {"sample ids", kSize, kSize, VK_FORMAT_R32_UINT, 1,
                                  VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    uploadImage(context, picture, std::as_bytes(std::span(ids)));
    const Buffer counts = makeBuffer(context, "sample counts", std::vector<u32>(kAcross * kAcross));
    constexpr std::array kVariants{HistogramVariant::Columns, HistogramVariant::Subgroups};
    std::array<double, 2> best;
    best.fill(std::numeric_limits<double>::infinity());
    Recorder recorder(context);
    for (u32 run = 0; run <= kRuns; ++run) // the first one compiles
        for (size_t k = 0; k < kVariants.size(); ++k) {
            FrameGraph graph("histogram sample");
            (void)addHistogram(graph, graph.import(picture), graph.import(counts), kSize, kSize, kAcross * kAcross,
                               kVariants[k]);
            const Status compiled = graph.compile(context);
            HELIO_CHECK(compiled.ok(), compiled.ok() ? "" : compiled.error().message);
            recorder.begin();
            graph.execute(recorder, true);
            recorder.submitAndWait();
            if (run == 0) {
                // A compiler that takes lanes apart where the sum over a subgroup wants them together loses counts.
                const std::vector<u32> counted = downloadItems<u32>(context, counts);
                if (kVariants[k] == HistogramVariant::Subgroups && counted != twice) return HistogramVariant::Columns;
                continue;
            }
            for (const PassTime& time : recorder.times()) best[k] = std::min(best[k], time.milliseconds);
        }
    return best[1] < best[0] ? HistogramVariant::Subgroups : HistogramVariant::Columns;
}

} // namespace helio
