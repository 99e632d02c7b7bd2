// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x3.hpp>
#include <map>
#include <memory>
#include <optional>

#include "city/grammar/geometry.h"
#include "city/grammar/mesh_edges.h"
#include "city/grammar/value.h"
#include "city/grammar/vocabulary.h"

namespace helio::cga {

/// What a shape's surface looks like, as the rules set it.
struct Look
{
    std::string material;
    std::optional<glm::dvec3> color; ///< sRGB 0..1
    glm::dvec3 emissive{0.0};        ///< exitance, W/m2
    double opacity = 1.0;            ///< kept for the rules to read: surfaces are opaque to light
};

/// The planar piece that comp or split made, before s, t and r: what an asset may fill.
struct Tile
{
    Scope scope;
    std::shared_ptr<const Geometry> geometry;
    double area = 0.0;   ///< m2
    bool intact = false; ///< nothing moved it since its face was made
};

/// An asset that i() put into a scope.
struct InsertedAsset
{
    u32 asset = 0;                       ///< into the building's list of asset names
    glm::dmat4x3 localFromAsset{1.0};    ///< asset units to metres in the scope's coordinates
    glm::dvec3 boxMin{0.0}, boxMax{0.0}; ///< asset units
};

/// The current shape: what operations change and rules inherit.
struct ShapeState
{
    Scope scope;
    std::shared_ptr<const Geometry> geometry;
    /// Axes along which s(..) with a negative size mirrored the shape: the scope's origin is then the upper end of its
    /// box, and its size reads negative.
    glm::bvec3 mirrored{false};
    glm::dvec3 pivot{0.0};     ///< origin for scope.tx..tz
    glm::dmat3 pivotAxes{1.0}; ///< axes about which r turns
    Look look;
    std::shared_ptr<const Tile> tile; ///< null for solids
    bool intact = false;              ///< the geometry lies where comp or split made it: its area is part of the face
    std::shared_ptr<const InsertedAsset> asset; ///< replaces the geometry
    u32 edge = kNoIndex;                        ///< edge of the footprint that the face stands on
    bool footprint = false;                     ///< the geometry is still the lot: extrude numbers its walls
    double splitIndex = 0.0, splitTotal = 0.0, compIndex = 0.0, compTotal = 0.0;
    std::string_view compSelector;
    std::optional<double> seedian;
    bool trimVertical = true, trimHorizontal = false;   ///< which of the trim planes cut
    std::shared_ptr<const std::vector<TrimPlane>> trim; ///< of the face that comp(f) made; building frame; may be null
    std::shared_ptr<const std::map<u32, Value>> attributes; ///< values that set() gave to attributes, by global

    /// Sizes as the language sees them: negative along mirrored axes.
    glm::dvec3 signedSize() const
    {
        glm::dvec3 size = scope.size;
        for (int k = 0; k < 3; ++k)
            if (mirrored[k]) size[k] = -size[k];
        return size;
    }
    /// Origin as the language sees it, in the coordinates of the scope's box.
    glm::dvec3 localOrigin() const
    {
        glm::dvec3 origin(0.0);
        for (int k = 0; k < 3; ++k)
            if (mirrored[k]) origin[k] = scope.size[k];
        return origin;
    }
};

} // namespace helio::cga
