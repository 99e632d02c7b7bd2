// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "city/base/types.h"

namespace helio {

/// A planar thing that may share its plane with others.
struct PlaneItem
{
    glm::dvec3 normal{0.0}; ///< unit
    glm::dvec3 point{0.0};  ///< in the plane, m
    bool alone = false;     ///< is a group of its own, whatever lies in its plane
    u32 kind = 0;           ///< things of different kinds never share a group
};

/// Groups of items that lie in one plane: normals within 0.26 degrees (1 - cos < 1e-5) and less than 2 mm apart. The
/// first item of a group defines its plane and takes all later ones that lie in it; groups come in
/// the order of their first items, items in their own order. O(n log n) unless very many different planes lie within
/// millimetres.
std::vector<std::vector<u32>> groupByPlane(std::span<const PlaneItem> items);

} // namespace helio
