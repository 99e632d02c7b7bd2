// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "city/base/types.h"

// Convex polygons seen from a point. Internal to city/light.
namespace helio {

/// A convex planar polygon in space, m.
using Convex = std::vector<glm::dvec3>;

/// A half space dot(normal, p) >= offset; the normal need not be of unit length.
struct HalfSpace
{
    glm::dvec3 normal{0.0};
    double offset = 0.0;
};

/// The part of a convex polygon in a half space; heights within `tolerance` (in units of the normal) count as 0. Empty
/// if no corner lies above.
Convex clipConvex(const Convex& polygon, const HalfSpace& half, double tolerance);

/// Factor from a surface element to a convex polygon above its horizon, from either side, 0..1 (Lambert's formula).
double convexFactor(const glm::dvec3& point, const glm::dvec3& normal, const Convex& polygon);

/// Cuts out of `visible` (convex polygons) what the convex polygon `occluder`, which lies between, hides from `point`.
/// The hidden pieces go to `hidden`. An occluder seen edge-on hides nothing.
void hideBehind(const glm::dvec3& point, const Convex& occluder, std::vector<Convex>& visible,
                std::vector<Convex>& hidden);

} // namespace helio
