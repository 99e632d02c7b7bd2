// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/resolve.h"

#include <algorithm>
#include <set>

#include "city/grammar/words.h"

namespace helio::cga {

namespace {

class Resolver
{
public:
    Resolver(Program& program, const BrokenNames& broken, ErrorList& errors)
        : program_(program), broken_(broken), errors_(errors)
    {
    }

    void run()
    {
        for (Global& global : program_.globals) {
            enter(global.scope, global.parameters);
            resolveLocals(global.locals, global.localNames);
            resolve(global.value);
        }
        for (Rule& rule : program_.rules) {
            enter(rule.scope, rule.parameters);
            resolveLocals(rule.locals, rule.localNames);
            resolve(rule.body);
        }
        if (program_.startRule == kNoIndex) {
            const auto lot = program_.ruleIndex.find({"Lot", 0});
            if (lot != program_.ruleIndex.end()) program_.startRule = lot->second;
        } else if (const Rule& start = program_.rules[program_.startRule]; !start.parameters.empty()) {
            fail(start.place, "the start rule must not have parameters");
        }
    }

private:
    void fail(Place place, std::string_view message) { errors_.report(place, message); }

    /// From here on, names are those that a declaration of this scope sees.
    void enter(u32 scope, const std::vector<std::string>& parameters)
    {
        prefix_ = program_.scopes[scope];
        values_.clear();
        for (u32 k = 0; k < parameters.size(); ++k) values_[parameters[k]] = k;
        valueCount_ = u32(parameters.size());
    }

    /// A local sees the parameters and the locals before it.
    void resolveLocals(std::vector<Expr>& locals, const std::vector<std::string>& names)
    {
        for (size_t k = 0; k < locals.size(); ++k) {
            resolve(locals[k]);
            values_[names[k]] = valueCount_++;
        }
    }

    void warnOnce(Place place, const std::string& name, std::string_view message)
    {
        if (warned_.insert(name).second)
            program_.warnings.push_back(errorAt(program_.files[place.file].name, place, message).message);
    }

    // ---- expressions
    void resolve(Expr& expr)
    {
        if (expr.kind != ExprKind::Keyword) {
            for (Expr& arg : expr.args) resolve(arg);
            return;
        }
        const u32 argCount = u32(expr.args.size());
        if (argCount == 0) {
            if (const auto value = values_.find(expr.text); value != values_.end()) {
                expr.kind = ExprKind::Parameter;
                expr.index = value->second;
                return;
            }
        }
        if (const auto global = program_.globalIndex.find({prefix_ + expr.text, argCount});
            global != program_.globalIndex.end()) {
            expr.kind = ExprKind::Global;
            expr.index = global->second;
            for (Expr& arg : expr.args) resolve(arg);
            return;
        }
        if (const auto attribute = findShapeAttribute(expr.text); attribute && argCount == 0) {
            expr.kind = ExprKind::Shape;
            expr.index = u32(*attribute);
            return;
        }
        if (const auto info = findFunction(expr.text)) return resolveFunction(expr, *info);
        if (const std::string_view advice = refusedFunction(expr.text); !advice.empty())
            return fail(expr.place, concat("the function '", expr.text, "' is not supported: ", advice));
        if (broken_.has(prefix_ + expr.text)) return;
        if (const auto count = otherCount(program_.globalIndex, prefix_ + expr.text))
            return fail(expr.place, concat("'", expr.text, "' takes ", *count, " arguments, not ", argCount));
        fail(expr.place, concat("unknown ", argCount > 0 ? "function" : "name", " '", expr.text,
                                "': declare it with attr, const or as a function, or quote it if it is text"));
    }

