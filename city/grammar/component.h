// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/grammar/geometry.h"
#include "city/grammar/mesh_edges.h"
#include "city/grammar/program.h"
#include "city/grammar/street_sides.h"

namespace helio::cga {

/// True if a component with this unit normal (in the axes that the selector refers to: scope, object or world) is
/// selected by its direction. Quadrants (front +z, right +x, back -z, left -x, top +y, bottom -y) go by the largest
/// component; ties at 45 degrees are decided in that order. horizontal: more than 78.75 degrees of slope, vertical: at
/// most 11.25, aslant and nutant (overhanging) between; side: not horizontal. Selectors without a direction select
/// nothing but All.
bool selects(Selector selector, const glm::dvec3& normal);

/// Which axes a selector refers to.
enum class SelectorFrame : u8
{
    Scope,
    Object,
    World
};
SelectorFrame frameOf(Selector selector);
/// The street forms select only faces on the outer ring: a courtyard has no street.
bool isStreet(Selector selector);

/// A part of a geometry that a selector may take. Scope coordinates.
struct Component
{
    glm::dvec3 normal{0.0}; ///< of a face; outward from the faces at an edge or corner; unit or zero
    u32 edge = kNoIndex;    ///< edge of the footprint that it stands on
    bool outer = true;      ///< false: it belongs to a courtyard
    bool border = false;
    RoofEdge roofEdge = RoofEdge::None;
    u32 face = 0;                               ///< a face's own number, or that of a face at it
    glm::dvec3 from{0.0}, to{0.0}, upward{0.0}; ///< of an edge: ends and y axis; of a corner: both ends are its place
};

/// Components in the order of the faces and their rings. `worldFromScope`: axes of the scope in the building's frame.
std::vector<Component> componentsOf(const Geometry& geometry, const std::vector<MeshEdge>& edges, ComponentKind kind,
                                    const glm::dmat3& worldFromScope);

/// What the directions of selectors refer to.
struct SelectorContext
{
    glm::dmat3 objectFromScope{1.0}, worldFromScope{1.0};
    const StreetSides* streets = nullptr; ///< null: the street forms are the object forms, without courtyards
};

/// True if the selector takes the component that has this number among all.
bool selects(Selector selector, u32 selectorIndex, const Component& component, u32 number,
             const SelectorContext& context);

/// A shape of its own for one face: x along its first edge, z its normal, origin at its lower corner, sz = 0.
std::pair<Scope, Geometry> faceShape(const Scope& parent, const Face& face);

/// A shape without faces for an edge: x along it, y away from the faces at it (of a border: their normal), sy = sz = 0;
/// or for a corner: the parent's axes and no size.
Scope edgeScope(const Scope& parent, const Component& component);

} // namespace helio::cga
