// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

#include "city/grammar/geometry.h"

namespace helio::cga {

/// A ring without corners that repeat their predecessor within 1e-9 m.
Ring3 withoutRepeats(const Ring3& ring);

/// Sorts loops of one plane into polygons: counter-clockwise ones about the normal are outlines, the others holes of
/// the outline around them. Loops of less than 1e-10 m2 are rounding and are left out.
std::vector<Polygon3> assembleLoops(std::vector<Ring3> loops, const glm::dvec3& normal);

/// Closes a solid that was cut by a plane: `onPlane` tells the corners that lie on it, `normal` points away from what
/// is kept. The caps' edges are those of the faces at the cut, once in each direction; where a corner of one face lies
/// on the edge of another, the corner is put into both. The caps are appended to the faces, with `xAxis`.
void closeCut(Geometry& geometry, const std::function<bool(const glm::dvec3&)>& onPlane, const glm::dvec3& normal,
              const glm::dvec3& xAxis);

} // namespace helio::cga
