// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/lexer.h"

#include <charconv>
#include <cmath>

#include "city/grammar/limits.h"

namespace helio::cga {

namespace {

bool isDigit(char c)
{
    return c >= '0' && c <= '9';
}
bool isNameStart(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$';
}
bool isNamePart(char c)
{
    return isNameStart(c) || isDigit(c);
}

/// Walks the text once; `error` is set at the first thing that is no token.
class Scanner
{
public:
    Scanner(std::string_view text, std::string_view fileName) : text_(text), fileName_(fileName) {}

    Result<std::vector<Token>> run()
    {
        if (text_.size() > kMaxSourceBytes)
            return errorAt(
                fileName_, {},
                concat("the file has ", text_.size(), " bytes; rule files are limited to ", kMaxSourceBytes));
        if (text_.substr(0, 3) == "\xEF\xBB\xBF") at_ = 3;
        std::vector<Token> tokens;
        while (skipSpace()) {
            Token token;
            token.place = place_;
            if (!readToken(token)) return error_;
            tokens.push_back(std::move(token));
        }
        if (!error_.message.empty()) return error_;
        Token end;
        end.place = place_;
        tokens.push_back(end);
        return tokens;
    }

private:
    char peek(size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }

    void advance(size_t count = 1)
    {
        for (; count > 0 && at_ < text_.size(); --count) {
            const char c = text_[at_++];
            if (c == '\n')
                place_ = {place_.line + 1, 1};
            else if ((c & 0xC0) != 0x80)
                ++place_.column; // a UTF-8 character counts as one column
        }
    }

    bool fail(Place place, std::string_view message)
    {
        error_ = errorAt(fileName_, place, message);
        return false;
    }

    /// Moves to the next token; false at the end of the text or on an error.
    bool skipSpace()
    {
        while (at_ < text_.size()) {
            const char c = peek();
            if (c == ' ' || c == '\t' || c == '\r' || c == '\n')
                advance();
            else if (c == '#' || (c == '/' && peek(1) == '/')) {
                while (at_ < text_.size() && peek() != '\n') advance();
            } else if (c == '/' && peek(1) == '*') {
                const Place start = place_;
                const size_t end = text_.find("*/", at_ + 2);
                if (end == std::string_view::npos) return fail(start, "this comment is never closed: end it with */");
                advance(end + 2 - at_);
            } else
                return true;
        }
        return false;
    }

    bool readToken(Token& token)
    {
        const char c = peek();
        if (c == '"') return readText(token);
        if (isDigit(c) || (c == '.' && isDigit(peek(1)))) return readNumber(token);
        if (isNameStart(c)) {
            const size_t begin = at_;
            while (isNamePart(peek())) advance();
            while (peek() == '.' && isNameStart(peek(1))) {
                advance();
                while (isNamePart(peek())) advance();
            }
            if (peek() == '.') advance(); // a terminal: `Wall.`
            token.kind = TokenKind::Name;
            token.text = text_.substr(begin, at_ - begin);
            return true;
        }
        static constexpr std::string_view kSigns[] = {"-->", "==", "!=", "<=", ">=", "&&", "||", ":=", "=:"};
        token.kind = TokenKind::Sign;
        for (std::string_view sign : kSigns) {
            if (text_.substr(at_, sign.size()) != sign) continue;
            token.text = sign;
            advance(sign.size());
            return true;
        }
        if (std::string_view("+-*/%<>!=~'(){}[]|:,;@").find(c) == std::string_view::npos) {
            const bool printable = c > ' ' && c < 0x7F;
            return fail(
                place_,
                printable
                    ? concat("the character '", c, "' has no meaning in CGA")
                    : std::string(
                          "this character has no meaning in CGA; outside strings and comments only ASCII is used"));
        }
        token.text = c;
        advance();
        return true;
    }

    bool readText(Token& token)
    {
        token.kind = TokenKind::Text;
        advance();
        for (;;) {
            const char c = peek();
            if (at_ >= text_.size() || c == '\n')
                return fail(token.place, "this string is never closed: end it with \" on the same line");
            if (c == '"') break;
            if (c == '\\') {
                advance();
                const char escaped = peek();
                token.text += escaped == 'n' ? '\n' : escaped == 't' ? '\t' : escaped;
            } else
                token.text += c;
            advance();
        }
        advance();
        if (token.text.size() > kMaxTextBytes)
            return fail(token.place, concat("strings are limited to ", kMaxTextBytes, " bytes"));
        return true;
    }

    bool readNumber(Token& token)
    {
        token.kind = TokenKind::Number;
        const size_t begin = at_;
        while (isDigit(peek())) advance();
        if (peek() == '.') advance();
        while (isDigit(peek())) advance();
        const size_t sign = peek(1) == '+' || peek(1) == '-' ? 1 : 0;
        if ((peek() == 'e' || peek() == 'E') && isDigit(peek(1 + sign))) {
            advance(1 + sign);
            while (isDigit(peek())) advance();
        }
        token.text = text_.substr(begin, at_ - begin);
        const auto result = std::from_chars(token.text.data(), token.text.data() + token.text.size(), token.number);
        if (result.ec != std::errc() || !std::isfinite(token.number))
            return fail(token.place, concat("the number ", token.text, " is out of range"));
        return true;
    }

    std::string_view text_, fileName_;
    size_t at_ = 0;
    Place place_;
    Error error_;
};

} // namespace

Error errorAt(std::string_view fileName, Place place, std::string_view message)
{
    return {concat(fileName, ":", place.line, ":", place.column, ": ", message)};
}

Result<std::vector<Token>> tokenize(std::string_view text, std::string_view fileName)
{
    return Scanner(text, fileName).run();
}

} // namespace helio::cga
