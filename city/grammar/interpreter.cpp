// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/interpreter.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace helio::cga {

namespace {

/// The lot: CGA frame (x east, y up, z south), x along the first edge, z out of it. Null for an outline that has no
/// area.
std::optional<std::pair<Scope, Geometry>> lotOf(const Footprint& footprint)
{
    const Ring2& outer = footprint.outline.outer;
    if (outer.size() < 3) return {};
    const auto convert = [&](const Ring2& ring) {
        Ring3 result;
        for (const glm::dvec2& p : ring) result.emplace_back(p.x - outer[0].x, 0.0, -(p.y - outer[0].y));
        return result;
    };
    Geometry geometry;
    Face& face = geometry.faces.emplace_back();
    face.polygon.outer = convert(outer);
    for (const Ring2& hole : footprint.outline.holes)
        if (hole.size() >= 3) face.polygon.holes.push_back(convert(hole));
    const glm::dvec3 first = face.polygon.outer[1] - face.polygon.outer[0];
    const double size = glm::length(first);
    if (!(size > 0.0) || !(vectorArea(face.polygon).y > 0.0)) return {};
    for (const Ring3& ring : {face.polygon.outer})
        for (const glm::dvec3& p : ring)
            if (!(std::abs(p.x) < kMaxCoordinate && std::abs(p.z) < kMaxCoordinate)) return {};
    face.xAxis = first / size;
    Scope scope;
    const glm::dmat3 axes(face.xAxis, glm::dvec3(0, 1, 0), glm::cross(face.xAxis, glm::dvec3(0, 1, 0)));
    turnScope(scope, geometry, axes);
    geometry.faces[0].xAxis = glm::dvec3(1, 0, 0);
    return std::pair(scope, std::move(geometry));
}

} // namespace

Interpreter::Interpreter(const Program& program, const Footprint& footprint, const DeriveOptions& options,
                         AssetBoxes& boxes, u64 seed, Trouble& trouble)
    : program_(program), footprint_(footprint), boxes_(boxes), seed_(seed), trouble_(trouble), occlusion_(footprint),
      evaluator_(program, footprint, options, occlusion_, seed, trouble)
{
}

BuildingShapes Interpreter::run(u32 startRule)
{
    const Rule& rule = program_.rules[startRule];
    Shape root;
    root.name = rule.name;
    root.op = ShapeOp::Root;
    result_.shapes.push_back(root);
    auto lot = lotOf(footprint_);
    if (!lot && footprint_.faces.empty()) {
        trouble_.warn(rule.place, "footprints without area, with less than three corners or clockwise are not derived");
        return std::move(result_);
    }
    ShapeState state;
    if (lot) {
        state.scope = lot->first;
        state.geometry = std::make_shared<const Geometry>(std::move(lot->second));
    } else {
        state.geometry = std::make_shared<const Geometry>();
    }
    state.pivot = objectOrigin_ = state.scope.origin;
    state.pivotAxes = objectAxes_ = state.scope.axes;
    state.footprint = true;
    evaluator_.setInitialShape(state);

    Frame frame;
    frame.rule = rule.name;
    frame.seed = seed_;
    frame.random = Random(mixSeed(seed_, hashText(program_.names[rule.name])));
    frame.outer = state.scope;
    if (!footprint_.faces.empty()) {
        runGivenFaces(rule, frame, state);
        return std::move(result_);
    }
    const std::vector<Value> values = entryValues(rule, {}, state, frame);
    frame.parameters = values;
    runBody(rule.body, state, frame);
    if (!frame.spawned && !frame.deleted && !trouble_.failed()) emitLeaf(state, frame, rule.place);
    return std::move(result_);
}

/// Arguments of a rule, then its locals: what its body sees as parameters.
std::vector<Value> Interpreter::entryValues(const Rule& rule, std::span<const Value> arguments, const ShapeState& state,
                                            Frame& frame)
{
    std::vector<Value> values(arguments.begin(), arguments.end());
    values.reserve(arguments.size() + rule.locals.size()); // what has been computed must not move
    for (const Expr& local : rule.locals)
        values.push_back(evaluator_.evaluate(local, {&state, std::span<const Value>(values), &frame.random}));
    return values;
}

/// Follows case and percent down to the body that is carried out.
const Body* Interpreter::choose(const Body& body, const ShapeState& state, Frame& frame)
{
    const Body* chosen = &body;
    while (chosen->kind != Body::Kind::Plain && !trouble_.failed()) {
        size_t branch = 0;
        if (chosen->kind == Body::Kind::Cases) {
            while (branch < chosen->conditions.size() &&
                   !evaluator_.truth(chosen->conditions[branch], env(state, frame)) && !trouble_.failed())
                ++branch;
        } else {
            std::vector<const Expr*> percentages;
            for (const Expr& percentage : chosen->conditions) percentages.push_back(&percentage);
            branch = evaluator_.draw(percentages, env(state, frame));
        }
        chosen = &chosen->bodies[branch];
    }
    return chosen;
}

void Interpreter::runBody(const Body& body, ShapeState& state, Frame& frame)
{
    const Body& plain = *choose(body, state, frame);
    for (const Statement& statement : plain.statements) {
        if (trouble_.failed() || frame.deleted) return;
        trouble_.spend(statement.place, 1);
        runStatement(statement, state, frame);
    }
}

void Interpreter::runStatement(const Statement& statement, ShapeState& state, Frame& frame)
{
    switch (statement.kind) {
    case StatementKind::Operation:
        return runOperation(statement, state, frame);
    case StatementKind::Push:
        return runPush(statement, state, frame);
    case StatementKind::Rule:
        break;
    }
    std::vector<Value> arguments;
    for (const Size& arg : statement.args) arguments.push_back(evaluator_.evaluate(arg.value, env(state, frame)));
    spawnRule(statement, state, frame, ShapeOp::Rule, arguments);
}

