// SPDX-License-Identifier: Apache-2.0
// The operations of Interpreter that change the geometry of the current shape.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "city/grammar/cleanup.h"
#include "city/grammar/interpreter.h"

namespace helio::cga {

namespace {

/// Turns a face over: its corners run the other way round.
void reverse(Face& face)
{
    std::reverse(face.polygon.outer.begin(), face.polygon.outer.end());
    for (Ring3& hole : face.polygon.holes) std::reverse(hole.begin(), hole.end());
    face.xAxis = -face.xAxis;
    face.edges.clear();
}

/// Parts of the lot keep the numbers of the footprint's edges on which they lie.
void keepEdges(const ShapeState& state, Geometry& geometry)
{
    const std::vector<Face>& before = state.geometry->faces;
    if (before.size() != 1 || (!state.footprint && before[0].edges.empty())) return;
    for (Face& face : geometry.faces) inheritEdges(before[0], face);
}

} // namespace

void Interpreter::extrudeShape(const Statement& statement, ShapeState& state, Frame& frame)
{
    const double height = evaluator_.number(statement.args[0].value, env(state, frame));
    if (trouble_.failed()) return;
    if (state.asset) return trouble_.fail(statement.place, "extrude belongs before i(..)");
    if (state.geometry->closed)
        return trouble_.fail(statement.place,
                             "extrude needs a face, but the shape is a solid: pick one with comp(f) { top : .. }");
    if (state.geometry->faces.empty()) return;
    if (height <= 1e-6) return trouble_.warn(statement.place, "extrude by a height of 0 or less leaves the shape flat");
    trouble_.spend(statement.place, 4 * cornerCount(*state.geometry));

    const auto mode = ExtrudeMode(statement.mode);
    const glm::dvec3 normal = unitNormal(state.geometry->faces[0].polygon);
    const glm::dvec3 up = glm::transpose(state.scope.axes) * glm::dvec3(0, 1, 0);
    const glm::dvec3 direction = mode == ExtrudeMode::FaceNormal ? normal : up;
    if (!isPlanar(*state.geometry))
        return trouble_.fail(statement.place,
                             "extrude of faces in several planes is not supported: use comp(f) { all : extrude(..) }");
    if (std::abs(glm::dot(direction, normal)) < 1e-3)
        return trouble_.fail(statement.place,
                             "extrude along world.up needs a face that is not upright: use extrude(face.normal, ..)");
    if (mode == ExtrudeMode::WorldUpFlatTop && std::abs(glm::dot(up, normal)) < 1.0 - 1e-9)
        return trouble_.fail(statement.place,
                             "extrude(world.up.flatTop, ..) is only supported for level faces: use world.up");
    Geometry solid = extrude(*state.geometry, direction * height, state.footprint);

    // The new y axis runs along the extrusion; x stays as far as it can.
    const glm::dvec3 y = state.scope.axes * direction;
    glm::dvec3 x = state.scope.axes[0] - y * glm::dot(y, state.scope.axes[0]);
    if (glm::length(x) < 1e-6) x = state.scope.axes[2] - y * glm::dot(y, state.scope.axes[2]);
    x = glm::normalize(x);
    turnScope(state.scope, solid, glm::dmat3(x, y, glm::cross(x, y)));
    replaceShape(state, std::move(solid));
    state.mirrored = glm::bvec3(false);
    checkSize(state, statement.place);
}

/// mirror(x, y, z): within the scope, which stays. Faces keep looking outward.
void Interpreter::mirror(const Statement& statement, ShapeState& state, Frame& frame)
{
    const glm::bvec3 flip = axisArgs(statement, state, frame);
    if (trouble_.failed() || !(flip.x || flip.y || flip.z)) return;
    const glm::dvec3 factor(flip.x ? -1 : 1, flip.y ? -1 : 1, flip.z ? -1 : 1),
        size = state.scope.size, shift(flip.x ? size.x : 0, flip.y ? size.y : 0, flip.z ? size.z : 0);
    state.intact = false;
    if (state.asset) {
        auto asset = std::make_shared<InsertedAsset>(*state.asset);
        for (int column = 0; column < 4; ++column) asset->localFromAsset[column] *= factor;
        asset->localFromAsset[3] += shift;
        state.asset = asset;
        return;
    }
    Geometry geometry = *state.geometry;
    trouble_.spend(statement.place, cornerCount(geometry));
    for (Face& face : geometry.faces) {
        for (glm::dvec3& p : face.polygon.outer) p = factor * p + shift;
        for (Ring3& hole : face.polygon.holes)
            for (glm::dvec3& p : hole) p = factor * p + shift;
        face.xAxis *= factor;
        face.edges.clear();
        if ((int(flip.x) + int(flip.y) + int(flip.z)) % 2 == 1) reverse(face);
    }
    replaceShape(state, std::move(geometry));
}

void Interpreter::reverseNormals(const Statement& statement, ShapeState& state)
{
    if (refuseAfterInsert(statement, state)) return;
    Geometry geometry = *state.geometry;
    trouble_.spend(statement.place, cornerCount(geometry));
    for (Face& face : geometry.faces) reverse(face);
    replaceShape(state, std::move(geometry));
}

/// cleanupGeometry(vertices | edges | faces | all, tolerance 0..1).
void Interpreter::cleanup(const Statement& statement, ShapeState& state, Frame& frame)
{
    const double tolerance = evaluator_.number(statement.args[0].value, env(state, frame));
    if (trouble_.failed() || refuseAfterInsert(statement, state)) return;
    if (!(tolerance >= 0.0 && tolerance <= 1.0))
        return trouble_.fail(statement.place, concat("cleanupGeometry takes a tolerance from 0 to 1, not ", tolerance));
    const u64 corners = cornerCount(*state.geometry);
    trouble_.spend(statement.place, corners * corners);
    if (trouble_.failed()) return;
    Geometry geometry = cleaned(*state.geometry, statement.mode, tolerance);
    keepEdges(state, geometry);
    replaceShape(state, std::move(geometry));
}

void Interpreter::deleteHoles(const Statement& statement, ShapeState& state)
{
    if (refuseAfterInsert(statement, state)) return;
    Geometry geometry = *state.geometry;
    trouble_.spend(statement.place, cornerCount(geometry));
    bool holes = false;
    for (Face& face : geometry.faces) {
        holes = holes || !face.polygon.holes.empty();
        face.polygon.holes.clear();
        face.edges.clear();
    }
    if (!holes) return;
    if (geometry.closed)
        return trouble_.fail(statement.place, "deleteHoles would leave the walls of the holes inside the solid: use it "
                                              "on the face, before extrude");
    keepEdges(state, geometry);
    replaceShape(state, std::move(geometry));
}

} // namespace helio::cga