    void resolveFunction(Expr& expr, const FunctionInfo& info)
    {
        const size_t argCount = expr.args.size();
        if (argCount < info.minArgs || argCount > info.maxArgs)
            return fail(expr.place, concat("'", expr.text, "' takes ", range(info.minArgs, info.maxArgs),
                                           " arguments, not ", argCount));
        expr.kind = ExprKind::Builtin;
        expr.index = u32(info.function);
        if (!info.keywords) {
            for (Expr& arg : expr.args) resolve(arg);
            return;
        }
        if (info.function == Function::GeometryArea) {
            if (argCount == 0) return;
            const auto selector = findSelector(expr.args[0].text);
            if (expr.args[0].kind != ExprKind::Keyword || !selector)
                return fail(expr.args[0].place,
                            "geometry.area() takes no argument, or a selector such as top, bottom, side or all");
            expr.args[0].index = u32(*selector);
            return;
        }
        for (size_t k = 0; k < argCount; ++k) { // touches(inter), inside(inter)
            const std::string& word = expr.args[k].text;
            if (expr.args[k].kind == ExprKind::Keyword && k == 0 && word == "inter") continue;
            return fail(expr.args[k].place,
                        concat("'", expr.text, "' only knows (inter), the walls of other buildings"));
        }
    }

    static std::string range(u32 low, u32 high)
    {
        if (low == high) return concat(low);
        return high > 50 ? concat("at least ", low) : concat(low, " to ", high);
    }

    /// The number of parameters of anything of this name.
    static std::optional<u32> otherCount(const std::map<std::pair<std::string, u32>, u32>& index,
                                         const std::string& name)
    {
        const auto found = index.lower_bound({name, 0});
        if (found == index.end() || found->first.first != name) return {};
        return found->first.second;
    }

    // ---- statements
    void resolve(Body& body)
    {
        for (Expr& condition : body.conditions) resolve(condition);
        for (Body& inner : body.bodies) resolve(inner);
        for (Statement& statement : body.statements) {
            if (statement.kind == StatementKind::Push)
                resolve(statement.body[0]);
            else
                resolveCall(statement);
        }
    }

    void resolveCall(Statement& statement)
    {
        const std::string name = program_.names[statement.name];
        const u32 argCount = u32(statement.args.size());
        if (const auto info = findOperation(name)) return resolveOperation(statement, name, *info);
        if (const std::string_view advice = refusedFunction(name); !advice.empty() && !isRule(name, argCount))
            return fail(statement.place, concat("the function '", name, "' is not supported: ", advice));
        for (Size& arg : statement.args) {
            resolve(arg.value);
            if (arg.kind != SizeKind::Absolute)
                fail(arg.value.place, concat(kWhereSizes, ": a rule takes plain values"));
        }
        if (statement.block)
            return fail(statement.place, concat("unknown operation '", name,
                                                "': a block { .. } belongs to split, comp, setback, setbackPerEdge, "
                                                "innerRectangle, shapeL, shapeU, shapeO and scatter, not to a rule"));
        statement.kind = StatementKind::Rule;
        if (const auto rule = program_.ruleIndex.find({prefix_ + name, argCount}); rule != program_.ruleIndex.end()) {
            statement.rule = rule->second;
            statement.name = program_.rules[rule->second].name;
            return;
        }
        if (broken_.has(prefix_ + name)) return;
        if (const auto count = otherCount(program_.ruleIndex, prefix_ + name))
            return fail(statement.place, concat("rule '", name, "' takes ", *count, " arguments, not ", argCount));
        if (isFunction(name, argCount))
            return fail(statement.place,
                        concat("'", name, "' is a function: use it in a value, as in s(", name, "(..), 1, 1)"));
        if (argCount > 0)
            return fail(statement.place,
                        concat("unknown operation or rule '", name, "': city/README.md lists what is read"));
        if (name.back() != '.') {
            warnOnce(statement.place, name,
                     concat("rule '", name, "' is not declared: its shapes stay as they are (write '", name,
                            ".' if that is meant)"));
            return;
        }
        statement.name = terminal(name.substr(0, name.size() - 1));
    }

    bool isRule(const std::string& name, u32 argCount) const
    {
        return program_.ruleIndex.count({prefix_ + name, argCount}) > 0;
    }

    /// A function of the language that can take so many arguments, or one of the file's own.
    bool isFunction(const std::string& name, u32 argCount) const
    {
        if (const auto info = findFunction(name)) return argCount > 0 || info->minArgs == 0;
        const auto own = program_.globalIndex.find({prefix_ + name, argCount});
        return own != program_.globalIndex.end() && program_.globals[own->second].kind == GlobalKind::Function;
    }

