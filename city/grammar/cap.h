// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

#include "city/grammar/geometry.h"

namespace helio::cga {

/// Closes a solid that was cut by a plane: `onPlane` tells the corners that lie on it, `normal` points away from what
/// is kept. The caps' edges are those of the faces at the cut, once in each direction; where a corner of one face lies
/// on the edge of another, the corner is put into both. The caps are appended to the faces, with `xAxis`.
void closeCut(Geometry& geometry, const std::function<bool(const glm::dvec3&)>& onPlane, const glm::dvec3& normal,
              const glm::dvec3& xAxis);

} // namespace helio::cga
