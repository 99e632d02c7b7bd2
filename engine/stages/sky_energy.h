// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "engine/graph/frame_graph.h"
#include "engine/stream/tile_tables.h"

namespace helio {

/// Radiance of a sky patch, W/m2/sr: its mean, and its change from side to side, the same in all channels.
struct SkyRadiance
{
    glm::vec4 mean{0.0f};
    glm::vec2 slope{0.0f};
};

/// The sky patches as the senders of the tile's sky links.
std::vector<glm::vec4> skySenders(const TileTables& tile, std::span<const SkyRadiance> radiance);

/// E_sky = pi sum factor (L + slope . offset) over the sky links of each patch, L being linear across each sky patch
/// and the offset the middle of what the patch sees of it; once a sky change, never part of the sweeps. senders:
/// skySenders; to: vec4 a patch, W/m2.
[[nodiscard]] Ref<Buffer> addSkyEnergy(FrameGraph& graph, const TileTables& tile, Ref<Buffer> senders, Ref<Buffer> to);

} // namespace helio
