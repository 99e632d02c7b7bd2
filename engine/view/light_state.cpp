// SPDX-License-Identifier: Apache-2.0
#include "engine/view/light_state.h"

#include <cmath>
#include <glm/trigonometric.hpp>

namespace helio {

glm::dvec3 sunDirection(double azimuthDeg, double elevationDeg, double northDeg)
{
    const double azimuth = glm::radians(azimuthDeg - northDeg), elevation = glm::radians(elevationDeg);
    return {std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
}

} // namespace helio
