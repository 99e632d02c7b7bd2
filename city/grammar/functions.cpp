// SPDX-License-Identifier: Apache-2.0
// The built-in functions of Evaluator. Angles are degrees, as in the language.
#include <algorithm>
#include <cmath>

#include "city/grammar/component.h"
#include "city/grammar/evaluator.h"

namespace helio::cga {

namespace {

constexpr double kRadians = M_PI / 180.0;

} // namespace

Value Evaluator::callBuiltin(const Expr& expr, const Env& env)
{
    const auto function = Function(expr.index);
    switch (function) {
    case Function::P:
        return env.random->uniform() < number(expr.args[0], env);
    case Function::Rand: {
        const double low = expr.args.size() == 2 ? number(expr.args[0], env) : 0.0;
        const double high = expr.args.empty() ? 1.0 : number(expr.args.back(), env);
        return finite(low + (high - low) * env.random->uniform(), expr, "rand");
    }
    case Function::Inside:
    case Function::Touches:
        return isCovered(*env.shape);
    case Function::Bool:
    case Function::Count:
    case Function::Find:
    case Function::Float:
    case Function::Len:
    case Function::Rgb:
    case Function::Str:
    case Function::Substring:
        return callText(expr, env);
    default:
        break;
    }
    return function >= Function::GeometryArea ? callGeometry(expr, env) : callMath(expr, env);
}

Value Evaluator::callMath(const Expr& expr, const Env& env)
{
    std::vector<double> v;
    for (const Expr& arg : expr.args) v.push_back(number(arg, env));
    if (trouble_.failed()) return 0.0;
    switch (Function(expr.index)) {
    case Function::Abs:
        return std::abs(v[0]);
    case Function::Acos:
        return finite(std::acos(v[0]) / kRadians, expr, "acos");
    case Function::Asin:
        return finite(std::asin(v[0]) / kRadians, expr, "asin");
    case Function::Atan:
        return std::atan(v[0]) / kRadians;
    case Function::Atan2:
        return std::atan2(v[0], v[1]) / kRadians;
    case Function::Ceil:
        return std::ceil(v[0]);
    case Function::Clamp:
        return std::min(std::max(v[0], v[1]), v[2]);
    case Function::Cos:
        return std::cos(v[0] * kRadians);
    case Function::Exp:
        return finite(std::exp(v[0]), expr, "exp");
    case Function::Floor:
        return std::floor(v[0]);
    case Function::Ln:
        return finite(std::log(v[0]), expr, "ln");
    case Function::Log10:
        return finite(std::log10(v[0]), expr, "log10");
    case Function::Max:
        return *std::max_element(v.begin(), v.end());
    case Function::Min:
        return *std::min_element(v.begin(), v.end());
    case Function::Pow:
        return finite(std::pow(v[0], v[1]), expr, "pow");
    case Function::Rint:
        return std::nearbyint(v[0]); // halves to the even number
    case Function::Sin:
        return std::sin(v[0] * kRadians);
    case Function::Sqrt:
        return finite(std::sqrt(v[0]), expr, "sqrt");
    case Function::Tan:
        return finite(std::tan(v[0] * kRadians), expr, "tan");
    default:
        break;
    }
    HELIO_CHECK(false, "function ", expr.index);
}

Value Evaluator::callText(const Expr& expr, const Env& env)
{
    switch (Function(expr.index)) {
    case Function::Bool: {
        const Value value = evaluate(expr.args[0], env);
        if (const double* number = std::get_if<double>(&value)) return *number != 0.0;
        if (const bool* truth = std::get_if<bool>(&value)) return *truth;
        return std::get<std::string>(value) == "true" || std::get<std::string>(value) == "1";
    }
    case Function::Float: {
        const Value value = evaluate(expr.args[0], env);
        if (const double* number = std::get_if<double>(&value)) return *number;
        if (const bool* truth = std::get_if<bool>(&value)) return *truth ? 1.0 : 0.0;
        const auto number = toNumber(std::get<std::string>(value));
        if (!number)
            trouble_.fail(expr.place, concat("float cannot read '", std::get<std::string>(value), "' as a number"));
        return number.value_or(0.0);
    }
    case Function::Str:
        return toText(evaluate(expr.args[0], env));
    case Function::Len:
        return double(text(expr.args[0], env).size());
    case Function::Count: {
        const std::string all = text(expr.args[0], env), part = text(expr.args[1], env);
        double count = 0.0;
        if (part.empty()) return count;
        for (size_t at = all.find(part); at != std::string::npos; at = all.find(part, at + part.size())) ++count;
        return count;
    }
    case Function::Find: { // find(text, part [, which]): place of the which-th occurrence (from 0), -1 if there is none
        const std::string all = text(expr.args[0], env), part = text(expr.args[1], env);
        double which = expr.args.size() > 2 ? number(expr.args[2], env) : 0.0;
        size_t at = all.find(part);
        for (; at != std::string::npos && which >= 1.0; --which) at = all.find(part, at + 1);
        return at == std::string::npos ? -1.0 : double(at);
    }
    case Function::Substring: { // from begin up to end (excluded), both clamped to the text
        const std::string all = text(expr.args[0], env);
        const double size = double(all.size());
        const double begin = std::clamp(std::floor(number(expr.args[1], env)), 0.0, size),
                     end = std::clamp(std::floor(number(expr.args[2], env)), begin, size);
        return all.substr(size_t(begin), size_t(end - begin));
    }
    case Function::Rgb:
        return formatColor({number(expr.args[0], env), number(expr.args[1], env), number(expr.args[2], env)});
    default:
        break;
    }
    HELIO_CHECK(false, "function ", expr.index);
}

Value Evaluator::callGeometry(const Expr& expr, const Env& env)
{
    const ShapeState& shape = *env.shape;
    const Geometry& geometry = *shape.geometry;
    trouble_.spend(expr.place, cornerCount(geometry));
    switch (Function(expr.index)) {
    case Function::GeometryArea: {
        if (expr.args.empty()) return area(geometry);
        const auto selector = Selector(expr.args[0].index);
        const SelectorFrame frame = frameOf(selector);
        const glm::dmat3 turn = frame == SelectorFrame::Scope ? glm::dmat3(1.0)
                                : frame == SelectorFrame::World
                                    ? shape.scope.axes
                                    : glm::transpose(initial_.scope.axes) * shape.scope.axes;
        double sum = 0.0;
        for (const Face& face : geometry.faces)
            if (selects(selector, turn * unitNormal(face.polygon))) sum += area(face.polygon);
        return sum;
    }
    case Function::GeometryHeight: {
        double low = INFINITY, high = -INFINITY;
        for (const Face& face : geometry.faces)
            for (const glm::dvec3& p : face.polygon.outer) {
                const double y = shape.scope.toWorld(p).y;
                low = std::min(low, y);
                high = std::max(high, y);
            }
        return std::max(0.0, high - low);
    }
    case Function::GeometryIsConcave:
        return isConcave(geometry);
    case Function::GeometryIsPlanar:
        return isPlanar(geometry);
    case Function::GeometryIsRectangular:
        return isRectangular(geometry, expr.args.empty() ? 1.0 : number(expr.args[0], env));
    case Function::GeometryNEdges: // edges of a closed solid are shared by two faces
        return double(cornerCount(geometry)) / (geometry.closed ? 2.0 : 1.0);
    case Function::GeometryNFaces:
        return double(geometry.faces.size());
    case Function::GeometryNVertices: // Euler's formula for a closed solid without tunnels
        return geometry.closed ? double(cornerCount(geometry)) / 2.0 + 2.0 - double(geometry.faces.size())
                               : double(cornerCount(geometry));
    case Function::GeometryVolume:
        return volume(geometry);
    default:
        break;
    }
    HELIO_CHECK(false, "function ", expr.index);
}

/// A face counts as covered when a neighbour's wall reaches up to the middle of it, on the footprint's edge that it
/// stands on.
bool Evaluator::isCovered(const ShapeState& shape) const
{
    if (shape.edge >= footprint_.coveredHeight.size()) return false;
    double low = INFINITY, high = -INFINITY;
    for (const Face& face : shape.geometry->faces)
        for (const glm::dvec3& p : face.polygon.outer) {
            const double y = shape.scope.toWorld(p).y;
            low = std::min(low, y);
            high = std::max(high, y);
        }
    return footprint_.coveredHeight[shape.edge] >= 0.5 * (low + high);
}

} // namespace helio::cga
