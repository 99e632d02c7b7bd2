// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/format/pack.h"
#include "engine/view/camera.h"

namespace helio {

/// A camera at eye height (1.7 m above the ground) in the open near the middle of the bounds, along the longest free
/// line of sight: found on a grid of cells that the static mesh occupies above 1 m.
Camera streetCamera(const TileView& tile, glm::dvec3 boundsMin, glm::dvec3 boundsMax);

} // namespace helio
