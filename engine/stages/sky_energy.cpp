// SPDX-License-Identifier: Apache-2.0
#include "engine/stages/sky_energy.h"

#include <bit>
#include <glm/common.hpp>
#include <glm/packing.hpp>
#include <numbers>

#include "engine/stages/gather.h"

namespace helio {

namespace {

/// See shaders/lib/senders.glsl.
glm::vec4 packedSlopes(const glm::vec4& x, const glm::vec4& y)
{
    const glm::uvec4 words(glm::packHalf2x16({x.r, x.g}), glm::packHalf2x16({x.b, x.a}), glm::packHalf2x16({y.r, y.g}),
                           glm::packHalf2x16({y.b, y.a}));
    return std::bit_cast<glm::vec4>(words);
}

} // namespace

std::vector<glm::vec4> skySenders(const TileTables& tile, std::span<const SkyRadiance> radiance)
{
    HELIO_CHECK(radiance.size() == tile.skyPatches.size(), radiance.size(), " of ", tile.skyPatches.size());
    std::vector<glm::vec4> senders;
    for (const SkyRadiance& sky : radiance) {
        senders.push_back(sky.mean);
        if (tile.skyLinks.stride == 1) continue;
        const glm::vec4 over = kSkySlopeScale / glm::max(sky.mean, glm::vec4(gpu::kDarkest));
        senders.push_back(packedSlopes(sky.slope.x * over, sky.slope.y * over));
    }
    return senders;
}

Ref<Buffer> addSkyEnergy(FrameGraph& graph, const TileTables& tile, Ref<Buffer> senders, Ref<Buffer> to)
{
    return addGather(graph, tile.skyLinks, senders, to, {"sky energy", std::numbers::pi_v<float>, tile.reads});
}

} // namespace helio
