// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <vector>

#include "city/format/pack.h"

namespace helio {

/// The light of an exported scene, and how finely it is to be measured.
struct SceneLight
{
    glm::dvec3 toSun{0.0, 0.0, 1.0}; ///< unit vector; at or below the horizon there is no sun
    double dni = 800.0, dhi = 120.0; ///< W/m2; the sky is uniform above the horizon
    u32 pointsPerPatch = 16;         ///< sensor points, at least 1
};

/// Radiance of the ground beyond the scene, W/m2/sr, red, green, blue: rho / pi (DNI sin(elevation) + DHI); 0 where the
/// pack has none.
glm::dvec3 farGroundRadiance(const Pack& pack, const SceneLight& light);

/// Red, green and blue reflectance and emission: patches that share them share a material.
using Surface6 = std::array<float, 6>;

/// Patches by material, materials by rising value, patches by rising id.
std::map<Surface6, std::vector<u32>> patchesByMaterial(const TileView& tile);

/// Sensor points: `pointsPerPatch` lines "x y z nx ny nz" a patch in the order of the ids, well spread over its area,
/// 1 mm before its lit side.
std::string sensorPoints(const Pack& pack, u32 pointsPerPatch);

/// Appends a blank and the shortest text that reads back as the same number.
void appendNumber(std::string& text, double value);

} // namespace helio
