// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "city/model/polygon.h"

namespace helio {

/// A value of a feature's property; it sets the rule attribute of the same name.
using Attribute = std::variant<double, bool, std::string>;

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
    /// Per edge of the outer ring, then of each hole: height up to which a neighbour's wall covers at least half of it,
    /// m; 0 = free.
    std::vector<double> coveredHeight;
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
    glm::dvec3 origin{0.0};         ///< double-precision offset that was subtracted, m
    std::string crs;                ///< as the input states it, or empty
    std::vector<std::string> notes; ///< one line per repaired or skipped feature, with its id
};

} // namespace helio
