// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/geometry/clip.h"

// Internal to city/geometry.
namespace helio {

/// Polygons from the result of a boolean operation (outer rings counter-clockwise, holes clockwise). Every hole goes to
/// the smallest outer ring around it: Clipper's own tree loses holes that touch their outer ring. Spikes of rounding
/// are cut off, pieces thinner than two grid steps on average are dropped.
std::vector<Polygon2> assemble(const ClipperLib::Paths& paths);

} // namespace helio
