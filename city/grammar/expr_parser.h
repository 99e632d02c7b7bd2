// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "city/grammar/program.h"
#include "city/grammar/token_cursor.h"

namespace helio::cga {

/// Expressions and sizes, by recursive descent.
class ExprParser : public TokenCursor
{
public:
    using TokenCursor::TokenCursor;

    /// A value, or a choice between values.
    Expr parseExpr();
    /// An expression that may hold one ' or ~, for the whole of it.
    Size parseSize();
    /// `expression % :`
    Expr parsePercentage();
    /// `else :` of the choice that starts at `start`.
    void needElse(Place start);

private:
    Expr make(ExprKind kind, Place place, u32 index, std::vector<Expr> args);
    std::optional<BinaryOp> binaryAhead(u32 level) const;
    Expr parseBinary(u32 level);
    Expr parseUnary();
    Expr parsePrimary();
    Expr parseName();

    bool sizeAllowed_ = false;
    SizeKind sizeKind_ = SizeKind::Absolute;
};

} // namespace helio::cga
