// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/parser.h"

#include <charconv>
#include <utility>

#include "city/grammar/body_parser.h"

namespace helio::cga {

namespace {

/// Recursive descent over the declarations of a file.
class FileParser : BodyParser
{
public:
    FileParser(std::string_view text, u32 file, NameTable& names, ErrorList& errors)
        : BodyParser(tokenize(text, file, errors), names, errors), text_(text)
    {
        file_.sections.emplace_back().place.file = file;
    }

    ParsedFile run()
    {
        file_.namesLost = endsBadly();
        while (!atEnd()) {
            const size_t begin = position();
            name_.clear();
            nameLost_ = false;
            parseItem();
            if (!failed()) continue;
            file_.namesLost = file_.namesLost || nameLost_;
            if (!name_.empty()) file_.brokenNames.insert(name_);
            annotations_.clear();
            recoverAtDeclaration(begin);
        }
        return std::move(file_);
    }

private:
    StyleSection& section() { return file_.sections.back(); }

    void parseItem()
    {
        const Token first = peek();
        if (takeSign(";")) return;
        if (takeSign("@")) return parseAnnotation();
        if (isName("version") && peek(1).kind == TokenKind::Text) {
            take();
            take();
        } else if (isName("import") && peek(1).kind == TokenKind::Name) {
            parseImport();
        } else if (isName("style") && peek(1).kind == TokenKind::Name) {
            parseStyle();
        } else if (isName("dynamic") && isName("import", 1)) {
            fail(first.place, "dynamic imports are not supported: import each file by its name and choose with case");
        } else if (isName("case") || percentAhead()) {
            fail(first.place, "a choice (case, or a percentage) must be the whole body of a rule: put it into [ ] or "
                              "into a rule of its own");
        } else if (first.kind == TokenKind::Name && !isName("else")) {
            parseDeclaration();
        } else {
            fail(first.place,
                 concat("expected a declaration such as  Name --> ...  or  attr name = value, found ", found()));
        }
    }

    // ---- annotations
    void parseAnnotation()
    {
        Annotation annotation;
        annotation.name = needName("an annotation's name after '@'").text;
        if (takeSign("(")) {
            while (!atEnd() && !isSign(")")) {
                annotation.arguments.push_back(parseArgument());
                if (!isSign(")")) need(",", "between the arguments of an annotation");
            }
            need(")", "after the arguments of an annotation");
        }
        annotations_.push_back(std::move(annotation));
    }

    Annotation::Argument parseArgument()
    {
        Annotation::Argument argument;
        if (peek().kind == TokenKind::Name && isSign("=", 1)) {
            argument.key = take().text;
            take();
        }
        const size_t begin = position();
        const Token first = peek();
        while (!atEnd() && !isSign(",") && !isSign(")")) {
            if (isSign("(") || isSign("[") || isSign("{"))
                skipBrackets();
            else if (peek().kind == TokenKind::Bad)
                fail(peek().place, "");
            else
                take();
        }
        const bool single = position() == begin + 1;
        argument.text = single && first.kind == TokenKind::Text ? first.text : written(text_, begin);
        double number = 0.0;
        const char* const end = argument.text.data() + argument.text.size();
        const auto result = std::from_chars(argument.text.data(), end, number);
        if (first.kind != TokenKind::Text && result.ec == std::errc() && result.ptr == end) argument.number = number;
        return argument;
    }

    // ---- imports and styles
    void parseImport()
    {
        nameLost_ = true;
        ImportDeclaration item;
        item.place = take().place;
        item.id = take().text;
        if (takeSign("(")) {
            item.style = needName("a style's name").text;
            while (takeSign(",")) needName("a style's name"); // a menu to choose from: the first is in force
            need(")", "after the style");
        }
        need(":", "between the import's name and its file");
        if (peek().kind == TokenKind::Name)
            return fail(peek().place,
                        "dynamic imports are not supported: write the file's name in quotes, and choose with case");
        if (peek().kind != TokenKind::Text)
            return fail(peek().place, concat("expected the name of a file in quotes, found ", found()));
        item.path = take().text;
        if (takeSign("(")) {
            item.protectsAll = isSign(")");
            while (!atEnd() && !isSign(")")) parseOverride(item);
            need(")", "after the import's attributes");
        }
        if (failed()) return;
        annotations_.clear();
        file_.imports.push_back(std::move(item));
    }

    void parseOverride(ImportDeclaration& item)
    {
        ImportDeclaration::Override entry;
        entry.place = peek().place;
        entry.name = needName("the name of an attribute of the imported file").text;
        if (isSign("-->"))
            return fail(peek().place, "rules of an imported file cannot be replaced: declare a style there");
        if (takeSign("=")) {
            const size_t begin = position();
            entry.value = parseExpr();
            entry.source = source(begin);
        }
        takeSign(",");
        item.overrides.push_back(std::move(entry));
    }

    void parseStyle()
    {
        nameLost_ = true;
        StyleSection style;
        style.place = take().place;
        style.name = take().text;
        if (takeName("extends")) {
            const Token base = needName("the style that is extended");
            if (failed()) return;
            style.base = base.text;
            if (styles_.count(style.base) == 0)
                report(base.place, concat("no style '", style.base, "' is declared before this one"));
        }
        if (!styles_.insert(style.name).second)
            report(style.place, concat("style '", style.name, "' is declared twice"));
        annotations_.clear();
        declared_.clear();
        file_.sections.push_back(std::move(style));
    }

