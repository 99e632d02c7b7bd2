// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/assets/asset.h"

namespace helio {

/// Mean reflectance of what an orthographic view along -z onto the mesh shows (r, g, b, solar), over the covered part
/// of a 128 x 128 grid on its box; back faces do not count. `triangleRho`: one entry a triangle. Falls back to the mean
/// weighted by area for a mesh that shows nothing to the front.
glm::dvec4 frontViewReflectance(const AssetMesh& mesh, std::span<const glm::dvec4> triangleRho);

} // namespace helio
