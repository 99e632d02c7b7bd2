// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/body_parser.h"

namespace helio::cga {

Body BodyParser::parseBody()
{
    Nest nest(*this);
    Body body;
    body.place = peek().place;
    if (tooDeep()) return body;
    const bool cases = isName("case");
    if (!cases && !percentAhead()) {
        parseStatements(body.statements);
        return body;
    }
    body.kind = cases ? Body::Kind::Cases : Body::Kind::Percent;
    while (cases ? isName("case") : percentAhead()) {
        if (cases) {
            take();
            body.conditions.push_back(parseExpr());
            need(":", "after the condition of 'case'");
        } else {
            body.conditions.push_back(parsePercentage());
        }
        body.bodies.push_back(parseBody());
    }
    needElse(body.place);
    body.bodies.push_back(parseBody());
    return body;
}

void BodyParser::parseStatements(std::vector<Statement>& statements)
{
    for (;;) {
        if (isSign("}") || isSign("|") || isSign("]") || isSign(")") || isName("else") || isName("case")) return;
        if (takeSign(";")) continue;
        if (declarationAhead() || percentAhead()) return;
        if (isSign("[")) {
            Statement& statement = statements.emplace_back();
            statement.kind = StatementKind::Push;
            statement.place = take().place;
            Body body = parseBody();
            const Place place = statements.back().place;
            statements.back().body.push_back(std::move(body));
            if (!takeSign("]")) fail(place, concat("this '[' is never closed: expected ']', found ", found()));
        } else if (peek().kind == TokenKind::Name) {
            parseCall(statements);
        } else {
            fail(peek().place, concat("expected an operation or a rule, found ", found()));
        }
    }
}

void BodyParser::parseCall(std::vector<Statement>& statements)
{
    const Token name = take();
    if (const std::string_view advice = refusedOperation(name.text); !advice.empty()) {
        report(name.place, concat("the operation '", name.text, "' is not supported: ", advice));
        if (isSign("(")) skipBrackets(); // what is in there may be words of its own
        if (isSign("{")) skipBrackets();
        takeSign("*");
        return;
    }
    Statement statement;
    statement.place = name.place;
    statement.name = names_.intern(name.text); // resolve.cpp decides what it names
    if (takeSign("(")) {
        while (!atEnd() && !isSign(")")) {
            statement.args.push_back(parseSize());
            if (!isSign(")")) need(",", "between arguments");
        }
        need(")", "after the arguments");
    }
    if (isSign("{") && name.text == "scatter") {
        const Place open = take().place;
        statement.body.push_back(parseBody());
        if (!takeSign("}")) fail(open, concat("this '{' is never closed: expected '}', found ", found()));
    } else if (isSign("{")) {
        statement.block = parseBlock(name.text == "split");
    }
    statements.push_back(std::move(statement));
}

std::shared_ptr<Block> BodyParser::parseBlock(bool sizes)
{
    Nest nest(*this);
    auto block = std::make_shared<Block>();
    if (tooDeep()) return block;
    const Place start = take().place;
    for (;;) {
        if (!isSign("|") && !isSign("}") && !atEnd()) parseElement(*block, sizes);
        if (failed()) recoverInBlock();
        if (takeSign("|")) continue;
        if (takeSign("}")) break;
        fail(peek().place, concat("expected '|' or '}' in the block that opens at ", start.line, ":", start.column,
                                  ", found ", found()));
        recoverInBlock();
        if (failed()) return block;
    }
    block->repeat = takeSign("*");
    return block;
}

void BodyParser::parseElement(Block& block, bool sizes)
{
    BlockElement element;
    element.place = peek().place;
    if (isSign("{") || (isName("split") && isSign("(", 1))) {
        if (takeName("split")) skipBrackets(); // old files nest split(y){ .. }* without a size
        if (!sizes) return fail(element.place, "only split nests blocks");
        if (!isSign("{")) return fail(peek().place, concat("expected '{' after split(..), found ", found()));
        element.nested = parseBlock(true);
    } else {
        element.size = parseSize(); // of a part of split; else the selector, which words.cpp reads
        element.combine = isSign("=") || isSign("=:");
        if (!takeSign(":") && !takeSign("=") && !takeSign("=:"))
            return fail(peek().place,
                        concat("expected ':' after the ", sizes ? "size" : "selector", ", found ", found()));
        element.body = parseBody();
    }
    if (!failed()) block.elements.push_back(std::move(element));
}

} // namespace helio::cga