    // ---- declarations
    void parseDeclaration()
    {
        nameLost_ = true;
        GlobalKind kind = GlobalKind::Function;
        bool isGlobal = false;
        while (peek(1).kind == TokenKind::Name && !isName("with", 1)) {
            if (isName("attr"))
                kind = GlobalKind::Attribute;
            else if (isName("const"))
                kind = GlobalKind::Constant;
            else if (isName("start"))
                annotations_.push_back({"StartRule", {}});
            else if (isName("extension"))
                report(peek().place, "'extension' is not supported: leave it out, and declare the rule in a style");
            else
                break;
            isGlobal = isGlobal || isName("attr") || isName("const");
            take();
        }
        const Token name = take();
        for (const std::string_view word : {"attr", "const", "import", "style", "with"})
            if (name.text == word)
                return fail(name.place, concat("'", word,
                                               "' is a word of the language and cannot be a name: after it, "
                                               "expected a name, found ",
                                               found()));
        name_ = name.text;
        nameLost_ = false;
        if (name.text.back() == '.')
            return fail(name.place, concat("'", name.text, "' ends in a dot: terminals are used, not declared"));
        std::vector<std::string> parameters = parseParameters();
        std::vector<std::string> localNames;
        std::vector<Expr> locals;
        if (takeName("with")) parseLocals(localNames, locals);
        if (takeSign("-->")) {
            if (isGlobal) report(name.place, concat("'", name.text, "' is a rule: leave out attr and const"));
            if (findOperation(name.text))
                report(name.place, concat("'", name.text, "' is an operation: give the rule another name"));
            Rule rule;
            rule.name = names_.intern(name.text);
            rule.place = name.place;
            rule.parameters = std::move(parameters);
            rule.localNames = std::move(localNames);
            rule.locals = std::move(locals);
            rule.annotations = std::exchange(annotations_, {});
            rule.body = parseBody();
            if (failed()) return;
            if (!declared_.insert({name.text, rule.parameters.size(), true}).second)
                report(name.place,
                       concat("rule '", name.text, "' with ", rule.parameters.size(), " parameters is declared twice"));
            section().rules.push_back(std::move(rule));
        } else if (takeSign("=")) {
            if (kind != GlobalKind::Function && !parameters.empty())
                report(name.place,
                       concat("'", name.text, "' has parameters, so it is a function: leave out attr and const"));
            Global global;
            global.kind = kind;
            global.name = global.property = name.text;
            global.place = name.place;
            global.parameters = std::move(parameters);
            global.localNames = std::move(localNames);
            global.locals = std::move(locals);
            global.annotations = std::exchange(annotations_, {});
            const size_t begin = position();
            global.value = parseExpr();
            global.source = source(begin);
            if (failed()) return;
            if (!declared_.insert({name.text, global.parameters.size(), false}).second)
                report(name.place, concat("'", name.text, "' is declared twice"));
            section().globals.push_back(std::move(global));
        } else {
            fail(peek().place, concat("expected '-->' (a rule) or '=' (a function or attribute) after '", name.text,
                                      "', found ", found()));
        }
    }

    std::vector<std::string> parseParameters()
    {
        std::vector<std::string> parameters;
        if (!takeSign("(")) return parameters;
        std::set<std::string> seen;
        while (!atEnd() && !isSign(")")) {
            const Token parameter = needName("a parameter's name");
            if (!seen.insert(parameter.text).second)
                report(parameter.place, concat("the parameter '", parameter.text, "' is there twice"));
            parameters.push_back(parameter.text);
            if (!isSign(")")) need(",", "between parameters");
        }
        need(")", "after the parameters");
        return parameters;
    }

    void parseLocals(std::vector<std::string>& names, std::vector<Expr>& values)
    {
        std::set<std::string> seen;
        need("(", "after 'with'");
        while (!atEnd() && !isSign(")")) {
            const Token name = needName("the name of a local value");
            need(":=", "after the name of a local value");
            Expr value = parseExpr();
            takeSign(",");
            if (!seen.insert(name.text).second)
                report(name.place, concat("the local value '", name.text, "' is there twice"));
            names.push_back(name.text);
            values.push_back(std::move(value));
        }
        need(")", "after the values of 'with'");
    }

    /// The tokens from `begin` on as written, for user interfaces.
    std::string source(size_t begin) const
    {
        constexpr size_t kMaxShown = 240;
        std::string text = written(text_, begin);
        return text.size() > kMaxShown ? text.substr(0, kMaxShown) + "..." : text;
    }

    std::string_view text_;
    ParsedFile file_;
    std::string name_;      ///< of the declaration at hand, once it is known
    bool nameLost_ = false; ///< a declaration is at hand whose name is not known yet
    std::vector<Annotation> annotations_;
    std::set<std::string> styles_{"Default"};
    std::set<std::tuple<std::string, size_t, bool>> declared_; ///< in this section: name, parameters, is a rule
};

} // namespace

u32 NameTable::intern(const std::string& name)
{
    const auto [it, added] = index_.emplace(name, u32(names_.size()));
    if (added) names_.push_back(name);
    return it->second;
}

ParsedFile parseFile(std::string_view text, u32 file, NameTable& names, ErrorList& errors)
{
    return FileParser(text, file, names, errors).run();
}

} // namespace helio::cga
