// SPDX-License-Identifier: Apache-2.0
#include "engine/stages/sky_energy.h"

#include "engine/graph/pass_context.h"
#include "shaders/embedded.h"
#include "shaders/shared/solve.h"

namespace helio {

Ref<Buffer> addSkyEnergy(FrameGraph& graph, const TileTables& tile, Ref<Buffer> radiance, Ref<Buffer> to)
{
    return graph.addPass("sky energy", [&](PassBuilder& pass) {
        const auto rows = pass.read(pass.import(tile.skyRows), Use::ComputeRead);
        const auto columns = pass.read(pass.import(tile.skyColumns), Use::ComputeRead);
        const auto factors = pass.read(pass.import(tile.skyFactors), Use::ComputeRead);
        const auto offsets = pass.read(pass.import(tile.skyOffsets), Use::ComputeRead);
        const auto from = pass.read(radiance, Use::ComputeRead);
        const auto out = pass.write(to, Use::ComputeWrite);
        const gpu::SkyParams params{tile.patchCount, tile.hasSkyOffsets ? 1u : 0u};
        pass.record([=](PassContext& ctx) {
            ctx.dispatch(shaders::kSkyEnergyComp,
                         {storage(gpu::kSkyRows, rows), storage(gpu::kSkyColumns, columns),
                          storage(gpu::kSkyFactors, factors), storage(gpu::kSkyRadiance, from),
                          storage(gpu::kSkyIrradiance, out), storage(gpu::kSkyOffsets, offsets)},
                         params, groupsFor(params.patchCount, gpu::kSolveGroup));
        });
        return out;
    });
}

} // namespace helio
