// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "city/pack/scene_light.h"

namespace helio {

/// The files of a scene for Radiance, by name.
struct RadianceText
{
    std::string scene;  ///< scene.rad: materials, and polygon pK for patch K; backs are black
    std::string light;  ///< light.rad: the sun as a disc of 0.05 degrees, the sky
    std::string points; ///< points.txt, see sensorPoints
    std::string readme; ///< README.txt: the commands
};

/// Red, green and blue only. A patch that emits is a mixture of glow and plastic (Radiance's lights do not reflect),
/// found by ambient rays alone.
RadianceText exportRadiance(const Pack& pack, const SceneLight& light);

/// Writes the files into a folder, which is made where there is none.
Status writeRadiance(const Pack& pack, const SceneLight& light, const std::filesystem::path& folder);

} // namespace helio
