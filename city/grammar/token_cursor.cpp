// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/token_cursor.h"

#include "city/grammar/limits.h"

namespace helio::cga {

TokenCursor::TokenCursor(std::vector<Token> tokens, ErrorList& errors)
    : tokens_(std::move(tokens)), closing_(tokens_.size(), 0), errors_(errors)
{
    // Once for all, as looking for the partner of every parenthesis takes squared time in f(f(f(..
    std::vector<u32> open;
    for (u32 k = 0; k < tokens_.size(); ++k) {
        if (tokens_[k].kind != TokenKind::Sign || tokens_[k].text.size() != 1) continue;
        const char c = tokens_[k].text[0];
        if (c == '(' || c == '[' || c == '{') open.push_back(k);
        const char partner = c == ')' ? '(' : c == ']' ? '[' : c == '}' ? '{' : '\0';
        if (partner == '\0') continue;
        // A brace closes what is left open inside it; a parenthesis never reaches over a brace.
        while (!open.empty() && tokens_[open.back()].text[0] != partner &&
               (c == '}' || tokens_[open.back()].text[0] != '{'))
            open.pop_back();
        if (open.empty() || tokens_[open.back()].text[0] != partner) continue;
        closing_[open.back()] = k;
        open.pop_back();
    }
}

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

bool TokenCursor::takeName(std::string_view name)
{
    if (!isName(name)) return false;
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

void TokenCursor::skipBrackets()
{
    if (failed_) return;
    if (closing_[at_] == 0) return fail(peek().place, concat("this ", found(), " is never closed"));
    at_ = closing_[at_] + 1;
}

void TokenCursor::fail(Place place, std::string_view message)
{
    if (failed_) return;
    if (peek().kind != TokenKind::Bad) errors_.report(place, message);
    failed_ = true;
}

void TokenCursor::recoverInBlock()
{
    if (!failed_) return;
    failed_ = false;
    u32 braces = 0, brackets = 0;
    for (; !atEnd() && !surelyDeclarationAhead(); ++at_) {
        if (isSign("{")) ++braces;
        if (isSign("(") || isSign("[")) ++brackets;
        if ((isSign(")") || isSign("]")) && brackets > 0) --brackets;
        if (isSign("|") && braces == 0 && brackets == 0) return;
        if (!isSign("}")) continue;
        if (braces == 0) return;
        --braces;
        brackets = 0;
    }
    failed_ = true;
}

void TokenCursor::recoverAtDeclaration(size_t begin)
{
    failed_ = false;
    if (at_ == begin) take();
    while (!atEnd() && !surelyDeclarationAhead()) ++at_;
}

std::string TokenCursor::written(std::string_view text, size_t begin) const
{
    std::string result;
    for (size_t k = begin; k < at_; ++k) {
        if (k > begin && tokens_[k].begin > tokens_[k - 1].end) result += ' ';
        result += text.substr(tokens_[k].begin, tokens_[k].end - tokens_[k].begin);
    }
    return result;
}

std::string TokenCursor::found() const
{
    constexpr size_t kShown = 60;
    const Token& token = peek();
    if (token.kind == TokenKind::End) return "the end of the file";
    const std::string text = token.text.size() > kShown ? token.text.substr(0, kShown) + "..." : token.text;
    return token.kind == TokenKind::Text ? concat("the string \"", text, "\"") : concat("'", text, "'");
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
    constexpr u32 kMaxTokens = 40; // no percentage is longer
    if (peek().kind != TokenKind::Number && peek().kind != TokenKind::Name && !isSign("(")) return false;
    bool afterValue = false;
    for (size_t k = 0, steps = 0; steps < kMaxTokens && at_ + k < tokens_.size(); ++k, ++steps) {
        const Token& token = peek(k);
        if (isSign("%", k) && isSign(":", k + 1)) return true;
        if (token.kind == TokenKind::Number || token.kind == TokenKind::Name) {
            if (afterValue) return false;
            afterValue = true;
            continue;
        }
        if (token.kind != TokenKind::Sign) return false;
        if (isSign("(", k)) {
            if (closing_[at_ + k] == 0 || (afterValue && peek(k - 1).kind != TokenKind::Name)) return false;
            k = closing_[at_ + k] - at_;
            afterValue = true;
            continue;
        }
        if (token.text == "-->" || (std::string_view("{}|:[]=,;@)").find(token.text[0]) != std::string_view::npos &&
                                    token.text != "==" && token.text != "||"))
            return false;
        afterValue = false;
    }
    return false;
}

size_t TokenCursor::afterHead(size_t ahead) const
{
    if (!isSign("(", ahead + 1)) return ahead + 1;
    const u32 closing = closing_[at_ + ahead + 1];
    return closing == 0 ? 0 : closing - at_ + 1;
}

bool TokenCursor::keywordAhead() const
{
    if (isSign("@")) return true;
    if (peek().kind != TokenKind::Name) return false;
    if (isName("version")) return peek(1).kind == TokenKind::Text;
    if (peek(1).kind != TokenKind::Name) return false;
    if (isName("start") || isName("extension")) { // these are rules' names as well
        const size_t k = afterHead(1);
        return k > 0 && (isSign("-->", k) || isName("with", k));
    }
    return isName("attr") || isName("const") || isName("style") || isName("import") ||
           (isName("dynamic") && isName("import", 1));
}

bool TokenCursor::declarationAhead() const
{
    if (atEnd() || keywordAhead()) return true;
    if (peek().kind != TokenKind::Name) return false;
    const size_t k = afterHead(0);
    return k > 0 && (isSign("-->", k) || isSign("=", k) || (isName("with", k) && isSign("(", k + 1)));
}

bool TokenCursor::ruleOrKeywordAhead() const
{
    return declarationAhead() && (keywordAhead() || !isSign("=", afterHead(0)));
}

bool TokenCursor::surelyDeclarationAhead() const
{
    if (!declarationAhead()) return false;
    return ruleOrKeywordAhead() || peek().place.column == 1;
}

} // namespace helio::cga
