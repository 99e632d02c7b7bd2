// SPDX-License-Identifier: Apache-2.0
#include "engine/view/light_state.h"

#include <cmath>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "city/base/check.h"
#include "city/format/pack.h"

namespace helio {

std::vector<glm::vec4> outsideRadiance(std::span<const gpu::SkyPatchRecord> skyPatches, const LightState& light)
{
    const u32 cells = skyCellCount(skyPatches);
    HELIO_CHECK(light.skyRadiance.empty() || light.skyRadiance.size() == cells, light.skyRadiance.size(),
                " radiances of ", cells, " cells");
    std::vector<glm::vec4> radiance;
    for (u32 i = 0; i < cells; ++i)
        radiance.emplace_back(light.skyRadiance.empty() ? float(light.dhi / std::numbers::pi) : light.skyRadiance[i]);
    const double onGround = light.dhi + (light.sunUp() ? light.dni * light.towardsSun.z : 0.0);
    if (cells < skyPatches.size()) radiance.push_back(skyPatches.back().rho * float(onGround / std::numbers::pi));
    return radiance;
}

glm::dvec3 sunDirection(double azimuthDeg, double elevationDeg, double northDeg)
{
    const double azimuth = glm::radians(azimuthDeg - northDeg), elevation = glm::radians(elevationDeg);
    return {std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
}

} // namespace helio
