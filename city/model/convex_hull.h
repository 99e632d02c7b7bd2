// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/model/polygon.h"

namespace helio {

/// Convex hull, counter-clockwise, without collinear corners (Andrew's monotone chain). Fewer than three corners for a
/// degenerate set.
Ring2 convexHull(std::span<const glm::dvec2> points);

} // namespace helio
