// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "city/base/hash.h"
#include "engine/stream/smooth_mesh.h"

namespace helio::twin {

/// What the device's shaders make of the patches' means, in double precision: a value a corner, a patch and a fan.
std::vector<glm::dvec4> smoothLight(const SmoothMesh& mesh, std::span<const glm::dvec4> means);

/// Means of patches for tests: from flat to steep, channel by channel; in the last some are dark.
std::vector<glm::dvec4> randomMeans(Random& random, size_t count);

} // namespace helio::twin
