// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x3.hpp>
#include <span>
#include <vector>

#include "city/assets/asset.h"

namespace helio {

/// A corner of a trimmed mesh, in the world frame.
struct TrimmedVertex
{
    glm::dvec3 position{0.0}; ///< m
    glm::dvec3 normal{0.0};   ///< unit
    glm::dvec3 albedo{0.0};   ///< linear
    bool glass = false;
};

struct TrimmedMesh
{
    std::vector<TrimmedVertex> vertices;
    std::vector<u32> indices; ///< triangles, counter-clockwise outside
};

/// The part of an asset where n.p + d >= 0 for every plane (n, d) in the world frame, m: for cornices and balconies
/// that meet at a corner. Triangles are clipped, attributes interpolated along their edges; the cut stays open.
TrimmedMesh trimMesh(const AssetMesh& mesh, const glm::dmat4x3& worldFromAsset, std::span<const glm::dvec4> planes);

} // namespace helio
