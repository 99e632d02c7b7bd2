// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>

#include "city/grammar/geometry.h"

namespace helio::cga {

/// What an edge is on a roof.
enum class RoofEdge : u8
{
    None,
    Ridge,  ///< convex and level, between two slopes
    Hip,    ///< convex and inclined, between two slopes
    Valley, ///< concave, between two slopes
    Eave    ///< level lower end of a slope, against anything that is no slope
};

/// An edge of a face, in the direction in which its ring runs.
struct MeshEdge
{
    glm::dvec3 from, to;      ///< scope coordinates
    u32 face = 0;             ///< whose ring it belongs to
    u32 other = kNoIndex;     ///< the face with the opposite edge, the first one if there are several
    bool first = true;        ///< it comes before its opposite: an edge of two faces counts once
    bool border = true;       ///< no face lies along it
    u32 footprint = kNoIndex; ///< edge of the footprint on whose line it lies
    bool outer = true;        ///< of the outer ring
};

/// All edges of all faces, face by face, ring by ring. Edges without an opposite of the same ends are borders; with
/// `findPartial`, only if no part of an edge of another face runs against them within a millimetre. `work` counts the
/// comparisons that this takes.
std::vector<MeshEdge> meshEdges(const Geometry& geometry, bool findPartial = false, u64* work = nullptr);

/// Kind of an edge between faces of these unit normals (world axes, y up); `otherNormal` null: a border.
/// A slope is a face that looks up, more than 11.25 degrees from vertical. Level: at most 5 degrees of slope.
RoofEdge roofEdge(const glm::dvec3& direction, const glm::dvec3& normal, const glm::dvec3* otherNormal);

/// A plane through an edge that halves the angle between the faces at it; the face lies on its positive side:
/// dot(plane.xyz, p) + plane.w >= 0.
struct TrimPlane
{
    glm::dvec4 plane;
    bool vertical = true; ///< its edge rises by at least 40 degrees
};

/// The trim planes of one face: those of its edges to other faces that do not cut the face itself. Scope coordinates;
/// `up` is the unit direction from which an edge's rise is measured.
std::vector<TrimPlane> trimPlanesOf(const Geometry& geometry, const std::vector<MeshEdge>& edges, u32 face,
                                    const glm::dvec3& up);

} // namespace helio::cga