Interpreter::Frame Interpreter::childFrame(Frame& parent, u32 name, ShapeOp op, Place place)
{
    Frame frame;
    frame.node = u32(result_.shapes.size());
    frame.rule = name;
    frame.depth = parent.depth + 1;
    // The tree key is the path of child numbers, so editing one subtree re-rolls only that subtree.
    const u32 number = parent.childCount++;
    frame.seed = mixSeed(parent.seed, number);
    frame.random = Random(mixSeed(frame.seed, name < program_.names.size() ? hashText(program_.names[name]) : 0));
    parent.spawned = true;
    if (frame.depth > kMaxDepth)
        trouble_.fail(place, concat("shapes nest deeper than ", kMaxDepth,
                                    " levels: look for a recursion without end, and end it with case / else"));
    if (frame.node >= kMaxShapes)
        trouble_.fail(place, concat("the building has more than ", kMaxShapes, " shapes: use larger sizes"));
    Shape shape;
    shape.parent = parent.node;
    shape.name = name;
    shape.op = op;
    shape.child = number;
    result_.shapes.push_back(shape);
    return frame;
}

void Interpreter::spawnRule(const Statement& call, const ShapeState& state, Frame& parent, ShapeOp op,
                            std::span<const Value> arguments)
{
    Frame frame = childFrame(parent, call.name, op, call.place);
    if (trouble_.failed()) return;
    frame.outer = state.scope;
    ShapeState end = state;
    if (call.rule != kNoIndex) {
        const Rule& rule = program_.rules[call.rule];
        const std::vector<Value> values = entryValues(rule, arguments, state, frame);
        frame.parameters = values;
        runBody(rule.body, end, frame);
    }
    finish(frame, parent, state, end, call.place);
}

/// A part of a subdivision. A body that only names a rule makes one node of that name, any other an unnamed one.
void Interpreter::spawnPart(const Body& body, ShapeState state, Frame& parent, ShapeOp op, OperationName name)
{
    Frame frame = childFrame(parent, u32(program_.names.size()) + u32(name), op, body.place);
    if (trouble_.failed()) return;
    frame.parameters = parent.parameters;
    frame.outer = state.scope;
    const Body& plain = *choose(body, state, frame);
    const ShapeState start = state;
    if (plain.statements.size() == 1 && plain.statements[0].kind == StatementKind::Rule && !trouble_.failed()) {
        const Statement& call = plain.statements[0];
        std::vector<Value> arguments;
        for (const Size& arg : call.args) arguments.push_back(evaluator_.evaluate(arg.value, env(state, frame)));
        frame.rule = result_.shapes[frame.node].name = call.name;
        frame.random = Random(mixSeed(frame.seed, hashText(program_.names[call.name])));
        if (call.rule != kNoIndex) {
            const Rule& rule = program_.rules[call.rule];
            const std::vector<Value> values = entryValues(rule, arguments, start, frame);
            frame.parameters = values;
            runBody(rule.body, state, frame);
        }
        finish(frame, parent, start, state, call.place);
        return;
    }
    runBody(plain, state, frame);
    finish(frame, parent, start, state, body.place);
}

void Interpreter::runPush(const Statement& statement, const ShapeState& state, Frame& frame)
{
    const bool spawnedBefore = frame.spawned;
    Frame inner =
        childFrame(frame, u32(program_.names.size()) + u32(OperationName::Push), ShapeOp::Group, statement.place);
    if (trouble_.failed()) return;
    inner.parameters = frame.parameters;
    inner.outer = state.scope;
    ShapeState copy = state;
    runBody(statement.body[0], copy, inner);
    frame.spawned = spawnedBefore || inner.spawned;
    inner.spawned = true; // what a push leaves over is dropped, never a leaf
    finish(inner, frame, state, copy, statement.place);
}

/// Ends a node: makes it a leaf if its body named no successor, forgets it if nothing came of it, and adds up areas.
void Interpreter::finish(Frame& frame, Frame& parent, const ShapeState& start, const ShapeState& end, Place place)
{
    if (trouble_.failed()) return;
    const bool leaf = !frame.spawned && !frame.deleted && emitLeaf(end, frame, place);
    if (!leaf && result_.shapes.size() == frame.node + 1) result_.shapes.pop_back();
    if (start.tile && start.intact) {
        const double whole = start.tile->area, tolerance = 1e-3 * whole + 1e-6;
        Covered& covered = frame.covered;
        if (covered.planar > whole + tolerance)
            trouble_.warn(place, concat("'", frame.rule < program_.names.size() ? program_.names[frame.rule] : "split",
                                        "' puts several surfaces into the same place of a face: their area counts "
                                        "twice. Make all but one of them assets that stand in front"));
        covered.planar = std::min(covered.planar, whole);
        covered.overlay = std::min(covered.overlay, whole - covered.planar);
        if (covered.overlay < tolerance) covered.overlay = 0.0;
        if (covered.overlay > 0.0 && result_.shapes.size() > frame.node &&
            result_.shapes[frame.node].op == ShapeOp::Component)
            trouble_.warn(covered.place,
                          "this asset stands in front of its place, with nothing behind it: the face has a hole there. "
                          "Sink it, s('1, '1, d) t(0, 0, -d) i(..), or add a wall beside it");
    }
    parent.covered.planar += frame.covered.planar;
    if (frame.covered.overlay <= 0.0) return;
    if (parent.covered.overlay <= 0.0) parent.covered.place = frame.covered.place;
    parent.covered.overlay += frame.covered.overlay;
}

} // namespace helio::cga
