// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/mat3x3.hpp>
#include <utility>
#include <vector>

#include "city/model/polygon.h"

namespace helio::cga {

/// An oriented box. CGA frame of one building: metres, x east, y up, z south; origin at the footprint's first corner.
struct Scope
{
    glm::dvec3 origin{0.0};
    glm::dmat3 axes{1.0}; ///< columns: unit x, y, z axes, right-handed
    glm::dvec3 size{0.0}; ///< m, >= 0

    glm::dvec3 toWorld(const glm::dvec3& local) const { return origin + axes * local; }
};

/// A planar polygon of a shape, in the coordinates of its scope: metres along the scope's axes, from its origin.
struct Face
{
    Polygon3 polygon;
    glm::dvec3 xAxis{1.0, 0.0, 0.0}; ///< direction of its first edge: becomes the x axis of a component's scope
    u32 edge = kNoIndex;             ///< edge of the footprint on which it stands (outer ring, then holes)
    bool outer = true;               ///< false: it stands on the edge of a hole (a courtyard)
    /// Of a part of the lot, per edge of its rings (outer, then holes): edge of the footprint on whose line it lies, or
    /// kNoIndex. Empty: none is known.
    std::vector<u32> edges;
};

/// The geometry of a shape: a set of faces, or a closed solid whose faces look outward.
struct Geometry
{
    std::vector<Face> faces;
    bool closed = false;
};

/// Area of all faces, m2.
double area(const Geometry& geometry);
/// Volume of a closed solid, m3 (divergence theorem); 0 for a set of faces.
double volume(const Geometry& geometry);
/// Smallest and largest coordinate; (0, 0) for no corners.
std::pair<glm::dvec3, glm::dvec3> bounds(const Geometry& geometry);
/// Corners of all rings of all faces.
size_t cornerCount(const Geometry& geometry);
/// An edge as six integers on a grid of a micrometre, to find edges that two faces share.
using EdgeKey = std::array<i64, 6>;
EdgeKey edgeKey(const glm::dvec3& a, const glm::dvec3& b);
/// Steps that an offset, setback or roof over a face is charged: they compare every corner (holes included) with every
/// other.
u64 planeWork(const Face& face);
/// True if any face has a reflex corner or a hole.
bool isConcave(const Geometry& geometry);
/// True if every face has four corners (collinear ones not counted) at 90 degrees, within `toleranceDeg`.
bool isRectangular(const Geometry& geometry, double toleranceDeg);
/// True if all corners lie in the plane of the first face within 1e-6 m and all faces look to the same side.
bool isPlanar(const Geometry& geometry);

/// Expresses geometry in other axes: p' = rotation * (p - offset).
Geometry transformed(const Geometry& geometry, const glm::dmat3& rotation, const glm::dvec3& offset);
/// Shrinks the scope to the bounds of its geometry and moves the geometry's coordinates along.
void fitScope(Scope& scope, Geometry& geometry);
/// Turns the scope to other axes around its unmoved geometry.
void turnScope(Scope& scope, Geometry& geometry, const glm::dmat3& axes);

/// Numbers the edges of a part of a face (same coordinates) by those edges of the face in whose line they lie, within a
/// millimetre and in the same direction. Without numbers on the face, its edges count from 0.
void inheritEdges(const Face& from, Face& part);

/// Extrudes every face by a vector (scope coordinates, m; not parallel to the faces) into one closed solid: the walls
/// in the order of the edges (outer ring, then holes), then the tops, then the bottoms. Edges that two faces share get
/// no wall. Walls are numbered by Face::edges; where there are none and with `tagEdges`, by their edge, for a
/// footprint.
Geometry extrude(const Geometry& base, const glm::dvec3& by, bool tagEdges);

} // namespace helio::cga
