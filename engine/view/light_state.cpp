// SPDX-License-Identifier: Apache-2.0
#include "engine/view/light_state.h"

#include <cmath>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "city/base/check.h"
#include "city/format/pack.h"
#include "shaders/shared/disc.h"

namespace helio {

std::vector<SkyRadiance> outsideRadiance(std::span<const gpu::SkyPatchRecord> skyPatches, const LightState& light)
{
    const u32 cells = skyCellCount(skyPatches);
    HELIO_CHECK(light.skyRadiance.empty() || light.skyRadiance.size() == cells, light.skyRadiance.size(),
                " radiances of ", cells, " cells");
    const CellRadiance uniform{float(light.dhi / std::numbers::pi), {}};
    std::vector<SkyRadiance> radiance;
    for (u32 i = 0; i < cells; ++i) {
        const CellRadiance& cell = light.skyRadiance.empty() ? uniform : light.skyRadiance[i];
        radiance.push_back({glm::vec4(cell.mean), cell.slope});
    }
    const double onGround = light.dhi + (light.sunUp() ? light.dni * light.towardsSun.z : 0.0);
    if (cells < skyPatches.size()) radiance.push_back({skyPatches.back().rho * float(onGround / std::numbers::pi), {}});
    return radiance;
}

void setSunDisc(LightState& light, const glm::dvec3& towardsCentre, double dni)
{
    light.towardsSun = towardsCentre;
    light.dni = dni;
    light.sunRadius = double(gpu::kSunRadius);
    const float t = float(towardsCentre.z / light.sunRadius);
    if (t >= 1.0f || t <= -1.0f) return;
    const double share = double(gpu::discShare(t));
    const double sine = light.sunRadius * double(gpu::discHeight(t)) / share;
    const double level = std::sqrt((1.0 - sine * sine) / (1.0 - towardsCentre.z * towardsCentre.z));
    light.towardsSun = {towardsCentre.x * level, towardsCentre.y * level, sine};
    light.dni = dni * share;
    light.sunRadius = 0.0;
}

glm::dvec3 sunDirection(double azimuthDeg, double elevationDeg, double northDeg)
{
    const double azimuth = glm::radians(azimuthDeg - northDeg), elevation = glm::radians(elevationDeg);
    return {std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
}

} // namespace helio
