// SPDX-License-Identifier: Apache-2.0
// The operations of Interpreter that move, turn and size the current shape.
#include "city/grammar/placement.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "city/grammar/interpreter.h"

namespace helio::cga {

glm::dmat3 rotationOf(const glm::dvec3& degrees)
{
    const glm::dvec3 a = degrees * (M_PI / 180.0), c(std::cos(a.x), std::cos(a.y), std::cos(a.z)),
                     s(std::sin(a.x), std::sin(a.y), std::sin(a.z));
    const glm::dmat3 rx(1, 0, 0, 0, c.x, s.x, 0, -s.x, c.x), ry(c.y, 0, -s.y, 0, 1, 0, s.y, 0, c.y),
        rz(c.z, s.z, 0, -s.z, c.z, 0, 0, 0, 1);
    return rz * ry * rx;
}

glm::dvec3 anglesOf(const glm::dmat3& r)
{
    const double y = std::asin(std::min(1.0, std::max(-1.0, -r[0][2])));
    const double x = std::atan2(r[1][2], r[2][2]), z = std::atan2(r[0][1], r[0][0]);
    return glm::dvec3(x, y, z) * (180.0 / M_PI);
}

/// Origin and axes of a coordinate system, in the building's frame.
std::pair<glm::dvec3, glm::dmat3> Interpreter::systemOf(CoordinateSystem system, const ShapeState& state) const
{
    switch (system) {
    case CoordinateSystem::Scope:
        return {state.scope.toWorld(state.localOrigin()), state.scope.axes};
    case CoordinateSystem::Pivot:
        return {state.pivot, state.pivotAxes};
    case CoordinateSystem::Object:
        return {objectOrigin_, objectAxes_};
    case CoordinateSystem::World: {
        const glm::dvec2 corner = footprintCorner(footprint_);
        return {glm::dvec3(-corner.x, -footprint_.base, corner.y), glm::dmat3(1.0)};
    }
    }
    HELIO_CHECK(false, "coordinate system ", u32(system));
}

/// t(x, y, z) along the scope's axes; translate(rel | abs, system, x, y, z).
void Interpreter::translate(const Statement& statement, ShapeState& state, Frame& frame)
{
    glm::dvec3 by = vectorArgs(statement, state, frame);
    if (statement.op == Operation::TranslateIn) {
        const auto [origin, axes] = systemOf(CoordinateSystem(statement.mode & ~kAbsolute), state);
        by = axes * by;
        if (statement.mode & kAbsolute) by += origin - state.scope.toWorld(state.localOrigin());
    } else {
        by = state.scope.axes * by;
    }
    if (trouble_.failed()) return;
    state.scope.origin += by;
    state.intact = state.intact && by == glm::dvec3(0.0);
    checkSize(state, statement.place);
}

/// s(x, y, z): a negative size mirrors the shape about its origin, which turns its faces inside out.
void Interpreter::resize(const Statement& statement, ShapeState& state, Frame& frame)
{
    const glm::dvec3 size = vectorArgs(statement, state, frame), before = state.signedSize();
    if (trouble_.failed()) return;
    // Along each axis a coordinate p of the box becomes factor * p + shift.
    glm::dvec3 factor(1.0), shift(0.0);
    const glm::dvec3 origin = state.scope.toWorld(state.localOrigin());
    for (int k = 0; k < 3; ++k) {
        const double start = state.mirrored[k] ? state.scope.size[k] : 0.0;
        if (state.scope.size[k] > kFlat) factor[k] = size[k] / before[k];
        state.mirrored[k] = size[k] < 0.0;
        state.scope.size[k] = std::abs(size[k]);
        shift[k] = (state.mirrored[k] ? state.scope.size[k] : 0.0) - factor[k] * start;
    }
    state.scope.origin = origin - state.scope.axes * state.localOrigin();
    if (!checkSize(state, statement.place) || (factor == glm::dvec3(1.0) && shift == glm::dvec3(0.0))) return;
    state.intact = false;
    if (state.asset) {
        auto asset = std::make_shared<InsertedAsset>(*state.asset);
        for (int column = 0; column < 4; ++column) asset->localFromAsset[column] *= factor;
        asset->localFromAsset[3] += shift;
        state.asset = asset;
    }
    auto scaled = std::make_shared<Geometry>(*state.geometry);
    trouble_.spend(statement.place, cornerCount(*scaled));
    for (Face& face : scaled->faces) {
        for (glm::dvec3& p : face.polygon.outer) p = factor * p + shift;
        for (Ring3& hole : face.polygon.holes)
            for (glm::dvec3& p : hole) p = factor * p + shift;
        const glm::dvec3 x = face.xAxis * factor;
        if (glm::length(x) > kFlat) face.xAxis = glm::normalize(x);
    }
    state.geometry = std::move(scaled);
}

/// r(x, y, z) about the pivot's axes, in the scope's origin or centre; rotate(rel | abs, system, x, y, z) in its
/// origin.
void Interpreter::rotate(const Statement& statement, ShapeState& state, Frame& frame)
{
    glm::dvec3 degrees(0.0);
    for (int k = 0; k < 3; ++k)
        degrees[k] = std::fmod(evaluator_.number(statement.args[size_t(k)].value, env(state, frame)), 360.0);
    const bool inSystem = statement.op == Operation::RotateIn;
    const glm::dmat3 about =
        inSystem ? systemOf(CoordinateSystem(statement.mode & ~kAbsolute), state).second : state.pivotAxes;
    const glm::dmat3 turn = about * rotationOf(degrees) * glm::transpose(about);
    const bool centred = !inSystem && statement.mode == kWholeScope;
    const glm::dvec3 local = centred ? 0.5 * state.scope.size : state.localOrigin();
    const glm::dvec3 fixed = state.scope.toWorld(local);
    const glm::dmat3 before = state.scope.axes;
    state.scope.axes = inSystem && (statement.mode & kAbsolute) ? about * rotationOf(degrees) : turn * before;
    state.scope.origin = fixed - state.scope.axes * local;
    state.intact = state.intact && state.scope.axes == before;
}

/// rotateScope(x, y, z): turns the axes about the pivot's, and fits the scope to the geometry, which stays.
void Interpreter::rotateScope(const Statement& statement, ShapeState& state, Frame& frame)
{
    glm::dvec3 degrees(0.0);
    for (int k = 0; k < 3; ++k)
        degrees[k] = std::fmod(evaluator_.number(statement.args[size_t(k)].value, env(state, frame)), 360.0);
    if (trouble_.failed() || refuseAfterInsert(statement, state)) return;
    const glm::dmat3 turn = state.pivotAxes * rotationOf(degrees) * glm::transpose(state.pivotAxes);
    turnAround(statement, state, turn * state.scope.axes, false);
}

/// Gives the scope other axes around the geometry, which stays; `pivot`: the pivot follows.
void Interpreter::turnAround(const Statement& statement, ShapeState& state, const glm::dmat3& axes, bool pivot)
{
    Geometry geometry = *state.geometry;
    trouble_.spend(statement.place, cornerCount(geometry));
    turnScope(state.scope, geometry, axes);
    state.geometry = std::make_shared<const Geometry>(std::move(geometry));
    state.mirrored = glm::bvec3(false);
    if (!pivot) return;
    state.pivot = state.scope.origin;
    state.pivotAxes = state.scope.axes;
}

/// Moves the scope along its own axes so that its centre meets that of the shape it came from.
void Interpreter::center(const Statement& statement, ShapeState& state, Frame& frame)
{
    const glm::dvec3 target = frame.outer.toWorld(0.5 * frame.outer.size),
                     own = state.scope.toWorld(0.5 * state.scope.size);
    glm::dvec3 by = glm::transpose(state.scope.axes) * (target - own);
    for (int k = 0; k < 3; ++k)
        if (!((statement.mode >> k) & 1u)) by[k] = 0.0;
    if (glm::length(by) < kFlat) return;
    state.scope.origin += state.scope.axes * by;
    state.intact = false;
}

/// mirrorScope(x, y, z): the geometry stays, the scope runs the other way along the chosen axes.
void Interpreter::mirrorScope(const Statement& statement, ShapeState& state, Frame& frame)
{
    const glm::bvec3 flip = axisArgs(statement, state, frame);
    for (int k = 0; k < 3; ++k) state.mirrored[k] = state.mirrored[k] != flip[k];
}

/// setPivot(xyz | yzx | zxy, corner): pivot and scope start in a corner of the scope, with all axes into it. Corners
/// are counted 0 origin, 1 +x, 2 +x +z, 3 +z, and 4 to 7 in the same order at the scope's top.
void Interpreter::setPivot(const Statement& statement, ShapeState& state, Frame& frame)
{
    const double corner = evaluator_.number(statement.args[0].value, env(state, frame));
    if (trouble_.failed() || refuseAfterInsert(statement, state)) return;
    if (!(corner >= 0.0 && corner <= 7.0 && std::floor(corner) == corner))
        return trouble_.fail(statement.place,
                             concat("setPivot counts the corners of the scope from 0 to 7, not ", corner));
    const u32 k = u32(corner);
    const bool farX = k % 4 == 1 || k % 4 == 2, farY = k >= 4, farZ = k % 4 >= 2;
    const glm::dvec3 x(farX ? -1 : 1, 0, 0), y(0, farY ? -1 : 1, 0), z(0, 0, farZ ? -1 : 1);
    // An odd number of flipped axes would be left-handed: then x and z change places, y keeps its line.
    glm::dmat3 axes = (int(farX) + int(farY) + int(farZ)) % 2 == 0 ? glm::dmat3(x, y, z) : glm::dmat3(z, y, x);
    if (statement.mode == 1) axes = glm::dmat3(axes[2], axes[0], axes[1]);
    if (statement.mode == 2) axes = glm::dmat3(axes[1], axes[2], axes[0]);
    const glm::dvec3 size = state.scope.size, local(farX ? size.x : 0.0, farY ? size.y : 0.0, farZ ? size.z : 0.0);
    trouble_.spend(statement.place, cornerCount(*state.geometry));
    state.geometry = std::make_shared<const Geometry>(transformed(*state.geometry, glm::transpose(axes), local));
    state.scope.origin = state.scope.toWorld(local);
    state.scope.axes = state.scope.axes * axes;
    state.scope.size = glm::abs(glm::transpose(axes) * size);
    state.mirrored = glm::bvec3(false);
    state.pivot = state.scope.origin;
    state.pivotAxes = state.scope.axes;
}

} // namespace helio::cga
