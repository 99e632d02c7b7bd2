// SPDX-License-Identifier: Apache-2.0
// The built-in functions of Evaluator: chance and arithmetic. Angles are degrees, as in the language.
#include <algorithm>
#include <cmath>

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
    case Function::Overlaps:
    case Function::Touches:
        return callOcclusion(expr, env);
    case Function::Bool:
    case Function::Count:
    case Function::Find:
    case Function::Float:
    case Function::Int:
    case Function::Len:
    case Function::Replace:
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
    case Function::IsInf: // no value is ever infinite or not a number: what would give one is an error where it arises
    case Function::IsNan:
        return false;
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

} // namespace helio::cga
