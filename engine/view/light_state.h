// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <span>
#include <vector>

#include "city/base/types.h"
#include "engine/stages/sky_energy.h"
#include "shaders/shared/records.h"

namespace helio {

/// E_sun and E_sky of every patch, W/m2, from elsewhere.
struct FirstLight
{
    std::vector<glm::vec4> sun, sky;
};

/// Radiance of a cell of the sky, W/m2/sr: its mean, and its change from side to side along the cell's two coordinates
/// (SkyDome::placeIn), which counts where the pack's sky links have offsets.
struct CellRadiance
{
    float mean = 0.0f;
    glm::vec2 slope{0.0f};
    bool operator==(const CellRadiance&) const = default;
};

/// Everything that decides the light of a scene. Stages 1 to 3 run again only when it changed.
struct LightState
{
    glm::dvec3 towardsSun{0.0, 0.0, 1.0};    ///< unit, tile frame
    double dni = 800.0;                      ///< W/m2, >= 0; 0 also when the sun is below the horizon
    double sunRadius = 0.0;                  ///< rad, of the disc that patches on edge see; 0 = a point
    double dhi = 120.0;                      ///< W/m2, >= 0, of the sky
    std::vector<CellRadiance> skyRadiance;   ///< one a cell of the sky; empty = the uniform sky of that dhi
    bool emission = true;                    ///< patches emit their own light
    std::shared_ptr<const FirstLight> given; ///< stands in place of the sun raster and the sky links, if there is one

    /// Is there sunlight? A sun at or below the horizon gives none.
    bool sunUp() const { return dni > 0.0 && towardsSun.z > 0.0; }
    bool operator==(const LightState&) const = default;
};

/// Radiance of each sky patch, W/m2/sr: the sky's own, or of DHI / pi where it is uniform; of the ground beyond the
/// scene, rho / pi (DNI sin(elevation) + DHI): a plain with nothing before it.
std::vector<SkyRadiance> outsideRadiance(std::span<const gpu::SkyPatchRecord> skyPatches, const LightState& light);

/// Puts the sun's disc into the sky. Where the horizon cuts it, the light is that of the part above: its share of the
/// DNI from its centroid, so that an open horizontal plane gets what the part gives it; nothing when the disc has set.
/// `towardsCentre`: unit; as it appears, refraction included.
void setSunDisc(LightState& light, const glm::dvec3& towardsCentre, double dni);

/// Unit vector towards a sun at an azimuth clockwise from true north and an elevation above the horizon, in degrees, in
/// a tile frame whose +y points northDeg clockwise from true north.
glm::dvec3 sunDirection(double azimuthDeg, double elevationDeg, double northDeg);

} // namespace helio
