// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "city/model/polygon.h"

namespace helio {

/// The recess in a wall behind a tile that an asset fills: one quadrilateral an edge of `ring` (counter-clockwise seen
/// from the lit side), `depth` metres deep, its lit side inwards, and the back of the recess last. Drawn so that nobody
/// looks past the asset's frame into the building; it exchanges no light of its own. depth > 0.
std::vector<Polygon3> revealOf(const Ring3& ring, const glm::dvec3& normal, double depth);

} // namespace helio
