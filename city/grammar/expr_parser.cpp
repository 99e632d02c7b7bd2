// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/expr_parser.h"

#include <optional>

#include "city/grammar/limits.h"

namespace helio::cga {

namespace {

constexpr std::string_view kNoArrays = "arrays are not supported: use case/else or a percentage to choose a value";

} // namespace

Size ExprParser::parseSize()
{
    const bool outerAllowed = sizeAllowed_;
    const SizeKind outerKind = sizeKind_;
    sizeAllowed_ = true;
    sizeKind_ = SizeKind::Absolute;
    Size size;
    size.value = parseExpr();
    size.kind = sizeKind_;
    sizeAllowed_ = outerAllowed;
    sizeKind_ = outerKind;
    return size;
}

Expr ExprParser::make(ExprKind kind, Place place, u32 index, std::vector<Expr> args)
{
    Expr expr;
    expr.kind = kind;
    expr.place = place;
    expr.index = index;
    for (const Expr& arg : args) expr.depth = std::max(expr.depth, arg.depth + 1);
    expr.args = std::move(args);
    if (expr.depth > kMaxNesting) {
        fail(place, concat("this expression nests deeper than ", kMaxNesting, " levels: split it into functions"));
        return {};
    }
    return expr;
}

Expr ExprParser::parseExpr()
{
    Nest nest(*this);
    if (tooDeep()) return {};
    const Place place = peek().place;
    const bool cases = isName("case");
    if (!cases && !percentAhead()) return parseBinary(0);
    std::vector<Expr> args;
    while (cases ? isName("case") : percentAhead()) {
        if (cases) {
            take();
            args.push_back(parseExpr());
            need(":", "after the condition of 'case'");
        } else {
            args.push_back(parsePercentage());
        }
        args.push_back(parseExpr());
    }
    needElse(place);
    args.push_back(parseExpr());
    return make(cases ? ExprKind::Cases : ExprKind::Percent, place, 0, std::move(args));
}

std::optional<BinaryOp> ExprParser::binaryAhead(u32 level) const
{
    struct Row
    {
        std::string_view sign;
        u32 level;
        BinaryOp op;
    };
    static constexpr Row kRows[] = {
        {"||", 0, BinaryOp::Or},        {"&&", 1, BinaryOp::And},          {"==", 2, BinaryOp::Equal},
        {"!=", 2, BinaryOp::NotEqual},  {"<", 3, BinaryOp::Less},          {">", 3, BinaryOp::Greater},
        {"<=", 3, BinaryOp::LessEqual}, {">=", 3, BinaryOp::GreaterEqual}, {"+", 4, BinaryOp::Add},
        {"-", 4, BinaryOp::Subtract},   {"*", 5, BinaryOp::Multiply},      {"/", 5, BinaryOp::Divide},
        {"%", 5, BinaryOp::Modulo}};
    for (const Row& row : kRows)
        if (row.level == level && isSign(row.sign) && !(row.op == BinaryOp::Modulo && isSign(":", 1))) return row.op;
    return {};
}

Expr ExprParser::parseBinary(u32 level)
{
    if (level == 6) return parseUnary();
    Expr left = parseBinary(level + 1);
    while (const auto op = binaryAhead(level)) {
        const Place place = take().place;
        std::vector<Expr> args;
        args.push_back(std::move(left));
        args.push_back(parseBinary(level + 1));
        left = make(ExprKind::Binary, place, u32(*op), std::move(args));
    }
    return left;
}

Expr ExprParser::parseUnary()
{
    Nest nest(*this);
    if (tooDeep()) return {};
    const Place place = peek().place;
    if (takeSign("+")) return parseUnary();
    if (isSign("'") || isSign("~")) {
        const SizeKind kind = isSign("'") ? SizeKind::Relative : SizeKind::Floating;
        if (!sizeAllowed_)
            return fail(place, concat(found(), " belongs to sizes: in arguments of s, t and split")), Expr{};
        if (sizeKind_ != SizeKind::Absolute) return fail(place, "a size has one ' or ~, for the whole of it"), Expr{};
        sizeKind_ = kind; // for the whole size expression, wherever the sign stands
        take();
        return parseUnary();
    }
    if (isSign("-") || isSign("!")) {
        const bool negate = take().text == "-";
        std::vector<Expr> args;
        args.push_back(parseUnary());
        return make(negate ? ExprKind::Negate : ExprKind::Not, place, 0, std::move(args));
    }
    return parsePrimary();
}

Expr ExprParser::parsePrimary()
{
    const Token token = peek();
    Expr expr;
    expr.place = token.place;
    if (token.kind == TokenKind::Number) {
        take();
        expr.number = token.number;
    } else if (token.kind == TokenKind::Text) {
        take();
        expr.kind = ExprKind::Text;
        expr.text = token.text;
    } else if (takeSign("(")) {
        // ' and ~ inside parentheses still mean the whole size, as in '(1 - x).
        expr = parseExpr();
        if (!takeSign(")"))
            fail(peek().place, concat("expected ')' to close the parenthesis at ", token.place.line, ":",
                                      token.place.column, ", found ", found()));
    } else if (isSign("[")) {
        report(token.place, kNoArrays);
        skipBrackets();
    } else if (token.kind == TokenKind::Name && !isName("else") && !isName("case") && !ruleOrKeywordAhead()) {
        expr = parseName();
    } else {
        fail(token.place, concat("expected a value, found ", found()));
    }
    return expr;
}

Expr ExprParser::parseName()
{
    const Token name = take();
    if (name.text == "true" || name.text == "false") {
        Expr expr = make(ExprKind::Bool, name.place, 0, {});
        expr.number = name.text == "true";
        return expr;
    }
    std::vector<Expr> args;
    const bool call = isSign("(");
    if (takeSign("(")) {
        const bool outerAllowed = sizeAllowed_;
        sizeAllowed_ = false;
        while (!atEnd() && !isSign(")")) {
            args.push_back(parseExpr());
            if (!isSign(")")) need(",", "between arguments");
        }
        need(")", "after the arguments");
        sizeAllowed_ = outerAllowed;
    }
    if (call && isSign("{")) {
        report(name.place, concat("'", name.text,
                                  "(..) { .. }' as a value is an array, and arrays are not supported: count or "
                                  "select with the operation of this name, and report(..)"));
        skipBrackets();
    }
    if (isSign("[") && peek().place.line == name.place.line &&
        peek().place.column == name.place.column + name.text.size()) {
        report(peek().place, kNoArrays);
        skipBrackets();
    }
    Expr expr = make(ExprKind::Keyword, name.place, 0, std::move(args));
    expr.text = name.text;
    return expr;
}

Expr ExprParser::parsePercentage()
{
    Expr percentage = parseBinary(4); // sums, as % is followed by ':' here
    need("%", "after the percentage");
    need(":", "after '%'");
    return percentage;
}

void ExprParser::needElse(Place start)
{
    if (!isName("else"))
        return fail(peek().place, concat("expected 'else' to end the choice that starts at ", start.line, ":",
                                         start.column, ", found ", found()));
    take();
    need(":", "after 'else'");
}

} // namespace helio::cga
