// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/base/lanes.h"
#include "city/model/polygon.h"

namespace helio {

/// Unit vector into the half space before a plane, distributed as the cosine to its normal for x, y uniform in [0, 1).
glm::dvec3 cosineDirection(const PlaneFrame& frame, double x, double y);

/// The same for up to eight pairs at once; within 1e-6 of cosineDirection().
void cosineDirections(const PlaneFrame& frame, const Row8& x, const Row8& y, std::span<glm::dvec3> directions);

} // namespace helio
