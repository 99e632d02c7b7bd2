// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "city/grammar/error_list.h"
#include "city/grammar/lexer.h"

namespace helio::cga {

/// A place in a list of tokens, with the look-ahead that CGA needs. After a mistake the cursor acts as if it stood at
/// the end, so that every loop of a parser stops by itself and nothing more is reported, until a recover function finds
/// a place to go on.
class TokenCursor
{
public:
    /// Precondition: the last token is End.
    TokenCursor(std::vector<Token> tokens, ErrorList& errors);

    const Token& peek(size_t ahead = 0) const
    {
        return failed_ ? tokens_.back() : tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
    }
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
    bool takeName(std::string_view name);
    /// Takes a sign or fails: "expected 'sign' where, found ...".
    void need(std::string_view sign, std::string_view where);
    Token needName(std::string_view what);
    /// Skips the bracket `(`, `[` or `{` at hand and everything in it; fails if it is never closed.
    void skipBrackets();

    /// Reports a mistake after which the text at hand makes no sense. Says nothing about what the lexer has reported.
    void fail(Place place, std::string_view message);
    /// Reports a mistake that does not keep the parser from going on.
    void report(Place place, std::string_view message) { errors_.report(place, message); }
    bool failed() const { return failed_; }
    /// The token at hand, for messages.
    std::string found() const;

    /// After a mistake inside a block { .. }: goes on at the next `|` of the block or the `}` that ends it. Still
    /// failed if a declaration or the end of the file comes first.
    void recoverInBlock();
    /// After a mistake anywhere: goes on at the next declaration behind `begin`, where the broken one starts.
    void recoverAtDeclaration(size_t begin);

    /// True if the end of the text could not be read, as in a comment that is never closed.
    bool endsBadly() const { return tokens_.size() > 1 && tokens_[tokens_.size() - 2].kind == TokenKind::Bad; }

    /// The number of the token at hand, also after a mistake.
    size_t position() const { return at_; }
    /// The tokens from `begin` to the one before the token at hand as they stand in `text`, without comments and line
    /// ends.
    std::string written(std::string_view text, size_t begin) const;

    /// True if a percentage `expression % :` starts here; a percent sign is modulo everywhere else.
    bool percentAhead() const;
    /// True if the next tokens start a declaration: CGA has no separator between them.
    bool declarationAhead() const;
    /// True if they cannot be anything else: `a = b` is one only in the first column, as selectors take `=` as well.
    bool surelyDeclarationAhead() const;
    /// True if they start a declaration, but not one with `=`.
    bool ruleOrKeywordAhead() const;

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
    bool keywordAhead() const;
    /// How many tokens follow up to the one after `name` or `name ( .. )`; 0 if the parenthesis is never closed.
    size_t afterHead(size_t ahead) const;

    std::vector<Token> tokens_;
    std::vector<u32> closing_; ///< per opening bracket: the token that closes it, 0 if none does
    ErrorList& errors_;
    size_t at_ = 0;
    bool failed_ = false;
    u32 nesting_ = 0;
};

} // namespace helio::cga
