// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <span>

#include "city/base/types.h"

namespace helio {

/// A rectangle in a plane, with the index of what it bounds.
struct PlaneBox
{
    glm::dvec2 lower{0.0}, upper{0.0}; ///< m
    double area = 0.0;                 ///< of what it bounds, m2
    u32 item = 0;
};

/// Reorders `boxes` (at least two) so that the first k lie on one side of a cut and the rest on the other, and returns
/// k, 0 < k < size. Prefers cuts that no box straddles, balanced by area, across the longer side; without one it cuts
/// at the area median of the centres across the longer side. (A guillotine tree keeps every node a filled rectangle,
/// which halves the error of a link against n-ary levels.)
u32 guillotineCut(std::span<PlaneBox> boxes);

} // namespace helio
