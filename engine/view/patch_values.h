// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "city/format/pack.h"

namespace helio {

/// Ancestors of each patch in the tree, in the first component.
std::vector<glm::vec4> patchLevels(const TileView& tile);

/// What the links of a patch and of its ancestors take from a square metre of every other: their factors spread over
/// the patches below each sender by area (without the moments), 1/m2, in the first component; the picked patch itself
/// has the largest value, so that it shows.
std::vector<glm::vec4> linksOfPatch(const TileView& tile, u32 picked);

/// The error of each patch's E_indirect that the bake expects under this light, rms, W/m2 solar, in the first
/// component: TileView::patchErrors times the area mean of `indirect` (W/m2, one a patch). Empty where the pack knows
/// none.
std::vector<glm::vec4> expectedErrors(const TileView& tile, std::span<const glm::vec4> indirect);

} // namespace helio
