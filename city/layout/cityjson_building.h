// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "city/layout/cityjson_geometry.h"
#include "city/model/footprint.h"

// From the surfaces of a building to its footprint and its faces. Internal to city/layout.
namespace helio {

/// Where a building stands. Coordinates relative to SurfaceSet::anchor.
struct GroundOutline
{
    std::vector<Polygon2> polygons; ///< seen from above; one ground surface comes as it is drawn, several united
    double ground = 0.0;            ///< z of the lowest point of the ground surfaces
    double top = 0.0;               ///< z of the highest point
    bool fromRoof = false;          ///< there is no floor: the outline is the roof's
    std::string trouble;            ///< why there are no polygons
};

/// The ground surfaces by semantics; else the lowest floors, if they are at least half as large as the roof; else
/// everything that is not vertical, seen from above.
GroundOutline groundOutline(const SurfaceSet& set);

/// What facesOf had to do.
struct FaceReport
{
    u32 degenerate = 0; ///< surfaces below 1 cm2, dropped
    u32 split = 0;      ///< surfaces off their plane by more than 1 cm, split into triangles
    u32 turned = 0;     ///< faces that looked inward
    void add(const FaceReport& other)
    {
        degenerate += other.degenerate;
        split += other.split;
        turned += other.turned;
    }
};

/// Walls and roofs as planar faces seen from outside: by semantics, else by normal. Floors are left out, but for those
/// over 0.3 m above the ground (Roof: a part of the skin without openings). x, y in the file's coordinates, z above
/// `outline.ground`.
std::vector<GivenFace> facesOf(const SurfaceSet& set, const GroundOutline& outline, FaceReport& report);

} // namespace helio
