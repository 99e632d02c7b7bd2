// SPDX-License-Identifier: Apache-2.0
// The built-in functions of Evaluator on text, and between kinds of values.
#include <algorithm>
#include <cmath>

#include "city/grammar/evaluator.h"

namespace helio::cga {

namespace {

/// Steps that looking for a text in another is charged: at worst every place is compared over the whole length.
u64 searchWork(const std::string& all, const std::string& part)
{
    return u64(all.size()) * (1 + part.size()) / 64;
}

} // namespace

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
    case Function::Int: { // towards zero
        const Value value = evaluate(expr.args[0], env);
        const double* number = std::get_if<double>(&value);
        const std::string* text = std::get_if<std::string>(&value);
        const auto read = text ? toNumber(*text) : std::optional<double>();
        if (text && !read) trouble_.fail(expr.place, concat("int cannot read '", *text, "' as a number"));
        if (number) return std::trunc(*number);
        return text ? std::trunc(read.value_or(0.0)) : std::get<bool>(value) ? 1.0 : 0.0;
    }
    case Function::Replace: { // replace(text, part, by): every occurrence, from left to right
        const std::string all = text(expr.args[0], env), part = text(expr.args[1], env), by = text(expr.args[2], env);
        if (part.empty()) return all;
        trouble_.spend(expr.place, searchWork(all, part));
        if (trouble_.failed()) return all;
        std::string result;
        size_t from = 0;
        for (size_t at = all.find(part); at != std::string::npos; at = all.find(part, from)) {
            result.append(all, from, at - from).append(by);
            from = at + part.size();
            if (result.size() <= kMaxTextBytes) continue;
            trouble_.fail(expr.place, concat("text longer than ", kMaxTextBytes, " bytes"));
            return result;
        }
        return result.append(all, from, std::string::npos);
    }
    case Function::Str:
        return toText(evaluate(expr.args[0], env));
    case Function::Len:
        return double(text(expr.args[0], env).size());
    case Function::Count: {
        const std::string all = text(expr.args[0], env), part = text(expr.args[1], env);
        double count = 0.0;
        trouble_.spend(expr.place, searchWork(all, part));
        if (part.empty() || trouble_.failed()) return count;
        for (size_t at = all.find(part); at != std::string::npos; at = all.find(part, at + part.size())) ++count;
        return count;
    }
    case Function::Find: { // find(text, part [, which]): place of the which-th occurrence (from 0), -1 if there is none
        const std::string all = text(expr.args[0], env), part = text(expr.args[1], env);
        double which = expr.args.size() > 2 ? number(expr.args[2], env) : 0.0;
        trouble_.spend(expr.place, searchWork(all, part));
        if (trouble_.failed()) return -1.0;
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

} // namespace helio::cga
