// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "city/grammar/shape_state.h"

namespace helio::cga {

/// Gives a state the scope and geometry of a part of it, with a tile of its own if `planar`. Its pivot moves there.
void replaceGeometry(ShapeState& state, const Scope& scope, Geometry geometry, bool planar);

/// Gives a state other faces, in the coordinates of its scope, and fits the scope to them; the pivot stays. Faces in
/// one plane of a tile make a new tile.
void replaceFaces(ShapeState& state, Geometry geometry);

/// A face with numbers on its edges: its own, or, if it is the whole lot, those of the footprint.
Face numberedFace(const Face& face, bool footprint);

/// The plane of a face, as a map to two dimensions: x along an axis of the scope as far as the plane allows.
class FacePlane
{
public:
    /// None for a face without area, or one that reaches farther than 50 km from its first corner.
    static std::optional<FacePlane> of(const Face& face);

    Polygon2 flat(const Polygon3& polygon) const;
    /// `z`: metres above the plane.
    glm::dvec3 raise(const glm::dvec2& p, double z = 0.0) const { return origin_ + u_ * p.x + v_ * p.y + normal_ * z; }
    Polygon3 raise(const Polygon2& polygon) const;
    const glm::dvec3& normal() const { return normal_; }
    glm::dvec2 direction(const glm::dvec3& d) const { return {glm::dot(u_, d), glm::dot(v_, d)}; }

private:
    FacePlane() = default;

    glm::dvec3 origin_{0.0}, u_{0.0}, v_{0.0}, normal_{0.0};
};

} // namespace helio::cga
