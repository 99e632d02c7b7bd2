// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "city/base/result.h"
#include "city/base/types.h"

namespace helio::cga {

/// A place in the rule text, both counted from 1.
struct Place
{
    u32 line = 1, column = 1;
};

enum class TokenKind : u8
{
    Name,
    Number,
    Text,
    Sign,
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
};

/// Splits CGA text into tokens, the last one End. Comments: `//` and `#` to the end of the line, `/* */`.
/// Errors: `file:line:column: ...` for an unknown character, an unterminated string or comment, a number out of range.
Result<std::vector<Token>> tokenize(std::string_view text, std::string_view fileName);

/// "file:line:column: message".
Error errorAt(std::string_view fileName, Place place, std::string_view message);

} // namespace helio::cga
