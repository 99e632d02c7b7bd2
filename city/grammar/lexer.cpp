// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/lexer.h"

#include <charconv>
#include <cmath>

#include "city/grammar/error_list.h"
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

/// Walks the text once.
class Scanner
{
public:
    Scanner(std::string_view text, u32 file, ErrorList& errors) : text_(text), errors_(errors) { place_.file = file; }

    std::vector<Token> run()
    {
        if (text_.size() > kMaxSourceBytes) {
            report(place_,
                   concat("the file has ", text_.size(), " bytes; rule files are limited to ", kMaxSourceBytes));
            text_ = {};
            add(TokenKind::Bad);
        }
        if (text_.substr(0, 3) == "\xEF\xBB\xBF") at_ = 3;
        while (skipSpace()) {
            add(TokenKind::Bad);
            readToken(tokens_.back());
            tokens_.back().end = u32(at_);
            if (tokens_.back().kind == TokenKind::Bad && tokens_.size() > 1 &&
                tokens_[tokens_.size() - 2].kind == TokenKind::Bad)
                tokens_.pop_back();
        }
        add(TokenKind::End);
        return std::move(tokens_);
    }

private:
    char peek(size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }

    void advance(size_t count = 1)
    {
        for (; count > 0 && at_ < text_.size(); --count) {
            const char c = text_[at_++];
            if (c == '\n')
                place_ = {place_.line + 1, 1, place_.file};
            else if ((c & 0xC0) != 0x80)
                ++place_.column; // a UTF-8 character counts as one column
        }
    }

    void add(TokenKind kind)
    {
        Token& token = tokens_.emplace_back();
        token.kind = kind;
        token.place = place_;
        token.begin = token.end = u32(at_);
    }

    /// One mistake a line: what follows the first is often its consequence.
    void report(Place place, std::string_view message)
    {
        if (place.line != reportedLine_) errors_.report(place, message);
        reportedLine_ = place.line;
    }

    /// Moves to the next token; false at the end of the text.
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
                if (end == std::string_view::npos) {
                    report(start, "this comment is never closed: end it with */");
                    add(TokenKind::Bad);
                    advance(text_.size() - at_);
                    return false;
                }
                advance(end + 2 - at_);
            } else
                return true;
        }
        return false;
    }

    void readToken(Token& token)
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
            if (at_ - begin > kMaxNameBytes)
                return report(token.place, concat("names are limited to ", kMaxNameBytes, " bytes"));
            token.kind = TokenKind::Name;
            token.text = text_.substr(begin, at_ - begin);
            return;
        }
        static constexpr std::string_view kSigns[] = {"-->", "==", "!=", "<=", ">=", "&&", "||", ":=", "=:"};
        for (std::string_view sign : kSigns) {
            if (text_.substr(at_, sign.size()) != sign) continue;
            token.kind = TokenKind::Sign;
            token.text = sign;
            return advance(sign.size());
        }
        if (std::string_view("+-*/%<>!=~'(){}[]|:,;@").find(c) == std::string_view::npos) {
            const bool printable = c > ' ' && c < 0x7F;
            report(place_, printable ? concat("the character '", c, "' has no meaning in CGA")
                                     : std::string("this character has no meaning in CGA; outside strings and comments "
                                                   "only ASCII is used"));
            // A run of them is one mistake.
            do advance();
            while (at_ < text_.size() && (u8(peek()) >= 0x7F || (u8(peek()) < ' ' && peek() != '\n')));
            return;
        }
        token.kind = TokenKind::Sign;
        token.text = c;
        advance();
    }

    void readText(Token& token)
    {
        advance();
        for (;;) {
            const char c = peek();
            if (at_ >= text_.size() || c == '\n')
                return report(token.place, "this string is never closed: end it with \" on the same line");
            if (c == '"') break;
            if (c == '\\') {
                advance();
                const char escaped = peek();
                if (escaped == '\n' || at_ >= text_.size()) continue;
                token.text += escaped == 'n' ? '\n' : escaped == 't' ? '\t' : escaped;
            } else
                token.text += c;
            advance();
        }
        advance();
        if (token.text.size() > kMaxTextBytes)
            return report(token.place, concat("strings are limited to ", kMaxTextBytes, " bytes"));
        token.kind = TokenKind::Text;
    }

    void readNumber(Token& token)
    {
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
            return report(token.place, concat("the number ", token.text.substr(0, 40), " is out of range"));
        token.kind = TokenKind::Number;
    }

    std::string_view text_;
    ErrorList& errors_;
    size_t at_ = 0;
    Place place_;
    std::vector<Token> tokens_;
    u32 reportedLine_ = 0;
};

} // namespace

Error errorAt(std::string_view fileName, Place place, std::string_view message)
{
    return {concat(fileName, ":", place.line, ":", place.column, ": ", message)};
}

std::vector<Token> tokenize(std::string_view text, u32 file, ErrorList& errors)
{
    return Scanner(text, file, errors).run();
}

} // namespace helio::cga
