// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/parser.h"

#include <algorithm>

#include "city/grammar/limits.h"
#include "city/grammar/token_cursor.h"

namespace helio::cga {

namespace {

/// Recursive descent over the grammar of README.md.
class Parser : TokenCursor
{
public:
    Parser(std::vector<Token> tokens, std::string_view fileName) : TokenCursor(std::move(tokens), fileName)
    {
        program_ = std::make_shared<Program>();
        program_->fileName = fileName;
    }

    Result<std::shared_ptr<Program>> run()
    {
        while (!atEnd()) parseItem();
        if (failed()) return error();
        if (program_->rules.empty())
            return errorAt(program_->fileName, {}, "the file declares no rule: write at least  Lot --> ...");
        return program_;
    }

private:
    // ---- declarations
    void parseItem()
    {
        const Token first = peek();
        if (takeSign("@")) {
            const Token name = needName("an annotation's name after '@'");
            if (isSign("(")) skipParentheses();
            startNext_ = startNext_ || name.text == "StartRule";
        } else if (isName("version") && peek(1).kind == TokenKind::Text) {
            take();
            take();
        } else if (isName("import") && peek(1).kind == TokenKind::Name) {
            fail(first.place, "imports are not supported: copy the rules into one file");
        } else if (isName("style") && peek(1).kind == TokenKind::Name) {
            fail(first.place,
                 "styles are not supported: make each style a rule file of its own, or choose by an attribute");
        } else if (isName("case") || percentAhead()) {
            fail(first.place, "a choice (case, or a percentage) must be the whole body of a rule: put it into [ ] or "
                              "into a rule of its own");
        } else if (first.kind == TokenKind::Name) {
            parseDeclaration();
        } else {
            fail(first.place,
                 concat("expected a declaration such as  Name --> ...  or  attr name = value, found ", found()));
        }
    }

    void parseDeclaration()
    {
        GlobalKind kind = GlobalKind::Function;
        bool isGlobal = false;
        while (peek(1).kind == TokenKind::Name) {
            if (isName("attr"))
                kind = GlobalKind::Attribute;
            else if (isName("const"))
                kind = GlobalKind::Constant;
            else if (isName("start"))
                startNext_ = true;
            else if (isName("extension"))
                return fail(peek().place, "'extension' is not supported: leave it out");
            else
                break;
            isGlobal = isGlobal || !isName("start");
            take();
        }
        const Token name = take();
        if (name.text.back() == '.')
            return fail(name.place, concat("'", name.text, "' ends in a dot: terminals are used, not declared"));
        std::vector<std::string> parameters;
        if (takeSign("(")) {
            while (!atEnd() && !isSign(")")) {
                parameters.push_back(needName("a parameter's name").text);
                if (!isSign(")")) need(",", "between parameters");
            }
            need(")", "after the parameters");
        }
        if (isName("with"))
            return fail(peek().place, "'with' is not supported: make the value a function or a parameter");
        const auto key = std::pair(name.text, u32(parameters.size()));
        if (takeSign("-->")) {
            if (isGlobal) return fail(name.place, concat("'", name.text, "' is a rule: leave out attr and const"));
            if (!findOperationName(name)) return;
            Rule rule;
            rule.name = intern(name.text);
            rule.place = name.place;
            rule.parameters = std::move(parameters);
            rule.body = parseBody();
            if (startNext_ && program_->startRule == kNoIndex) program_->startRule = u32(program_->rules.size());
            startNext_ = false;
            if (!program_->ruleIndex.emplace(key, u32(program_->rules.size())).second)
                return fail(name.place,
                            concat("rule '", name.text, "' with ", key.second, " parameters is declared twice"));
            program_->rules.push_back(std::move(rule));
        } else if (takeSign("=")) {
            if (kind != GlobalKind::Function && !parameters.empty())
                return fail(name.place,
                            concat("'", name.text, "' has parameters, so it is a function: leave out attr and const"));
            Global global{kind, name.text, name.place, std::move(parameters), parseExpr()};
            startNext_ = false;
            if (!program_->globalIndex.emplace(key, u32(program_->globals.size())).second)
                return fail(name.place, concat("'", name.text, "' is declared twice"));
            program_->globals.push_back(std::move(global));
        } else {
            fail(peek().place, concat("expected '-->' (a rule) or '=' (a function or attribute) after '", name.text,
                                      "', found ", found()));
        }
    }

