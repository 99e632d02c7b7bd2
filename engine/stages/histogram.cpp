// SPDX-License-Identifier: Apache-2.0
#include "engine/stages/histogram.h"

#include "engine/graph/pass_context.h"
#include "shaders/embedded.h"
#include "shaders/shared/sun.h"

namespace helio {

Ref<Buffer> addHistogram(FrameGraph& graph, Ref<Image> ids, Ref<Buffer> counts, u32 width, u32 height, u32 patchCount,
                         const HistogramOptions& options)
{
    return graph.addPass("histogram", [&](PassBuilder& pass) {
        const auto from = pass.read(ids, Use::ComputeRead);
        const auto to = pass.write(counts, Use::ComputeReadWrite);
        pass.record([=, params = gpu::HistogramParams{width, height, patchCount}](PassContext& ctx) {
            ctx.dispatch(shaders::kHistogramComp,
                         {storage(gpu::kHistogramIds, from), storage(gpu::kHistogramCounts, to)}, params,
                         groupsFor2D(width, height, gpu::kHistogramGroup, gpu::kHistogramRun),
                         {{0, options.aggregate ? 1u : 0u}});
        });
        return to;
    });
}

} // namespace helio
