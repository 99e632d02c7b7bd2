// SPDX-License-Identifier: Apache-2.0
#include "engine/stream/reads.h"

#include <array>
#include <glm/vec4.hpp>
#include <limits>
#include <vector>

#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "shaders/embedded.h"

namespace helio {

bool canRead(const Context& context, Reads reads, u64 elements)
{
    constexpr u32 kMostImages = 9; // of one shader, the gather that updates
    if (reads == Reads::Storage) return true;
    if (!context.texelsFit(elements)) return false;
    const DeviceFacts& facts = context.facts();
    return reads == Reads::Texels || (facts.storageImageExtendedFormats && facts.maxStageStorageImages >= kMostImages);
}

Reads fastestReads(Context& context, u64 elements)
{
    constexpr u32 kTable = 1u << 16, kGroups = 64, kRuns = 3;
    if (!canRead(context, Reads::Texels, std::max<u64>(elements, kTable))) return Reads::Storage;
    const ReadVariants variants{shaders::kRandomGatherComp, shaders::kRandomGatherImagesComp,
                                shaders::kRandomGatherStorageComp};
    const Buffer table = makeBuffer(context, "sample table", std::vector<glm::vec4>(kTable));
    const Buffer sums = makeBuffer(context, "sample sums", std::vector<glm::vec4>(kGroups * 64));
    std::array<double, 3> best;
    best.fill(std::numeric_limits<double>::infinity());
    Recorder recorder(context);
    for (u32 run = 0; run <= kRuns; ++run) // the first one compiles
        for (u32 k = 0; k < best.size(); ++k) {
            if (!canRead(context, Reads(k), elements)) continue;
            FrameGraph graph("reads sample");
            graph.addPass("loads", [&](PassBuilder& pass) {
                const auto from = pass.read(pass.import(table), Use::ComputeRead);
                const auto to = pass.write(pass.import(sums), Use::ComputeWrite);
                pass.record([=, &shader = variants[Reads(k)]](PassContext& ctx) {
                    ctx.dispatch(shader, {texels(0, from, VK_FORMAT_R32G32B32A32_SFLOAT), storage(1, to)}, kTable - 1,
                                 Groups{kGroups, 1, 1});
                });
            });
            const Status compiled = graph.compile(context);
            HELIO_CHECK(compiled.ok(), compiled.ok() ? "" : compiled.error().message);
            recorder.begin();
            graph.execute(recorder, true);
            recorder.submitAndWait();
            if (run == 0) continue;
            for (const PassTime& time : recorder.times()) best[k] = std::min(best[k], time.milliseconds);
        }
    Reads fastest = Reads::Storage;
    for (const Reads reads : {Reads::Texels, Reads::Images})
        if (best[u32(reads)] < best[u32(fastest)]) fastest = reads;
    return fastest;
}

} // namespace helio
