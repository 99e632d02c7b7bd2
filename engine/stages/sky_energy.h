// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "engine/graph/frame_graph.h"
#include "engine/stream/tile_tables.h"

namespace helio {

/// E_sky = pi sum factor (L + slope . offset) over the sky links of each patch. radiance: SkyRadianceRecord a sky
/// patch; to: vec4 a patch, W/m2.
[[nodiscard]] Ref<Buffer> addSkyEnergy(FrameGraph& graph, const TileTables& tile, Ref<Buffer> radiance, Ref<Buffer> to);

} // namespace helio
