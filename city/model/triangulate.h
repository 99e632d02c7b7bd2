// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <vector>

#include "city/model/polygon.h"

namespace helio {

/// Triangles of a polygon with holes, by ear clipping with hole bridges (Eberly, "Triangulation by ear clipping").
/// Indices run over outer ring, then hole 0, hole 1, ...; triangles are counter-clockwise. Total area equals the
/// polygon's for simple input; a self-intersecting ring gives some triangulation of at most corners - 2 + 2 holes
/// triangles, never a hang.
std::vector<std::array<u32, 3>> triangulate(const Polygon2& polygon);

/// The same for a planar polygon in space, projected along its normal.
std::vector<std::array<u32, 3>> triangulate(const Polygon3& polygon);

} // namespace helio
