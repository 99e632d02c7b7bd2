// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "city/base/types.h"
#include "shaders/shared/records.h"

namespace helio {

/// Everything that decides the light of a scene. Stages 1 to 3 run again only when it changed.
struct LightState
{
    glm::dvec3 towardsSun{0.0, 0.0, 1.0}; ///< unit, tile frame
    double dni = 800.0;                   ///< W/m2, >= 0; 0 also when the sun is below the horizon
    double dhi = 120.0;                   ///< W/m2, >= 0, of the sky
    std::vector<float> skyRadiance;       ///< W/m2/sr, one a cell of the sky; empty = the uniform sky of that dhi
    bool emission = true;                 ///< patches emit their own light

    /// Is there sunlight? A sun at or below the horizon gives none.
    bool sunUp() const { return dni > 0.0 && towardsSun.z > 0.0; }
    bool operator==(const LightState&) const = default;
};

/// Radiance of each sky patch, W/m2/sr: the sky's own, or of DHI / pi where it is uniform; of the ground beyond the
/// scene, rho / pi (DNI sin(elevation) + DHI): a plain with nothing before it.
std::vector<glm::vec4> outsideRadiance(std::span<const gpu::SkyPatchRecord> skyPatches, const LightState& light);

/// Unit vector towards a sun at an azimuth clockwise from true north and an elevation above the horizon, in degrees, in
/// a tile frame whose +y points northDeg clockwise from true north.
glm::dvec3 sunDirection(double azimuthDeg, double elevationDeg, double northDeg);

} // namespace helio
