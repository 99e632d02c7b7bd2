// SPDX-License-Identifier: Apache-2.0
#include "engine/stages/sun_energy.h"

#include "engine/graph/pass_context.h"
#include "engine/stages/gather.h"
#include "shaders/embedded.h"
#include "shaders/shared/sun.h"

namespace helio {

namespace {

const ReadVariants kSunDensity{shaders::kSunDensityComp, shaders::kSunDensityImagesComp,
                               shaders::kSunDensityStorageComp};
const ReadVariants kSunEnergy{shaders::kSunEnergyComp, shaders::kSunEnergyImagesComp, shaders::kSunEnergyStorageComp};

} // namespace

SunEnergyRefs addSunEnergy(FrameGraph& graph, const TileTables& tile, Ref<Buffer> counts, Ref<Buffer> density,
                           SunEnergyRefs to, const SunEnergyInput& input)
{
    gpu::SunEnergyParams params{};
    params.direction = input.towardsSun;
    params.texelArea = float(input.texelArea);
    params.dni = input.dni;
    params.patchCount = tile.patchCount;
    params.minSamples = kMinSunSamples;
    params.minCosine = kMinSunCosine;
    params.discRadius = input.discRadius;
    const Groups groups = groupsFor(tile.patchCount, gpu::kSunGroup);

    density = graph.addPass("sun density", [&](PassBuilder& pass) {
        const auto planes = pass.read(pass.import(tile.planes), Use::ComputeRead);
        const auto from = pass.read(counts, Use::ComputeRead);
        const auto out = pass.write(density, Use::ComputeWrite);
        const ShaderCode& shader = kSunDensity[tile.reads];
        pass.record([=, &shader](PassContext& ctx) {
            ctx.dispatch(shader,
                         {texels(gpu::kSunCounts, from, VK_FORMAT_R32_UINT),
                          texels(gpu::kSunPlanes, planes, VK_FORMAT_R32G32B32A32_SFLOAT),
                          storage(gpu::kSunDensity, out)},
                         params, groups);
        });
        return out;
    });
    density = addPull(graph, tile, density, "sun pull");
    to.tally = addFill(graph, to.tally, 0);
    return graph.addPass("sun energy", [&](PassBuilder& pass) {
        const auto planes = pass.read(pass.import(tile.planes), Use::ComputeRead);
        const auto nodes = pass.read(pass.import(tile.nodes), Use::ComputeRead);
        const auto from = pass.read(density, Use::ComputeRead);
        const SunEnergyRefs out{pass.write(to.irradiance, Use::ComputeWrite),
                                pass.write(to.tally, Use::ComputeReadWrite)};
        const ShaderCode& shader = kSunEnergy[tile.reads];
        pass.record([=, &shader](PassContext& ctx) {
            ctx.dispatch(shader,
                         {texels(gpu::kSunPlanes, planes, VK_FORMAT_R32G32B32A32_SFLOAT),
                          texels(gpu::kSunDensity, from, VK_FORMAT_R32G32B32A32_SFLOAT),
                          texels(gpu::kSunNodes, nodes, VK_FORMAT_R32G32_UINT),
                          storage(gpu::kSunIrradiance, out.irradiance), storage(gpu::kSunTally, out.tally)},
                         params, groups);
        });
        return out;
    });
}

} // namespace helio
