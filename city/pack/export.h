// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "city/format/pack.h"

namespace helio {

/// Text of the two files of a scene of polygons.
struct SurfaceText
{
    std::string obj; ///< face k = patch k; z up, metres, corners counter-clockwise from the lit side
    std::string csv; ///< row k = patch k: kind,building,facade,floor,bay,rho_*,emit_*
};

/// The patches of a pack as polygons, in the order of their ids. kind = surface name; building -1 = ground; facade =
/// number of the planar root in its building; floor and bay = numbers of the next two levels, or 0. Coordinates are
/// exact in double (outline points and rests); holes become cuts of zero width (joinRings).
SurfaceText exportSurfaces(const Pack& pack);

/// Writes BASE.obj and BASE.csv.
Status writeSurfaces(const Pack& pack, const std::filesystem::path& base);

} // namespace helio
