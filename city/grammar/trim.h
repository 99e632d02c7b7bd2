// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "city/grammar/shape_state.h"

namespace helio::cga {

/// The trim planes of a shape that trim.vertical and trim.horizontal let cut: (n, d) in the frame of the building, the
/// kept side is n.p + d >= 0.
std::vector<glm::dvec4> activeTrim(const ShapeState& state);

/// Cuts the state's geometry by its trim planes and fits the scope to it, as primitives and trim() do. False if none of
/// them cuts it.
bool trimGeometry(ShapeState& state);

} // namespace helio::cga
