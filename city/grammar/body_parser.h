// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/grammar/expr_parser.h"
#include "city/grammar/parser.h"

namespace helio::cga {

/// Bodies of rules: choices, statements and blocks.
class BodyParser : public ExprParser
{
public:
    BodyParser(std::vector<Token> tokens, NameTable& names, ErrorList& errors)
        : ExprParser(std::move(tokens), errors), names_(names)
    {
    }

    Body parseBody();

protected:
    NameTable& names_;

private:
    void parseStatements(std::vector<Statement>& statements);
    void parseCall(std::vector<Statement>& statements);
    std::shared_ptr<Block> parseBlock(bool sizes);
    void parseElement(Block& block, bool sizes);
};

} // namespace helio::cga
