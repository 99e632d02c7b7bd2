// SPDX-License-Identifier: Apache-2.0
// The operations of Interpreter that change the current shape.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "city/grammar/interpreter.h"

namespace helio::cga {

namespace {

constexpr double kFlat = 1e-9; ///< m: a scope no larger than this along an axis is flat there

/// Rotation by degrees about x, then y, then z.
glm::dmat3 rotation(const glm::dvec3& degrees)
{
    const glm::dvec3 a = degrees * (M_PI / 180.0), c(std::cos(a.x), std::cos(a.y), std::cos(a.z)),
                     s(std::sin(a.x), std::sin(a.y), std::sin(a.z));
    const glm::dmat3 rx(1, 0, 0, 0, c.x, s.x, 0, -s.x, c.x), ry(c.y, 0, -s.y, 0, 1, 0, s.y, 0, c.y),
        rz(c.z, s.z, 0, -s.z, c.z, 0, 0, 0, 1);
    return rz * ry * rx;
}

/// The box [0, size] as a closed solid; only its side with y = 0 facing up if it is flat.
Geometry box(const glm::dvec3& size)
{
    Geometry base;
    base.faces.emplace_back().polygon.outer = {{0, 0, size.z}, {size.x, 0, size.z}, {size.x, 0, 0}, {0, 0, 0}};
    return extrude(base, {0, size.y, 0}, false);
}

} // namespace

/// Stops shapes that leave the range in which coordinates keep their precision.
bool Interpreter::checkSize(const ShapeState& state, Place place)
{
    for (int k = 0; k < 3; ++k)
        if (!(std::abs(state.scope.size[k]) < kMaxCoordinate && std::abs(state.scope.origin[k]) < kMaxCoordinate)) {
            trouble_.fail(place, concat("the shape grows beyond ", kMaxCoordinate, " m"));
            return false;
        }
    return true;
}

/// Three arguments in metres along the scope's axes; ' is relative to its size.
glm::dvec3 Interpreter::vectorArgs(const Statement& statement, const ShapeState& state, Frame& frame)
{
    glm::dvec3 v(0.0);
    for (int k = 0; k < 3; ++k) {
        const Size& arg = statement.args[size_t(k)];
        v[k] = evaluator_.number(arg.value, env(state, frame));
        if (arg.kind == SizeKind::Relative) v[k] *= state.scope.size[k];
    }
    return v;
}

void Interpreter::runOperation(const Statement& statement, ShapeState& state, Frame& frame)
{
    switch (statement.op) {
    case Operation::Nil:
        frame.deleted = true;
        return;
    case Operation::Ignored:
        return;
    case Operation::Report: {
        const std::string key = evaluator_.text(statement.args[0].value, env(state, frame));
        const Value value = evaluator_.evaluate(statement.args[1].value, env(state, frame));
        if (const bool* truth = std::get_if<bool>(&value))
            result_.reports[key] += *truth ? 1.0 : 0.0;
        else if (const double* number = std::get_if<double>(&value))
            result_.reports[key] += *number;
        else
            trouble_.fail(statement.place, "report sums numbers: its second argument must not be text");
        return;
    }
    case Operation::Translate: {
        const glm::dvec3 by = vectorArgs(statement, state, frame);
        state.scope.origin += state.scope.axes * by;
        state.intact = state.intact && by == glm::dvec3(0.0);
        checkSize(state, statement.place);
        return;
    }
    case Operation::Resize:
        return resize(statement, state, frame);
    case Operation::Rotate:
        return rotate(statement, state, frame);
    case Operation::Center:
        return center(statement, state, frame);
    case Operation::AlignScopeToAxes:
        return alignToAxes(statement, state);
    case Operation::Color:
        return setColor(statement, state, frame);
    case Operation::Set:
        return set(statement, state, frame);
    case Operation::Extrude:
        return extrudeShape(statement, state, frame);
    case Operation::PrimitiveCube:
    case Operation::PrimitiveQuad:
        return primitive(statement, state, frame);
    case Operation::Insert:
        return insertAsset(statement, state, frame);
    case Operation::Split:
        return split(statement, state, frame);
    case Operation::Component:
        return components(statement, state, frame);
    }
}

void Interpreter::resize(const Statement& statement, ShapeState& state, Frame& frame)
{
    const glm::dvec3 size = vectorArgs(statement, state, frame);
    if (trouble_.failed()) return;
    glm::dvec3 factor(1.0);
    for (int k = 0; k < 3; ++k) {
        if (size[k] < 0.0)
            return trouble_.fail(statement.place, concat("s(..) with the negative size ", size[k],
                                                         " would mirror the shape, which is not supported"));
        if (state.scope.size[k] > kFlat) factor[k] = size[k] / state.scope.size[k];
    }
    state.scope.size = size;
    if (!checkSize(state, statement.place) || factor == glm::dvec3(1.0)) return;
    state.intact = false;
    if (state.asset) {
        auto asset = std::make_shared<InsertedAsset>(*state.asset);
        for (int column = 0; column < 4; ++column) asset->localFromAsset[column] *= factor;
        state.asset = asset;
    }
    auto scaled = std::make_shared<Geometry>(*state.geometry);
    trouble_.spend(statement.place, cornerCount(*scaled));
    for (Face& face : scaled->faces) {
        for (glm::dvec3& p : face.polygon.outer) p *= factor;
        for (Ring3& hole : face.polygon.holes)
            for (glm::dvec3& p : hole) p *= factor;
        const glm::dvec3 x = face.xAxis * factor;
        if (glm::length(x) > kFlat) face.xAxis = glm::normalize(x);
    }
    state.geometry = std::move(scaled);
}

/// Turns the scope about its origin or centre; the angles are about the pivot's axes.
void Interpreter::rotate(const Statement& statement, ShapeState& state, Frame& frame)
{
    glm::dvec3 degrees(0.0);
    for (int k = 0; k < 3; ++k)
        degrees[k] = std::fmod(evaluator_.number(statement.args[size_t(k)].value, env(state, frame)), 360.0);
    const glm::dmat3 turn = state.pivotAxes * rotation(degrees) * glm::transpose(state.pivotAxes);
    const glm::dvec3 middle = state.scope.toWorld(0.5 * state.scope.size);
    state.scope.axes = turn * state.scope.axes;
    if (statement.mode == kWholeScope) state.scope.origin = middle + turn * (state.scope.origin - middle);
    state.intact = state.intact && degrees == glm::dvec3(0.0);
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

/// alignScopeToAxes(): all axes as the world's. alignScopeToAxes(y): y up, x turned as little as possible. Geometry
/// stays.
void Interpreter::alignToAxes(const Statement& statement, ShapeState& state)
{
    if (state.asset) return trouble_.fail(statement.place, "alignScopeToAxes belongs before i(..)");
    glm::dmat3 axes(1.0);
    if (statement.mode != 0) {
        const glm::dvec3 up(0, 1, 0);
        glm::dvec3 x = state.scope.axes[0] - up * state.scope.axes[0].y;
        if (glm::length(x) < 1e-6) x = -(state.scope.axes[1] - up * state.scope.axes[1].y);
        x = glm::normalize(x);
        axes = glm::dmat3(x, up, glm::cross(x, up));
    }
    Geometry geometry = *state.geometry;
    trouble_.spend(statement.place, cornerCount(geometry));
    turnScope(state.scope, geometry, axes);
    state.geometry = std::make_shared<const Geometry>(std::move(geometry));
}

void Interpreter::setColor(const Statement& statement, ShapeState& state, Frame& frame)
{
    if (statement.args.size() >= 3) {
        glm::dvec3 color;
        for (int k = 0; k < 3; ++k) color[k] = evaluator_.number(statement.args[size_t(k)].value, env(state, frame));
        state.look.color = glm::clamp(color, 0.0, 1.0);
        return;
    }
    if (statement.args.size() == 2)
        return trouble_.fail(statement.place, "color takes \"#rrggbb\" or three numbers from 0 to 1");
    const std::string text = evaluator_.text(statement.args[0].value, env(state, frame));
    if (trouble_.failed()) return;
    state.look.color = parseColor(text);
    if (!state.look.color)
        trouble_.fail(statement.place, concat("'", text, "' is no colour: write \"#rrggbb\" with hexadecimal digits"));
}

void Interpreter::set(const Statement& statement, ShapeState& state, Frame& frame)
{
    const Expr& expr = statement.args[0].value;
    const auto number = [&] { return evaluator_.number(expr, env(state, frame)); };
    const auto target = SetTarget(std::min(statement.mode, u32(SetTarget::FirstGlobal)));
    switch (target) {
    case SetTarget::ColorR:
    case SetTarget::ColorG:
    case SetTarget::ColorB: {
        glm::dvec3 color = state.look.color.value_or(glm::dvec3(1.0));
        color[int(target) - int(SetTarget::ColorR)] = std::clamp(number(), 0.0, 1.0);
        state.look.color = color;
        return;
    }
    case SetTarget::ColorRgb:
        return setColor(statement, state, frame);
    case SetTarget::Name:
        state.look.material = evaluator_.text(expr, env(state, frame));
        return;
    case SetTarget::EmissiveR:
    case SetTarget::EmissiveG:
    case SetTarget::EmissiveB: {
        const double emissive = number();
        if (emissive < 0.0)
            return trouble_.fail(expr.place, concat("an emission must not be negative: ", emissive, " W/m2"));
        state.look.emissive[int(target) - int(SetTarget::EmissiveR)] = emissive;
        return;
    }
    case SetTarget::Seedian: {
        const double seed = number();
        state.seedian = seed;
        frame.seed = mixSeed(seed_, hashText(toText(Value(seed)))); // children roll from the rule's own seed
        frame.random = Random(frame.seed);
        return;
    }
    case SetTarget::Ignored:
        return;
    case SetTarget::FirstGlobal:
        break;
    }
    auto attributes = state.attributes ? std::make_shared<std::map<u32, Value>>(*state.attributes)
                                       : std::make_shared<std::map<u32, Value>>();
    (*attributes)[statement.mode - u32(SetTarget::FirstGlobal)] = evaluator_.evaluate(expr, env(state, frame));
    state.attributes = std::move(attributes);
}

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
    state.geometry = std::make_shared<const Geometry>(std::move(solid));
    state.tile = nullptr;
    state.intact = state.footprint = false;
    checkSize(state, statement.place);
}

/// primitiveCube fills the scope with a box, primitiveQuad with a rectangle in the plane of its two largest sides'
/// axes.
void Interpreter::primitive(const Statement& statement, ShapeState& state, Frame& frame)
{
    const size_t argCount = statement.args.size();
    std::vector<double> sizes;
    for (const Size& arg : statement.args) sizes.push_back(evaluator_.number(arg.value, env(state, frame)));
    if (trouble_.failed()) return;
    for (const double size : sizes)
        if (!(size > 0.0)) return trouble_.fail(statement.place, concat("a primitive needs sizes above 0, not ", size));
    const bool cube = statement.op == Operation::PrimitiveCube;
    if (argCount != 0 && argCount != (cube ? 3u : 2u))
        return trouble_.fail(statement.place,
                             cube ? "primitiveCube takes no sizes or three" : "primitiveQuad takes no sizes or two");
    glm::dvec3& size = state.scope.size;
    if (cube && argCount == 3) size = {sizes[0], sizes[1], sizes[2]};
    if (!cube && argCount == 2) size = {sizes[0], 0.0, sizes[1]};
    if (std::max({size.x, size.y, size.z}) <= kFlat) size = cube ? glm::dvec3(1.0) : glm::dvec3(1.0, 0.0, 1.0);
    Geometry geometry;
    const int flat = size.y <= kFlat ? 1 : size.z <= kFlat ? 2 : size.x <= kFlat ? 0 : -1;
    if (cube && flat < 0) {
        geometry = box(size);
    } else {
        const int normal = flat < 0 ? 1 : flat, u = (normal + 1) % 3, v = (normal + 2) % 3;
        if (size[u] <= kFlat || size[v] <= kFlat)
            return trouble_.fail(statement.place,
                                 "a primitive needs a scope with at least two sizes above 0: set them with s(..)");
        Ring3& ring = geometry.faces.emplace_back().polygon.outer;
        ring.assign(4, glm::dvec3(0.0));
        ring[1][u] = ring[2][u] = size[u];
        ring[2][v] = ring[3][v] = size[v];
    }
    state.geometry = std::make_shared<const Geometry>(std::move(geometry));
    state.tile = nullptr;
    state.asset = nullptr;
    state.intact = state.footprint = false;
    checkSize(state, statement.place);
}

/// i("name"): the asset's box is fitted to the scope. Sizes of 0 follow the asset: all three take its own size, two its
/// uniform scale, one the mean scale of the others.
void Interpreter::insertAsset(const Statement& statement, ShapeState& state, Frame& frame)
{
    const std::string name = evaluator_.text(statement.args[0].value, env(state, frame));
    if (trouble_.failed()) return;
    const auto found = boxes_.find(name);
    if (!found) return trouble_.fail(statement.place, concat("i(\"", name, "\"): ", found.error().message));

    auto asset = std::make_shared<InsertedAsset>();
    const auto [it, added] = assetIndex_.emplace(name, u32(result_.assets.size()));
    if (added) result_.assets.push_back(name);
    asset->asset = it->second;
    asset->boxMin = found->min;
    asset->boxMax = found->max;
    // zUp assets stand on their z axis: turn them so that it becomes y.
    const bool zUp = statement.mode == kWholeScope;
    const glm::dmat3 turn =
        zUp ? glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0)) : glm::dmat3(1.0);
    const glm::dvec3 a = turn * found->min, b = turn * found->max, low = glm::min(a, b), extent = glm::abs(b - a);
    glm::dvec3& size = state.scope.size;
    double scaleSum = 0.0;
    int scaleCount = 0;
    for (int k = 0; k < 3; ++k)
        if (size[k] > kFlat && extent[k] > kFlat) {
            scaleSum += size[k] / extent[k];
            ++scaleCount;
        }
    const double mean = scaleCount > 0 ? scaleSum / scaleCount : 1.0;
    for (int k = 0; k < 3; ++k) {
        if (size[k] <= kFlat) size[k] = mean * extent[k];
        const double scale = extent[k] > kFlat ? size[k] / extent[k] : 1.0;
        for (int column = 0; column < 3; ++column) asset->localFromAsset[column][k] = turn[column][k] * scale;
        asset->localFromAsset[3][k] = -low[k] * scale;
    }
    state.asset = std::move(asset);
    checkSize(state, statement.place);
}

} // namespace helio::cga
