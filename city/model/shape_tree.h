// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x3.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

#include "city/model/polygon.h"

namespace helio {

/// A diffuse surface. Channels of every light quantity: linear Rec.709 r, g, b and broadband solar.
struct Surface
{
    std::string name;         ///< material.name, or empty
    glm::dvec4 rho{0.5};      ///< reflectance, 0..1
    glm::dvec4 emission{0.0}; ///< exitance, W/m2
    friend bool operator==(const Surface&, const Surface&) = default;
};

/// Solar reflectance where the input has none: 0.2126 r + 0.7152 g + 0.0722 b.
inline double solarFromRgb(const glm::dvec3& rgb)
{
    return 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b;
}

/// How a shape came from its parent.
enum class ShapeOp : u8
{
    Root,      ///< the footprint, or the scene
    Rule,      ///< spawned by name
    Split,     ///< a part of a split or repeat
    Component, ///< a face of comp(f)
    Insert,    ///< an asset
    Group      ///< a level of a given hierarchy (OBJ scenes)
};

/// How an asset stands to the plane of the shape it was inserted on.
enum class AssetPlacement : u8
{
    None,
    Fill,   ///< fills its tile of the facade, at or behind its plane: the tile is the patch
    Overlay ///< stands out of the plane (balcony, cornice): no patch of its own, it carries the id of the patch behind
            ///< it
};

/// A node of the derivation. Parents come before their children; siblings are in the order of derivation.
struct Shape
{
    u32 parent = kNoIndex;
    u32 name = 0;            ///< rule or terminal name, into ShapeTree::names
    u32 building = kNoIndex; ///< number of the building; kNoIndex = ground
    ShapeOp op = ShapeOp::Root;
    /// Number of the child that the derivation gave it under its parent (children without any leaf are forgotten, so
    /// numbers may be missing): the path of these numbers is the stable key of a shape.
    u32 child = 0;
    bool covered = false; ///< leaf on a part of a wall that a neighbour covers: it exchanges no light
    // Leaves only:
    u32 polygonBegin = 0,
        polygonCount = 0;      ///< into ShapeTree::polygons; may lie in several planes (a solid); 0 for an overlay
    u32 surface = kNoIndex;    ///< into ShapeTree::surfaces
    u32 sourceFace = kNoIndex; ///< face of the OBJ it was read from
    u32 asset = kNoIndex;      ///< into ShapeTree::assets
    AssetPlacement placement = AssetPlacement::None;
    glm::dmat4x3 worldFromAsset{1.0}; ///< asset units to metres, z up; columns x, y, z axes and origin
    u32 trimBegin = 0, trimCount = 0; ///< of an asset, into ShapeTree::trimPlanes: it shows where all of them keep it
};

/// What the grammar (or a scene file) hands to the light: the whole derivation tree, never thrown away.
/// World frame: metres, x east, y north, z up, relative to the tile's origin.
struct ShapeTree
{
    std::vector<std::string> names;
    std::vector<Surface> surfaces;
    std::vector<std::string> assets;      ///< paths as written in the rule, one entry an asset
    std::vector<std::string> buildingIds; ///< feature id of each building
    std::vector<Shape> shapes;
    std::vector<Polygon3> polygons;
    std::vector<glm::dvec4> trimPlanes; ///< (n, d), world frame: keep the side n.p + d >= 0
};

/// Stable key of a shape within its building: the child numbers on the path from the root, "0/3/1"; empty for a root.
/// Editing a rule changes the keys below it alone. Programmer error: no such shape.
std::string treeKey(const ShapeTree& tree, u32 shape);

} // namespace helio
