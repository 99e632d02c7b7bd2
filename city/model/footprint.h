// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "city/model/polygon.h"

namespace helio {

/// A value of a feature's property; it sets the rule attribute of the same name.
using Attribute = std::variant<double, bool, std::string>;

/// A part of a wall that a neighbour's wall stands against.
struct CoveredSpan
{
    double begin = 0.0, end = 0.0; ///< m along the edge, from its first corner
    double height = 0.0;           ///< m above the footprint's base, up to which it is covered
};

/// What a surface of a given building model is.
enum class GivenKind : u8
{
    Wall,
    Roof,
    Ground
};

/// A face of a building as the input models it (CityJSON LoD2), seen from outside; m, z up, relative to Layout::origin.
struct GivenFace
{
    Polygon3 polygon;
    GivenKind kind = GivenKind::Wall;
};

/// What one building grows from.
struct Footprint
{
    std::string id; ///< feature id, for messages and tables
    Polygon2
        outline; ///< m, x east, y north, relative to Layout::origin; outer ring counter-clockwise, first edge = front
    double height = 0.0;                         ///< m above ground, > 0
    double base = 0.0;                           ///< m, z of the ground under it
    std::map<std::string, Attribute> attributes; ///< without "height"
    std::string rule;                            ///< start rule, empty = the rule file's own
    /// Per edge of the outer ring, then of each hole: the parts of the wall on it that walls of neighbours cover.
    std::vector<std::vector<CoveredSpan>> covered;
    /// Per edge of the outer ring: it faces a street. Empty: no streets are known.
    std::vector<bool> onStreet;
    std::vector<GivenFace> faces; ///< surfaces that the input gives; empty: the outline is all there is
};

/// A coplanar piece of ground: street, pavement, court, square. Lies at its own z, faces up.
struct GroundArea
{
    std::string kind; ///< "street", "pavement", "court", "green", ...: a material name
    Polygon3 polygon;
    u32 block = kNoIndex; ///< areas of one block or street segment share a number: they form one planar subtree
};

/// A city before the grammar.
struct Layout
{
    std::vector<Footprint> footprints;
    std::vector<GroundArea> ground;
    glm::dvec3 origin{0.0};            ///< double-precision offset that was subtracted, m
    std::string crs;                   ///< as the input states it, or empty
    std::vector<std::string> notes;    ///< one line per repaired or skipped feature, with its id
    std::map<std::string, u32> counts; ///< features per kind of defect and of repair, by the name of the statistics
    std::vector<Ring2> streets;        ///< centre-lines, m, relative to origin (open lines)
    std::optional<double> latitudeDeg, longitudeDeg; ///< of the origin, where the input tells; WGS 84
};

} // namespace helio
