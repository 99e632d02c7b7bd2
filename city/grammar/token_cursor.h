// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "city/grammar/lexer.h"

namespace helio::cga {

/// A place in a list of tokens, with the look-ahead that CGA needs. The first error sticks and moves the cursor to the
/// end, so that every loop of a parser stops by itself.
class TokenCursor
{
public:
    /// Precondition: the last token is End.
    TokenCursor(std::vector<Token> tokens, std::string_view fileName) : tokens_(std::move(tokens)), fileName_(fileName)
    {
    }

    const Token& peek(size_t ahead = 0) const { return tokens_[std::min(at_ + ahead, tokens_.size() - 1)]; }
    bool atEnd() const { return peek().kind == TokenKind::End; }
    bool isSign(std::string_view sign, size_t ahead = 0) const
    {
        return peek(ahead).kind == TokenKind::Sign && peek(ahead).text == sign;
    }
    bool isName(std::string_view name, size_t ahead = 0) const
    {
        return peek(ahead).kind == TokenKind::Name && peek(ahead).text == name;
    }
    Token take();
    bool takeSign(std::string_view sign);
    /// Takes a sign or fails: "expected 'sign' where, found ...".
    void need(std::string_view sign, std::string_view where);
    Token needName(std::string_view what);
    /// Skips "( ... )" with everything in it.
    void skipParentheses();

    void fail(Place place, std::string_view message);
    bool failed() const { return failed_; }
    const Error& error() const { return error_; }
    /// The token at hand, for messages.
    std::string found() const;

    /// True if a percentage `expression % :` starts here; a percent sign is modulo everywhere else.
    bool percentAhead() const;
    /// True if the next tokens start a declaration: CGA has no separator between them.
    bool declarationAhead() const;

    /// Counts how deep the text nests, for as long as it lives.
    struct Nest
    {
        explicit Nest(TokenCursor& c) : cursor(c) { ++cursor.nesting_; }
        ~Nest() { --cursor.nesting_; }
        Nest(const Nest&) = delete;
        Nest& operator=(const Nest&) = delete;
        TokenCursor& cursor;
    };
    /// True, with an error, when the text nests too deeply to go on.
    bool tooDeep();

private:
    std::vector<Token> tokens_;
    std::string fileName_;
    size_t at_ = 0;
    bool failed_ = false;
    Error error_;
    u32 nesting_ = 0;
};

} // namespace helio::cga
