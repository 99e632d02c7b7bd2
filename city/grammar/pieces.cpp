// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/pieces.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace helio::cga {

namespace {

constexpr double kReach = 5e4; ///< m: half of what the grid of the polygon operations holds

} // namespace

void replaceGeometry(ShapeState& state, const Scope& scope, Geometry geometry, bool planar)
{
    state.scope = scope;
    state.pivot = scope.origin;
    state.pivotAxes = scope.axes;
    state.footprint = false;
    state.mirrored = glm::bvec3(false);
    auto shared = std::make_shared<const Geometry>(std::move(geometry));
    state.geometry = shared;
    state.tile = planar ? std::make_shared<const Tile>(Tile{scope, shared, area(*shared), state.intact}) : nullptr;
}

void replaceFaces(ShapeState& state, Geometry geometry)
{
    fitScope(state.scope, geometry);
    const bool planar = state.tile != nullptr && !geometry.faces.empty() && isPlanar(geometry);
    auto shared = std::make_shared<const Geometry>(std::move(geometry));
    state.geometry = shared;
    state.footprint = false;
    state.tile =
        planar ? std::make_shared<const Tile>(Tile{state.scope, shared, area(*shared), state.intact}) : nullptr;
    if (!planar) state.intact = false;
}

Face numberedFace(const Face& face, bool footprint)
{
    Face result = face;
    if (!footprint || !result.edges.empty()) return result;
    size_t count = face.polygon.outer.size();
    for (const Ring3& hole : face.polygon.holes) count += hole.size();
    for (u32 k = 0; k < count; ++k) result.edges.push_back(k);
    return result;
}

std::optional<FacePlane> FacePlane::of(const Face& face)
{
    FacePlane plane;
    plane.normal_ = unitNormal(face.polygon);
    if (face.polygon.outer.size() < 3 || plane.normal_ == glm::dvec3(0.0)) return {};
    plane.origin_ = face.polygon.outer[0];
    for (const glm::dvec3& p : face.polygon.outer)
        if (!(glm::distance(p, plane.origin_) < kReach)) return {};
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0);
    glm::dvec3 u = x - plane.normal_ * plane.normal_.x;
    if (glm::length(u) < 1e-3) u = y - plane.normal_ * plane.normal_.y;
    plane.u_ = glm::normalize(u);
    plane.v_ = glm::cross(plane.normal_, plane.u_);
    return plane;
}

Polygon2 FacePlane::flat(const Polygon3& polygon) const
{
    const auto flatten = [&](const Ring3& ring) {
        Ring2 result;
        for (const glm::dvec3& p : ring) result.push_back(direction(p - origin_));
        return result;
    };
    Polygon2 result{flatten(polygon.outer), {}};
    for (const Ring3& hole : polygon.holes) result.holes.push_back(flatten(hole));
    return result;
}

Polygon3 FacePlane::raise(const Polygon2& polygon) const
{
    const auto lift = [&](const Ring2& ring) {
        Ring3 result;
        for (const glm::dvec2& p : ring) result.push_back(raise(p));
        return result;
    };
    Polygon3 result{lift(polygon.outer), {}};
    for (const Ring2& hole : polygon.holes) result.holes.push_back(lift(hole));
    return result;
}

} // namespace helio::cga
