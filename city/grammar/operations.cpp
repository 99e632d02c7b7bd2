// SPDX-License-Identifier: Apache-2.0
// Which operation is carried out where, and what they share.
#include <cmath>

#include "city/grammar/interpreter.h"

namespace helio::cga {

namespace {

constexpr u32 kMaxPrints = 20; ///< lines that one building may print

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
        if (arg.kind == SizeKind::Relative) v[k] *= state.signedSize()[k];
    }
    return v;
}

/// Three truth values, one an axis.
glm::bvec3 Interpreter::axisArgs(const Statement& statement, const ShapeState& state, Frame& frame)
{
    glm::bvec3 v(false);
    for (int k = 0; k < 3; ++k) v[k] = evaluator_.truth(statement.args[size_t(k)].value, env(state, frame));
    return v;
}

/// Fails where an operation on geometry meets an asset.
bool Interpreter::refuseAfterInsert(const Statement& statement, const ShapeState& state)
{
    if (state.asset)
        trouble_.fail(statement.place, concat(program_.names[statement.name],
                                              " belongs before i(..): an inserted asset ", "keeps its own geometry"));
    return state.asset != nullptr;
}

/// Gives a shape other geometry in the same place: it is no longer the piece of a face that it was.
void Interpreter::replaceShape(ShapeState& state, Geometry geometry)
{
    state.geometry = std::make_shared<const Geometry>(std::move(geometry));
    state.tile = nullptr;
    state.intact = state.footprint = false;
}

void Interpreter::runOperation(const Statement& statement, ShapeState& state, Frame& frame)
{
    switch (statement.op) {
    case Operation::Nil:
        frame.deleted = true;
        return;
    case Operation::Ignored:
        return;
    case Operation::Report:
        return report(statement, state, frame);
    case Operation::Print:
        return print(statement, state, frame);
    case Operation::Translate:
    case Operation::TranslateIn:
        return translate(statement, state, frame);
    case Operation::Resize:
        return resize(statement, state, frame);
    case Operation::Rotate:
    case Operation::RotateIn:
        return rotate(statement, state, frame);
    case Operation::RotateScope:
        return rotateScope(statement, state, frame);
    case Operation::Center:
        return center(statement, state, frame);
    case Operation::MirrorScope:
        return mirrorScope(statement, state, frame);
    case Operation::SetPivot:
        return setPivot(statement, state, frame);
    case Operation::AlignScopeToAxes:
        return alignToAxes(statement, state);
    case Operation::AlignScopeToGeometry:
        return alignToGeometry(statement, state, frame);
    case Operation::AlignScopeToGeometryBBox:
        return alignToBounds(statement, state);
    case Operation::Color:
        return setColor(statement, state, frame);
    case Operation::Set:
        return set(statement, state, frame);
    case Operation::Extrude:
        return extrudeShape(statement, state, frame);
    case Operation::Mirror:
        return mirror(statement, state, frame);
    case Operation::ReverseNormals:
        return reverseNormals(statement, state);
    case Operation::CleanupGeometry:
        return cleanup(statement, state, frame);
    case Operation::DeleteHoles:
        return deleteHoles(statement, state);
    case Operation::PrimitiveCone:
    case Operation::PrimitiveCube:
    case Operation::PrimitiveCylinder:
    case Operation::PrimitiveDisk:
    case Operation::PrimitiveQuad:
    case Operation::PrimitiveSphere:
        return primitive(statement, state, frame);
    case Operation::Insert:
        return insertAsset(statement, state, frame);
    case Operation::Scatter:
        return scatter(statement, state, frame);
    case Operation::Split:
        return split(statement, state, frame);
    case Operation::Component:
        return components(statement, state, frame);
    case Operation::RoofGable:
    case Operation::RoofHip:
    case Operation::RoofPyramid:
    case Operation::RoofShed:
    case Operation::Taper:
        return roof(statement, state, frame);
    case Operation::Offset:
        return offsetFaces(statement, state, frame);
    case Operation::Setback:
    case Operation::SetbackPerEdge:
        return setback(statement, state, frame);
    case Operation::ShapeL:
    case Operation::ShapeO:
    case Operation::ShapeU:
        return wings(statement, state, frame);
    case Operation::InnerRectangle:
        return innerRectangle(statement, state, frame);
    case Operation::InnerRect:
        return innerRect(statement, state);
    case Operation::Trim:
        return trim(statement, state);
    }
}

void Interpreter::report(const Statement& statement, const ShapeState& state, Frame& frame)
{
    const std::string key = evaluator_.text(statement.args[0].value, env(state, frame));
    const Value value = evaluator_.evaluate(statement.args[1].value, env(state, frame));
    if (const bool* truth = std::get_if<bool>(&value))
        result_.reports[key] += *truth ? 1.0 : 0.0;
    else if (const double* number = std::get_if<double>(&value))
        result_.reports[key] += *number;
    else
        trouble_.fail(statement.place, "report sums numbers: its second argument must not be text");
}

/// print(value): a line among the warnings, every text once.
void Interpreter::print(const Statement& statement, const ShapeState& state, Frame& frame)
{
    const std::string text = toText(evaluator_.evaluate(statement.args[0].value, env(state, frame)));
    if (trouble_.failed() || printCount_ > kMaxPrints) return;
    ++printCount_;
    trouble_.warn(statement.place, printCount_ <= kMaxPrints ? concat("print: ", text)
                                                             : concat("print: more than ", kMaxPrints,
                                                                      " lines of one building are left out"));
}

} // namespace helio::cga