    u32 terminal(const std::string& name)
    {
        if (nameIndex_.empty())
            for (u32 k = 0; k < program_.names.size(); ++k) nameIndex_.emplace(program_.names[k], k);
        const auto [it, added] = nameIndex_.emplace(name, u32(program_.names.size()));
        if (added) program_.names.push_back(name);
        return it->second;
    }

    void resolveOperation(Statement& statement, const std::string& name, const OperationInfo& info)
    {
        statement.op = info.op;
        if (info.op == Operation::Ignored) {
            warnOnce(statement.place, name == "label" ? "label" : "texture",
                     name == "label"
                         ? concat("'label' is read and ignored: touches(inter) asks about all neighbours")
                         : concat("'", name, "' and other texture operations are read and ignored: surfaces ",
                                  "have one colour"));
            statement.args.clear();
            return;
        }
        const size_t argCount = statement.args.size();
        if (argCount < info.minArgs || argCount > info.maxArgs)
            return fail(statement.place, concat("'", name, "' takes ", range(info.minArgs, info.maxArgs),
                                                " arguments, not ", argCount, ": write ", info.usage));
        if (info.hasBlock != (statement.block != nullptr || !statement.body.empty()))
            return fail(statement.place,
                        concat(info.hasBlock ? "a block { .. } is missing after '" : "no block { .. } belongs after '",
                               name, "': write ", info.usage));
        if (info.op == Operation::Set && argCount > 0) { // words.cpp looks the attribute up without a scope
            std::string& word = statement.args[0].value.text;
            if (program_.globalIndex.count({prefix_ + word, 0}) > 0) word = prefix_ + word;
        }
        const WordsResult words = resolveWords(statement, program_);
        if (words.error) return fail(words.place, *words.error);
        if (!words.ignored.empty())
            warnOnce(statement.place, words.ignored,
                     concat(words.ignored, " is read and ignored: surfaces have a colour, a name and an emission"));
        for (Size& arg : statement.args) {
            resolve(arg.value);
            const bool sizes = info.op == Operation::Resize || info.op == Operation::Translate ||
                               (info.op == Operation::Scatter && &arg != &statement.args[0]);
            if (arg.kind == SizeKind::Floating || (arg.kind == SizeKind::Relative && !sizes))
                fail(arg.value.place, concat(kWhereSizes, ", not to '", name, "'"));
        }
        if (statement.block) resolveBlock(*statement.block, info.op);
        for (Body& body : statement.body) resolve(body);
    }

    void resolveBlock(Block& block, Operation op)
    {
        if (op != Operation::Split && block.repeat)
            fail(block.elements.empty() ? Place{} : block.elements[0].place, "only split repeats its block with '*'");
        for (BlockElement& element : block.elements) {
            if (element.nested) {
                resolveBlock(*element.nested, op);
                continue;
            }
            if (op == Operation::Split) resolve(element.size.value);
            resolve(element.body);
        }
    }

    static constexpr std::string_view kWhereSizes =
        "' (relative to the scope) belongs to sizes of s, t, scatter and split, ~ to those of split";

    Program& program_;
    const BrokenNames& broken_;
    ErrorList& errors_;
    std::string prefix_;                ///< of the names that the declaration at hand sees
    std::map<std::string, u32> values_; ///< its parameters and locals
    u32 valueCount_ = 0;
    std::map<std::string, u32> nameIndex_;
    std::set<std::string> warned_;
};

} // namespace

bool BrokenNames::has(const std::string& name) const
{
    if (unknown || names.count(name) > 0) return true;
    for (size_t dot = name.find('.'); dot != std::string::npos && !prefixes.empty(); dot = name.find('.', dot + 1))
        if (prefixes.count(name.substr(0, dot + 1)) > 0) return true;
    return false;
}

void resolveProgram(Program& program, const BrokenNames& broken, ErrorList& errors)
{
    Resolver(program, broken, errors).run();
}

} // namespace helio::cga
