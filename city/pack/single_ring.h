// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/model/polygon.h"

namespace helio {

/// One closed ring with the area and the outline of several coplanar rings (outer ones counter-clockwise, holes
/// clockwise seen from the lit side): each further ring hangs on the first by a cut of zero width that runs there and
/// back between two corners and crosses no edge where such a cut exists. Formats whose faces have no holes need it.
/// O(corners^2) at worst.
Ring3 joinRings(std::span<const Ring3> rings, const glm::dvec3& normal);

} // namespace helio
