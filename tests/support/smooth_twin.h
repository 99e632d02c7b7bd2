// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "engine/stream/smooth_mesh.h"

namespace helio::twin {

/// What the device's shaders make of the patches' means, in double precision: a value a corner, a patch and a fan.
std::vector<glm::dvec4> smoothLight(const SmoothMesh& mesh, std::span<const glm::dvec4> means);

} // namespace helio::twin
