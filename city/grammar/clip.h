// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/grammar/geometry.h"
#include "city/model/half_space.h"

namespace helio::cga {

/// The part of a geometry with low <= p[axis] <= high (scope coordinates, m; axis 0..2). Concave polygons and holes are
/// cut exactly, cut solids are closed again by caps. Both sides of a cut share their corners to the bit. May be empty.
Geometry clipSlab(const Geometry& geometry, int axis, double low, double high);

/// The part of a geometry with dot(normal, p) >= offset (scope coordinates; unit normal, m), closed again like that of
/// clipSlab.
Geometry clipPlane(const Geometry& geometry, const glm::dvec3& normal, double offset);

} // namespace helio::cga
