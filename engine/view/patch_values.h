// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <vector>

#include "city/format/pack.h"

namespace helio {

/// Ancestors of each patch in the tree, in the first component.
std::vector<glm::vec4> patchLevels(const TileView& tile);

/// What the links of a patch and of its ancestors take from a square metre of every other: their factors spread over
/// the patches below each sender by area (without the moments), 1/m2, in the first component; the picked patch itself
/// has the largest value, so that it shows.
std::vector<glm::vec4> linksOfPatch(const TileView& tile, u32 picked);

} // namespace helio