    bool findOperationName(const Token& name)
    {
        if (!findOperation(name.text)) return true;
        fail(name.place, concat("'", name.text, "' is an operation: give the rule another name"));
        return false;
    }

    u32 intern(const std::string& name)
    {
        const auto [it, added] = nameIndex_.emplace(name, u32(program_->names.size()));
        if (added) program_->names.push_back(name);
        return it->second;
    }

    // ---- bodies
    Body parseBody()
    {
        Nest nest(*this);
        Body body;
        body.place = peek().place;
        if (tooDeep()) return body;
        if (isName("case")) {
            body.kind = Body::Kind::Cases;
            while (isName("case")) {
                take();
                body.conditions.push_back(parseExpr());
                need(":", "after the condition of 'case'");
                body.bodies.push_back(parseBody());
            }
            parseElse(body);
        } else if (percentAhead()) {
            body.kind = Body::Kind::Percent;
            while (percentAhead()) {
                body.conditions.push_back(parsePercentage());
                body.bodies.push_back(parseBody());
            }
            parseElse(body);
        } else {
            parseStatements(body.statements);
        }
        return body;
    }

    void parseElse(Body& body)
    {
        if (!isName("else"))
            return fail(peek().place, concat("expected 'else' to end the choice that starts at ", body.place.line, ":",
                                             body.place.column, ", found ", found()));
        take();
        need(":", "after 'else'");
        body.bodies.push_back(parseBody());
    }

    Expr parsePercentage()
    {
        Expr percentage = parseBinary(4);
        need("%", "after the percentage");
        need(":", "after '%'");
        return percentage;
    }

    void parseStatements(std::vector<Statement>& statements)
    {
        for (;;) {
            if (isSign("}") || isSign("|") || isSign("]") || isSign(")") || isName("else") || isName("case")) return;
            if (takeSign(";")) continue;
            if (declarationAhead() || percentAhead()) return;
            Statement statement;
            statement.place = peek().place;
            if (takeSign("[")) {
                statement.kind = StatementKind::Push;
                statement.body.push_back(parseBody());
                if (!takeSign("]"))
                    return fail(statement.place, concat("this '[' is never closed: expected ']', found ", found()));
            } else if (peek().kind == TokenKind::Name) {
                parseCall(statement);
            } else {
                return fail(peek().place, concat("expected an operation or a rule, found ", found()));
            }
            statements.push_back(std::move(statement));
        }
    }

    void parseCall(Statement& statement)
    {
        const Token name = take();
        if (const std::string_view advice = refusedOperation(name.text);
            !advice.empty()) // before its arguments, which may be words of its own
            return fail(name.place, concat("the operation '", name.text, "' is not supported: ", advice));
        statement.name = intern(name.text); // resolve.cpp decides what it names
        if (takeSign("(")) {
            while (!atEnd() && !isSign(")")) {
                statement.args.push_back(parseSize());
                if (!isSign(")")) need(",", "between arguments");
            }
            need(")", "after the arguments");
        }
        if (isSign("{")) statement.block = parseBlock(name.text == "split");
    }

