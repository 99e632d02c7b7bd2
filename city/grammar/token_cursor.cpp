// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/token_cursor.h"

#include "city/grammar/limits.h"

namespace helio::cga {

Token TokenCursor::take()
{
    Token token = peek();
    if (!atEnd()) ++at_;
    return token;
}

bool TokenCursor::takeSign(std::string_view sign)
{
    if (!isSign(sign)) return false;
    ++at_;
    return true;
}

void TokenCursor::need(std::string_view sign, std::string_view where)
{
    if (!takeSign(sign)) fail(peek().place, concat("expected '", sign, "' ", where, ", found ", found()));
}

Token TokenCursor::needName(std::string_view what)
{
    if (peek().kind == TokenKind::Name) return take();
    fail(peek().place, concat("expected ", what, ", found ", found()));
    return {};
}

void TokenCursor::skipParentheses()
{
    const Place start = peek().place;
    u32 depth = 0;
    do {
        if (atEnd()) return fail(start, "this parenthesis is never closed");
        depth += isSign("(") ? 1u : 0u;
        depth -= isSign(")") ? 1u : 0u;
        take();
    } while (depth > 0);
}

void TokenCursor::fail(Place place, std::string_view message)
{
    if (!failed_) error_ = errorAt(fileName_, place, message);
    failed_ = true;
    at_ = tokens_.size() - 1;
}

std::string TokenCursor::found() const
{
    const Token& token = peek();
    if (token.kind == TokenKind::End) return "the end of the file";
    return token.kind == TokenKind::Text ? concat("the string \"", token.text, "\"") : concat("'", token.text, "'");
}

bool TokenCursor::tooDeep()
{
    if (nesting_ <= kMaxNesting) return false;
    fail(peek().place,
         concat("nested deeper than ", kMaxNesting, " levels: move the inner part into a rule or function of its own"));
    return true;
}

bool TokenCursor::percentAhead() const
{
    if (peek().kind != TokenKind::Number && peek().kind != TokenKind::Name && !isSign("(")) return false;
    u32 depth = 0;
    bool afterValue = false;
    for (size_t k = 0; k < 40 && at_ + k < tokens_.size(); ++k) {
        const Token& token = peek(k);
        const bool sign = token.kind == TokenKind::Sign;
        if (depth == 0) {
            if (isSign("%", k) && isSign(":", k + 1)) return true;
            if (token.kind == TokenKind::End || token.kind == TokenKind::Text) return false;
            if (sign && std::string_view("{}|:[]=,;@").find(token.text[0]) != std::string_view::npos &&
                token.text != "==" && token.text != "||")
                return false;
            if (sign && token.text == "-->") return false;
            const bool value = token.kind == TokenKind::Number || token.kind == TokenKind::Name;
            if (afterValue && (value || (isSign("(", k) && peek(k - 1).kind != TokenKind::Name))) return false;
        }
        if (isSign("(", k)) ++depth;
        if (isSign(")", k)) {
            if (depth == 0) return false;
            --depth;
        }
        afterValue = token.kind == TokenKind::Number || token.kind == TokenKind::Name || isSign(")", k);
    }
    return false;
}

bool TokenCursor::declarationAhead() const
{
    if (atEnd() || isSign("@")) return true;
    if (peek().kind != TokenKind::Name) return false;
    if (peek(1).kind == TokenKind::Name && (isName("attr") || isName("const") || isName("style") || isName("import") ||
                                            isName("extension") || isName("start")))
        return true;
    if (isName("version") && peek(1).kind == TokenKind::Text) return true;
    size_t k = 1;
    if (isSign("(", k)) {
        u32 depth = 0;
        do {
            if (peek(k).kind == TokenKind::End) return false;
            depth += isSign("(", k) ? 1u : 0u;
            depth -= isSign(")", k) ? 1u : 0u;
            ++k;
        } while (depth > 0);
    }
    return isSign("-->", k) || isSign("=", k) || isName("with", k);
}

} // namespace helio::cga
