// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat3x3.hpp>

namespace helio::cga {

inline constexpr double kFlat = 1e-9; ///< m: a scope no larger than this along an axis is flat there

/// Rotation by degrees about x, then y, then z: Rz Ry Rx.
glm::dmat3 rotationOf(const glm::dvec3& degrees);
/// The angles in degrees that give a rotation: the inverse of rotationOf, y in -90..90.
glm::dvec3 anglesOf(const glm::dmat3& rotation);

} // namespace helio::cga
