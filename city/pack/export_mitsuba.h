// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <utility>

#include "city/pack/scene_light.h"

namespace helio {

/// A scene for Mitsuba 3: the XML file and the binary files that it names, relative to it.
struct MitsubaScene
{
    std::string xml;
    std::vector<std::pair<std::string, std::string>> files; ///< name, bytes
};

/// Meshes (binary PLY, one for each material, triangles of patches by rising id) with one-sided diffuse reflectors, a
/// directional sun, and the sky as a map of 8 x 2048 pixels: white above the horizon, black below. With `meters` > 0,
/// that many patches, evenly spaced by id, are meshes of their own (patch_K) with an irradiancemeter (meter_K)
/// each, whose film has one pixel. A meter does not see a directional sun itself: it gives
/// E_sky + E_indirect. Coordinates are floats, relative to the pack's origin. Red, green and blue only.
/// `stem` names the files.
MitsubaScene exportMitsuba(const Pack& pack, const SceneLight& light, const std::string& stem, u32 meters);

/// Writes FILE.xml and beside it FILE_*.ply, FILE_sky.pfm and FILE_points.txt (sensorPoints).
Status writeMitsuba(const Pack& pack, const SceneLight& light, const std::filesystem::path& file, u32 meters);

} // namespace helio
