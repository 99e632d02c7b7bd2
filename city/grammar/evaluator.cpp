// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/evaluator.h"

#include <cmath>

#include "city/grammar/placement.h"

namespace helio::cga {

namespace {

constexpr u32 kMaxEvaluations = 2000; ///< within each other, over all called functions

/// Counts nesting for as long as it lives.
struct Nest
{
    explicit Nest(u32& counter) : count(counter) { ++count; }
    ~Nest() { --count; }
    Nest(const Nest&) = delete;
    Nest& operator=(const Nest&) = delete;
    u32& count;
};

} // namespace

Evaluator::Evaluator(const Program& program, const Footprint& footprint, const DeriveOptions& options,
                     const Occlusion& occlusion, u64 seed, Trouble& trouble)
    : program_(program), footprint_(footprint), options_(options), occlusion_(occlusion), seed_(seed),
      trouble_(trouble), progress_(program.globals.size(), Progress::None), values_(program.globals.size())
{
}

double Evaluator::number(const Expr& expr, const Env& env)
{
    if (expr.kind == ExprKind::Number) return expr.number;
    const Value value = evaluate(expr, env);
    if (const double* number = std::get_if<double>(&value)) return *number;
    trouble_.fail(expr.place, concat("a number is needed here, but the value is ", kindOf(value)));
    return 0.0;
}

bool Evaluator::truth(const Expr& expr, const Env& env)
{
    const Value value = evaluate(expr, env);
    if (const bool* truth = std::get_if<bool>(&value)) return *truth;
    trouble_.fail(expr.place, concat("true or false is needed here, but the value is ", kindOf(value)));
    return false;
}

std::string Evaluator::text(const Expr& expr, const Env& env)
{
    const Value value = evaluate(expr, env);
    if (const std::string* text = std::get_if<std::string>(&value)) return *text;
    trouble_.fail(expr.place, concat("text is needed here, but the value is ", kindOf(value)));
    return {};
}

Value Evaluator::finite(double value, const Expr& expr, std::string_view what)
{
    if (std::isfinite(value)) return value;
    trouble_.fail(expr.place, concat(what, " gives no finite number"));
    return 0.0;
}

Value Evaluator::evaluate(const Expr& expr, const Env& env)
{
    if (trouble_.failed()) return 0.0;
    Nest nest(depth_);
    trouble_.spend(expr.place, 1);
    if (depth_ > kMaxEvaluations)
        trouble_.fail(expr.place, "functions call each other too deeply: look for a recursion without end");
    if (trouble_.failed()) return 0.0;
    switch (expr.kind) {
    case ExprKind::Number:
        return expr.number;
    case ExprKind::Text:
        return charged(expr.text, expr.place);
    case ExprKind::Bool:
        return expr.number != 0.0;
    case ExprKind::Parameter:
        return charged(env.parameters[expr.index], expr.place);
    case ExprKind::Global:
        return charged(evaluateGlobal(expr, env), expr.place);
    case ExprKind::Builtin:
        return charged(callBuiltin(expr, env), expr.place);
    case ExprKind::Shape:
        return evaluateShape(ShapeAttribute(expr.index), env);
    case ExprKind::Negate:
        return -number(expr.args[0], env);
    case ExprKind::Not:
        return !truth(expr.args[0], env);
    case ExprKind::Binary:
        return charged(evaluateBinary(expr, env), expr.place);
    case ExprKind::Cases:
    case ExprKind::Percent:
        return evaluateChoice(expr, env);
    case ExprKind::Keyword:
        break;
    }
    HELIO_CHECK(false, "unresolved name ", expr.text);
}

/// Charges what copying and comparing a text costs.
Value Evaluator::charged(Value value, Place place)
{
    if (const std::string* text = std::get_if<std::string>(&value)) trouble_.spend(place, text->size() / 64);
    return value;
}

Value Evaluator::evaluateChoice(const Expr& expr, const Env& env)
{
    const size_t branchCount = expr.args.size() / 2;
    if (expr.kind == ExprKind::Cases) {
        for (size_t k = 0; k < branchCount; ++k)
            if (truth(expr.args[2 * k], env) || trouble_.failed()) return evaluate(expr.args[2 * k + 1], env);
        return evaluate(expr.args.back(), env);
    }
    std::vector<const Expr*> percentages;
    for (size_t k = 0; k < branchCount; ++k) percentages.push_back(&expr.args[2 * k]);
    const size_t chosen = draw(percentages, env);
    return evaluate(chosen < branchCount ? expr.args[2 * chosen + 1] : expr.args.back(), env);
}

size_t Evaluator::draw(std::span<const Expr* const> percentages, const Env& env)
{
    const double u = env.random->uniform() * 100.0;
    double sum = 0.0;
    size_t chosen = percentages.size();
    for (size_t k = 0; k < percentages.size(); ++k) {
        const double percentage = number(*percentages[k], env);
        if (!(percentage >= 0.0))
            trouble_.fail(percentages[k]->place, concat("a percentage must not be negative: ", percentage));
        sum += percentage;
        if (chosen == percentages.size() && u < sum) chosen = k;
    }
    if (sum > 100.0 + 1e-6)
        trouble_.fail(percentages[0]->place, concat("the percentages add up to ", sum, ", more than 100"));
    return chosen;
}

Value Evaluator::evaluateGlobal(const Expr& expr, const Env& env)
{
    const Global& global = program_.globals[expr.index];
    if (global.kind != GlobalKind::Function) {
        if (env.shape->attributes) {
            const auto set = env.shape->attributes->find(expr.index);
            if (set != env.shape->attributes->end()) return set->second;
        }
        return globalValue(expr.index);
    }
    std::vector<Value> arguments;
    for (const Expr& arg : expr.args) arguments.push_back(evaluate(arg, env));
    Nest nest(calls_);
    if (calls_ > kMaxDepth)
        trouble_.fail(expr.place, concat("functions call each other deeper than ", kMaxDepth,
                                         " levels: look for a recursion without end in '", global.name, "'"));
    return globalBody(global, std::move(arguments), env);
}

/// The value of a global whose arguments are known, with its locals.
Value Evaluator::globalBody(const Global& global, std::vector<Value> parameters, const Env& env)
{
    parameters.reserve(parameters.size() + global.locals.size()); // what has been computed must not move
    const auto inner = [&] { return Env{env.shape, std::span<const Value>(parameters), env.random}; };
    for (const Expr& local : global.locals) parameters.push_back(evaluate(local, inner()));
    return evaluate(global.value, inner());
}

Value Evaluator::globalValue(u32 index)
{
    const Global& global = program_.globals[index];
    if (progress_[index] == Progress::Done) return values_[index];
    if (progress_[index] == Progress::Running) {
        trouble_.fail(global.place, concat("the value of '", global.name, "' depends on itself"));
        return 0.0;
    }
    progress_[index] = Progress::Running;
    // A stream of its own: drawing in one attribute must not change the others.
    Random random(mixSeed(seed_, hashText(global.name)));
    Value value = globalBody(global, {}, {&initial_, {}, &random});
    values_[index] = global.kind == GlobalKind::Attribute ? attributeValue(global, std::move(value)) : std::move(value);
    progress_[index] = Progress::Done;
    return values_[index];
}

/// The user's value of an attribute if there is one of the same kind (or one that reads as such), else the rule's own.
Value Evaluator::attributeValue(const Global& global, Value value)
{
    const Value* given = nullptr;
    const Value height = footprint_.height, id = footprint_.id;
    const auto option = options_.attributes.find(global.name);
    const auto property = footprint_.attributes.find(global.property);
    if (option != options_.attributes.end())
        given = &option->second;
    else if (global.property == "height" && footprint_.height > 0.0)
        given = &height;
    else if (property != footprint_.attributes.end())
        given = &property->second;
    else if (global.property == "id" && !footprint_.id.empty())
        given = &id;
    if (!given) return value;
    checkRange(global, *given);
    if (given->index() == value.index()) return *given;
    if (std::holds_alternative<std::string>(value)) return toText(*given);
    if (const std::string* text = std::get_if<std::string>(given)) {
        if (std::holds_alternative<bool>(value) && (*text == "true" || *text == "false")) return *text == "true";
        if (const auto number = toNumber(*text); number && std::holds_alternative<double>(value)) return *number;
    }
    if (const double* number = std::get_if<double>(given); number && std::holds_alternative<bool>(value))
        return *number != 0.0;
    trouble_.warn(global.place, concat("attribute '", global.name, "' is ", kindOf(value),
                                       "; values of features that are ", kindOf(*given), " are not used"));
    return value;
}

/// A given value outside the rule file's @Range is used, with a warning.
void Evaluator::checkRange(const Global& global, const Value& value)
{
    const double* number = std::get_if<double>(&value);
    if (!number) return;
    for (const Annotation& annotation : global.annotations) {
        if (annotation.name != "Range") continue;
        size_t place = 0;
        std::optional<double> low, high;
        for (const Annotation::Argument& argument : annotation.arguments) {
            // @Range(min=3, max=14), or by place: @Range(3, 14)
            if (argument.key == "min" || (argument.key.empty() && place == 0)) low = argument.number;
            if (argument.key == "max" || (argument.key.empty() && place == 1)) high = argument.number;
            ++place;
        }
        if ((low && *number < *low) || (high && *number > *high))
            trouble_.warnOnce(global.place, concat("attribute '", global.name, "' is outside its range"),
                              concat(": ", *number, " of building '", footprint_.id, "'"));
    }
}

Value Evaluator::evaluateBinary(const Expr& expr, const Env& env)
{
    const auto op = BinaryOp(expr.index);
    if (op == BinaryOp::Or) return truth(expr.args[0], env) || truth(expr.args[1], env);
    if (op == BinaryOp::And) return truth(expr.args[0], env) && truth(expr.args[1], env);
    const Value a = evaluate(expr.args[0], env), b = evaluate(expr.args[1], env);
    if (trouble_.failed()) return 0.0;
    const bool texts = std::holds_alternative<std::string>(a) || std::holds_alternative<std::string>(b);
    if (op == BinaryOp::Add && texts) {
        std::string joined = toText(a) + toText(b);
        if (joined.size() > kMaxTextBytes)
            trouble_.fail(expr.place, concat("text longer than ", kMaxTextBytes, " bytes"));
        return joined;
    }
    if (op == BinaryOp::Equal || op == BinaryOp::NotEqual) {
        if (a.index() != b.index())
            trouble_.fail(expr.place, concat("cannot compare ", kindOf(a), " with ", kindOf(b)));
        return (a == b) == (op == BinaryOp::Equal);
    }
    const double *x = std::get_if<double>(&a), *y = std::get_if<double>(&b);
    if (!x || !y) {
        trouble_.fail(expr.place,
                      concat("this needs numbers on both sides, but they are ", kindOf(a), " and ", kindOf(b)));
        return 0.0;
    }
    switch (op) {
    case BinaryOp::Less:
        return *x < *y;
    case BinaryOp::Greater:
        return *x > *y;
    case BinaryOp::LessEqual:
        return *x <= *y;
    case BinaryOp::GreaterEqual:
        return *x >= *y;
    case BinaryOp::Add:
        return finite(*x + *y, expr, "the sum");
    case BinaryOp::Subtract:
        return finite(*x - *y, expr, "the difference");
    case BinaryOp::Multiply:
        return finite(*x * *y, expr, "the product");
    case BinaryOp::Divide:
        return finite(*x / *y, expr, concat("the division by ", *y));
    case BinaryOp::Modulo:
        return finite(std::fmod(*x, *y), expr, concat("the remainder by ", *y));
    default:
        break;
    }
    HELIO_CHECK(false, "operator ", expr.index);
}

Value Evaluator::evaluateShape(ShapeAttribute attribute, const Env& env) const
{
    const ShapeState& shape = *env.shape;
    const Scope& scope = shape.scope;
    const glm::dmat3 fromPivot = glm::transpose(shape.pivotAxes);
    const auto index = [&](ShapeAttribute first) { return int(attribute) - int(first); };
    switch (attribute) {
    case ShapeAttribute::ScopeSx:
    case ShapeAttribute::ScopeSy:
    case ShapeAttribute::ScopeSz:
        return shape.signedSize()[index(ShapeAttribute::ScopeSx)];
    case ShapeAttribute::ScopeTx:
    case ShapeAttribute::ScopeTy:
    case ShapeAttribute::ScopeTz:
        return (fromPivot * (scope.toWorld(shape.localOrigin()) - shape.pivot))[index(ShapeAttribute::ScopeTx)];
    case ShapeAttribute::ScopeRx:
    case ShapeAttribute::ScopeRy:
    case ShapeAttribute::ScopeRz:
        return anglesOf(fromPivot * scope.axes)[index(ShapeAttribute::ScopeRx)];
    case ShapeAttribute::ScopeElevation:
        return footprint_.base + scope.toWorld(shape.localOrigin()).y;
    case ShapeAttribute::SplitIndex:
        return shape.splitIndex;
    case ShapeAttribute::SplitTotal:
        return shape.splitTotal;
    case ShapeAttribute::CompIndex:
        return shape.compIndex;
    case ShapeAttribute::CompTotal:
        return shape.compTotal;
    case ShapeAttribute::CompSel:
        return std::string(shape.compSelector);
    case ShapeAttribute::Seedian:
        return shape.seedian.value_or(double(seed_ & 0xFFFFFFFFu));
    case ShapeAttribute::InitialShapeName:
        return footprint_.id;
    case ShapeAttribute::InitialShapeOriginPx:
        return footprintCorner(footprint_).x + initial_.scope.origin.x;
    case ShapeAttribute::InitialShapeOriginPy:
        return footprint_.base + initial_.scope.origin.y;
    case ShapeAttribute::InitialShapeOriginPz:
        return initial_.scope.origin.z - footprintCorner(footprint_).y;
    case ShapeAttribute::InitialShapeOriginOx:
    case ShapeAttribute::InitialShapeOriginOy:
    case ShapeAttribute::InitialShapeOriginOz:
        return anglesOf(initial_.scope.axes)[index(ShapeAttribute::InitialShapeOriginOx)];
    case ShapeAttribute::ColorR:
    case ShapeAttribute::ColorG:
    case ShapeAttribute::ColorB:
        return shape.look.color.value_or(glm::dvec3(1.0))[index(ShapeAttribute::ColorR)];
    case ShapeAttribute::ColorRgb:
        return formatColor(shape.look.color.value_or(glm::dvec3(1.0)));
    case ShapeAttribute::MaterialName:
        return shape.look.material;
    case ShapeAttribute::EmissiveR:
    case ShapeAttribute::EmissiveG:
    case ShapeAttribute::EmissiveB:
        return shape.look.emissive[index(ShapeAttribute::EmissiveR)];
    case ShapeAttribute::Opacity:
        return shape.look.opacity;
    case ShapeAttribute::TrimVertical:
        return shape.trimVertical;
    case ShapeAttribute::TrimHorizontal:
        return shape.trimHorizontal;
    }
    HELIO_CHECK(false, "shape attribute ", int(attribute));
}

} // namespace helio::cga