    std::shared_ptr<Block> parseBlock(bool sizes)
    {
        Nest nest(*this);
        auto block = std::make_shared<Block>();
        if (tooDeep()) return block;
        const Place start = take().place;
        for (;;) {
            if (isSign("{") || (isName("split") && isSign("(", 1))) {
                if (isName("split")) { // old files nest split(y){ .. }* without a size
                    take();
                    skipParentheses();
                    if (!isSign("{"))
                        return fail(peek().place, concat("expected '{' after split(..), found ", found())), block;
                }
                BlockElement element;
                element.place = peek().place;
                if (!sizes) return fail(element.place, "only split nests blocks"), block;
                element.nested = parseBlock(true);
                block->elements.push_back(std::move(element));
            } else if (!isSign("|") && !isSign("}") && !atEnd()) {
                parseElement(*block, sizes);
            }
            if (takeSign("|")) continue;
            if (takeSign("}")) break;
            return fail(peek().place, concat("expected '|' or '}' in the block that opens at ", start.line, ":",
                                             start.column, ", found ", found())),
                   block;
        }
        block->repeat = takeSign("*");
        return block;
    }

    void parseElement(Block& block, bool sizes)
    {
        BlockElement element;
        element.place = peek().place;
        element.size = parseSize(); // of a part of split; else the selector, which words.cpp reads
        element.combine = isSign("=") || isSign("=:");
        if (!takeSign(":") && !takeSign("=") && !takeSign("=:"))
            return fail(peek().place,
                        concat("expected ':' after the ", sizes ? "size" : "selector", ", found ", found()));
        element.body = parseBody();
        block.elements.push_back(std::move(element));
    }

    // ---- expressions
    Size parseSize()
    {
        const bool outerAllowed = sizeAllowed_;
        const SizeKind outerKind = sizeKind_;
        sizeAllowed_ = true;
        sizeKind_ = SizeKind::Absolute;
        Size size;
        size.value = parseExpr();
        size.kind = sizeKind_;
        sizeAllowed_ = outerAllowed;
        sizeKind_ = outerKind;
        return size;
    }

    Expr make(ExprKind kind, Place place, u32 index, std::vector<Expr> args)
    {
        Expr expr;
        expr.kind = kind;
        expr.place = place;
        expr.index = index;
        for (const Expr& arg : args) expr.depth = std::max(expr.depth, arg.depth + 1);
        expr.args = std::move(args);
        if (expr.depth > kMaxNesting) {
            fail(place, concat("this expression nests deeper than ", kMaxNesting, " levels: split it into functions"));
            return {};
        }
        return expr;
    }

    Expr parseExpr()
    {
        Nest nest(*this);
        if (tooDeep()) return {};
        const Place place = peek().place;
        const bool cases = isName("case");
        if (!cases && !percentAhead()) return parseBinary(0);
        std::vector<Expr> args;
        while (cases ? isName("case") : percentAhead()) {
            if (cases) {
                take();
                args.push_back(parseExpr());
                need(":", "after the condition of 'case'");
            } else {
                args.push_back(parsePercentage());
            }
            args.push_back(parseExpr());
        }
        if (!isName("else"))
            fail(peek().place, concat("expected 'else' to end the choice that starts at ", place.line, ":",
                                      place.column, ", found ", found()));
        take();
        need(":", "after 'else'");
        args.push_back(parseExpr());
        return make(cases ? ExprKind::Cases : ExprKind::Percent, place, 0, std::move(args));
    }

    std::optional<BinaryOp> binaryAhead(u32 level) const
    {
        struct Row
        {
            std::string_view sign;
            u32 level;
            BinaryOp op;
        };
        static constexpr Row kRows[] = {
            {"||", 0, BinaryOp::Or},        {"&&", 1, BinaryOp::And},          {"==", 2, BinaryOp::Equal},
            {"!=", 2, BinaryOp::NotEqual},  {"<", 3, BinaryOp::Less},          {">", 3, BinaryOp::Greater},
            {"<=", 3, BinaryOp::LessEqual}, {">=", 3, BinaryOp::GreaterEqual}, {"+", 4, BinaryOp::Add},
            {"-", 4, BinaryOp::Subtract},   {"*", 5, BinaryOp::Multiply},      {"/", 5, BinaryOp::Divide},
            {"%", 5, BinaryOp::Modulo}};
        for (const Row& row : kRows)
            if (row.level == level && isSign(row.sign) && !(row.op == BinaryOp::Modulo && isSign(":", 1)))
                return row.op;
        return {};
    }

