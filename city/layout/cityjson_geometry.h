// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "city/model/polygon.h"

// The surfaces of one geometry object of CityJSON. Internal to city/layout.
namespace helio {

enum class SurfaceKind : u8
{
    Unknown, ///< no semantics, or none that decides
    Ground,
    Wall,
    Roof,
    Inside ///< of a room: nothing of the building's skin
};

struct CitySurface
{
    Polygon3 polygon;         ///< relative to SurfaceSet::anchor, m
    std::vector<u32> corners; ///< vertex indices of the outer ring
    SurfaceKind kind = SurfaceKind::Unknown;
};

/// What one geometry object holds.
struct SurfaceSet
{
    std::vector<CitySurface> surfaces;
    glm::dvec3 anchor{0.0}; ///< a corner of the geometry in the file's coordinates
    double lod = 0.0;
    u32 degenerate = 0;     ///< surfaces of fewer than three corners, left out
    u32 badSurfaces = 0;    ///< surfaces and inner rings that could not be read
    u32 sharedSurfaces = 0; ///< surfaces between two solids, left out
    std::string trouble;    ///< what was wrong with the first bad one
};

/// True for the types that readSurfaceSet knows: MultiSurface, CompositeSurface, Solid, MultiSolid, CompositeSolid.
bool hasSurfaces(const nlohmann::json& geometry);
/// The level of detail: a number or a text ("2.2"). Without one: 2 if there are semantics, else 1.
double lodOf(const nlohmann::json& geometry);

/// Reads the surfaces of a geometry; inner shells are left out. `vertices` in m; NaN marks one that is not usable.
SurfaceSet readSurfaceSet(const nlohmann::json& geometry, std::span<const glm::dvec3> vertices);

} // namespace helio
