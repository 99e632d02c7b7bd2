// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "city/base/result.h"
#include "city/base/types.h"

namespace helio::cga {

/// A place in the rule text: line and column are counted from 1, file is an index into Program::files.
struct Place
{
    u32 line = 1, column = 1, file = 0;
};

enum class TokenKind : u8
{
    Name,
    Number,
    Text,
    Sign,
    Bad, ///< not a token: reported by the lexer, so that the parser says nothing more about it
    End
};

/// A word of the language. Names may hold dots (`scope.sx`) and end in one (`Wall.`); signs are at most three
/// characters.
struct Token
{
    TokenKind kind = TokenKind::End;
    Place place;
    std::string text; ///< as written; the unescaped value for Text
    double number = 0.0;
    u32 begin = 0, end = 0; ///< bytes in the file
};

class ErrorList;

/// Splits the text of a file into tokens, the last one End. Comments: `//` and `#` to the end of the line, `/* */`.
/// Reported: an unknown character, an unterminated string or comment, a number out of range, a file over
/// kMaxSourceBytes; each leaves a Bad token.
std::vector<Token> tokenize(std::string_view text, u32 file, ErrorList& errors);

/// "file:line:column: message".
Error errorAt(std::string_view fileName, Place place, std::string_view message);

} // namespace helio::cga
