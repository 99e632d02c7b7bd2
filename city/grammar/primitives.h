// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/grammar/geometry.h"

// Unit shapes, scaled to fill the scope [0, size]: metres, y up. Sizes must be > 0 where nothing else is said. Solids
// are closed and look outward; walls begin with their lower edge, which is their xAxis. Round shapes are regular
// polygons in the ellipse of the scope, with the first corner on the side of +x.
namespace helio::cga {

/// Least and most sides, segments and rings of a round shape.
inline constexpr u32 kMinSides = 3, kMaxSides = 256;

/// Six faces: front (+z), right, back, left, top, bottom. A size of 0 along one axis leaves the one rectangle in the
/// plane of the other two that looks along that axis.
Geometry boxPrimitive(const glm::dvec3& size);
/// The rectangle y = 0 that looks up (size.y is not used).
Geometry quadPrimitive(const glm::dvec3& size);
/// A polygon of `sides` corners in y = 0 that looks up (size.y is not used).
Geometry diskPrimitive(u32 sides, const glm::dvec3& size);
/// `sides` walls, top, bottom.
Geometry cylinderPrimitive(u32 sides, const glm::dvec3& size);
/// `sides` triangles that meet in the middle of the scope's top, and the bottom.
Geometry conePrimitive(u32 sides, const glm::dvec3& size);
/// `segments` around the y axis, `rings` from pole to pole (at least 2): triangles at the poles, planar quads between.
Geometry spherePrimitive(u32 segments, u32 rings, const glm::dvec3& size);

} // namespace helio::cga