    Expr parseBinary(u32 level)
    {
        if (level == 6) return parseUnary();
        Expr left = parseBinary(level + 1);
        while (const auto op = binaryAhead(level)) {
            const Place place = take().place;
            std::vector<Expr> args;
            args.push_back(std::move(left));
            args.push_back(parseBinary(level + 1));
            left = make(ExprKind::Binary, place, u32(*op), std::move(args));
        }
        return left;
    }

    Expr parseUnary()
    {
        Nest nest(*this);
        if (tooDeep()) return {};
        const Place place = peek().place;
        if (takeSign("+")) return parseUnary();
        if (isSign("'") || isSign("~")) {
            const SizeKind kind = isSign("'") ? SizeKind::Relative : SizeKind::Floating;
            if (!sizeAllowed_)
                return fail(place, concat(found(), " belongs to sizes: in arguments of s, t and split")), Expr{};
            if (sizeKind_ != SizeKind::Absolute)
                return fail(place, "a size has one ' or ~, for the whole of it"), Expr{};
            sizeKind_ = kind; // for the whole size expression, wherever the sign stands
            take();
            return parseUnary();
        }
        if (isSign("-") || isSign("!")) {
            const bool negate = take().text == "-";
            std::vector<Expr> args;
            args.push_back(parseUnary());
            return make(negate ? ExprKind::Negate : ExprKind::Not, place, 0, std::move(args));
        }
        return parsePrimary();
    }

    Expr parsePrimary()
    {
        const Token token = peek();
        Expr expr;
        expr.place = token.place;
        if (token.kind == TokenKind::Number) {
            take();
            expr.number = token.number;
        } else if (token.kind == TokenKind::Text) {
            take();
            expr.kind = ExprKind::Text;
            expr.text = token.text;
        } else if (takeSign("(")) {
            // ' and ~ inside parentheses still mean the whole size, as in '(1 - x).
            expr = parseExpr();
            if (!takeSign(")"))
                fail(peek().place, concat("expected ')' to close the parenthesis at ", token.place.line, ":",
                                          token.place.column, ", found ", found()));
        } else if (isSign("[")) {
            fail(token.place, "arrays are not supported: use case/else or a percentage to choose a value");
        } else if (token.kind == TokenKind::Name) {
            expr = parseName();
        } else {
            fail(token.place, concat("expected a value, found ", found()));
        }
        return expr;
    }

    Expr parseName()
    {
        const Token name = take();
        if (name.text == "true" || name.text == "false") {
            Expr expr = make(ExprKind::Bool, name.place, 0, {});
            expr.number = name.text == "true";
            return expr;
        }
        std::vector<Expr> args;
        const bool call = isSign("(");
        if (takeSign("(")) {
            const bool outerAllowed = sizeAllowed_;
            sizeAllowed_ = false;
            while (!atEnd() && !isSign(")")) {
                args.push_back(parseExpr());
                if (!isSign(")")) need(",", "between arguments");
            }
            need(")", "after the arguments");
            sizeAllowed_ = outerAllowed;
        }
        if (call && isSign("{")) fail(peek().place, "arrays are not supported, so comp cannot be used as a function");
        if (isSign("[") && peek().place.line == name.place.line &&
            peek().place.column == name.place.column + name.text.size())
            fail(peek().place, "arrays are not supported: use case/else or a percentage to choose a value");
        Expr expr = make(ExprKind::Keyword, name.place, 0, std::move(args));
        expr.text = name.text;
        return expr;
    }

    bool startNext_ = false;
    bool sizeAllowed_ = false;
    SizeKind sizeKind_ = SizeKind::Absolute;
    std::map<std::string, u32> nameIndex_;
    std::shared_ptr<Program> program_;
};

} // namespace

Result<std::shared_ptr<Program>> parseProgram(std::string_view text, std::string_view fileName)
{
    auto tokens = tokenize(text, fileName);
    if (!tokens) return tokens.error();
    return Parser(std::move(*tokens), fileName).run();
}

} // namespace helio::cga
