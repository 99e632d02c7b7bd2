// SPDX-License-Identifier: Apache-2.0
// The traps of CGA's syntax, and the messages for text that is refused.
#include <algorithm>

#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

double reported(std::string_view rules, const std::string& key)
{
    const Derivation derivation = mustDerive(rules, {boxFootprint(10, 8, 6)});
    const auto found = derivation.reports.find(key);
    return found == derivation.reports.end() ? NAN : found->second;
}

// (a) no separator between statements: a declaration starts where NAME [(..)] is followed by --> or =
TEST(GrammarParse, DeclarationsNeedNoSeparator)
{
    EXPECT_EQ(reported("Lot --> A(2) B C\n f(x) = x + 1 A(n) --> report(\"k\", f(n)) X. B --> report(\"k\", 10) X. C "
                       "--> report(\"k\", 100) X.",
                       "k"),
              113);
}

// (b) % is modulo, and percent where ':' follows
TEST(GrammarParse, PercentAndModulo)
{
    EXPECT_EQ(
        reported("Lot --> report(\"k\", 7 % 4) C\nC --> 100% : A else : B\nA --> report(\"k\", 10) X. B --> NIL", "k"),
        13);
    EXPECT_EQ(reported("f = 100% : 17 % 5 else : 1\nLot --> report(\"k\", f) X.", "k"), 2);
    EXPECT_EQ(reported("attr share = 40\nLot --> (share + 60)% : report(\"k\", 1) X. else : report(\"k\", 2) X.", "k"),
              1);
}

// (c) ' and ~ apply to the whole size expression, wherever they stand in it
TEST(GrammarParse, SizeSignsCoverTheWholeExpression)
{
    // scope.sx = 10: '0.2*4 is 8 m; ~1 + 1 is a floating 2 beside a floating 2, so 1 m each of the remaining 2 m.
    const Derivation d =
        mustDerive("Lot --> split(x) { '0.2*4 : A. | ~1 + 1 : B. | ~2 : C. }", {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(areaOf(d, "A"), 64, 1e-9);
    EXPECT_NEAR(areaOf(d, "B"), 8, 1e-9);
    EXPECT_NEAR(areaOf(d, "C"), 8, 1e-9);
    const Derivation e = mustDerive("Lot --> t(-'0.5, 0, 0) A.", {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(boundsOf(e, *leavesOf(e, "A")[0]).first.x, -5, 1e-9);
}

// (d) #rrggbb only occurs inside strings; a bare # is a comment
TEST(GrammarParse, HashIsAComment)
{
    const Derivation d = mustDerive("# a comment\nLot --> color(\"#ff0000\") A. # another\n// and\n/* this\n*/",
                                    {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(d.shapes.surfaces[leavesOf(d, "A")[0]->surface].rho.r, 0.95, 1e-12); // clamped: nothing reflects all
}

// (e) '[' is push in a successor; arrays in expressions are refused
TEST(GrammarParse, BracketsPushOrAreRefused)
{
    const Derivation d = mustDerive("Lot --> [ t(1, 0, 0) A. ] B.", {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(boundsOf(d, *leavesOf(d, "A")[0]).first.x, 1, 1e-9);
    EXPECT_NEAR(boundsOf(d, *leavesOf(d, "B")[0]).first.x, 0, 1e-9);
    EXPECT_EQ(errorOf("a = [1, 2]\nLot --> X."),
              "t.cga:1:5: arrays are not supported: use case/else or a percentage to choose a value");
    EXPECT_EQ(errorOf("a = 1\nLot --> report(\"k\", a[0]) X.").substr(0, 11), "t.cga:2:22:");
}

// (f) case inside [ ] and inside { } elements, nested and as values
TEST(GrammarParse, CaseAnywhere)
{
    EXPECT_EQ(
        reported(
            "Lot --> [ case scope.sx > 5 : A else : B ] split(x) { 4 : case split.index == 0 : A else : B | ~1 : B }\n"
            "A --> report(\"k\", 1) X. B --> report(\"k\", 10) X.",
            "k"),
        12);
    EXPECT_EQ(reported("Lot --> case 1 > 2 : A else : case 2 > 1 : case 3 > 4 : A else : B else : A\nA --> "
                       "report(\"k\", 1) X. B --> report(\"k\", 10) X.",
                       "k"),
              10);
    EXPECT_EQ(
        reported(
            "f(n) = case n > 1 : case n > 2 : 3 else : 2 else : 1\nLot --> report(\"k\", f(1) + 10*f(2) + 100*f(3)) X.",
            "k"),
        321);
}

// (g) parentheses are optional for calls without arguments
TEST(GrammarParse, OptionalParentheses)
{
    EXPECT_EQ(
        reported("f = 2\nLot --> report(\"k\", geometry.area + geometry.area() + f + f()) A()\nA --> primitiveQuad X.",
                 "k"),
        164);
}

// (h) escapes in strings; (i) dotted names and terminals
TEST(GrammarParse, StringsAndNames)
{
    EXPECT_EQ(
        reported(
            R"(Lot --> report("a\"b", len("x\"y\\")) set(material.color.r, 0.5) report("a\"b", material.color.r) X.)",
            "a\"b"),
        4.5);
    const Derivation d = mustDerive("Lot --> Wall.\nWall --> NIL", {boxFootprint(10, 8, 6)});
    EXPECT_EQ(leavesOf(d, "Wall").size(), 1u); // the terminal, not the rule of the same name
}

// (j) old files nest split(y){ .. }* without a size
TEST(GrammarParse, LegacyNestedSplit)
{
    const Derivation d = mustDerive("Lot --> split(x) { 1 : A. | split(x) { 3 : B. }* }", {boxFootprint(10, 8, 6)});
    EXPECT_EQ(leavesOf(d, "B").size(), 3u);
}

TEST(GrammarParse, VersionAnnotationsAndStart)
{
    const Derivation d = mustDerive("\xEF\xBB\xBFversion \"2021.0\"\n@Group(\"Mass\", 1) @Range(min=3, max=(4))\nattr "
                                    "a = 1\n@Hidden\n@StartRule\nBegin --> A.\nLot --> B.",
                                    {boxFootprint(10, 8, 6)});
    EXPECT_EQ(leavesOf(d, "A").size(), 1u);
    EXPECT_EQ(leavesOf(d, "B").size(), 0u);
}

TEST(GrammarParse, AllThreeSelectorSigns)
{
    const Derivation d =
        mustDerive("Lot --> extrude(6) comp(f) { top = Top. | front : Front. | side =: Rest. | bottom : NIL }",
                   {boxFootprint(10, 8, 6)});
    EXPECT_EQ(leavesOf(d, "Rest").size(), 1u); // one shape of three faces
    EXPECT_NEAR(areaOf(d, "Rest"), 6 * (8 + 10 + 8), 1e-9);
}

// ---- refusals: file:line:column, what is wrong, what to use
TEST(GrammarParse, RefusalsNameThePlace)
{
    EXPECT_EQ(errorOf("Lot --> extrude(5)\n  frobnicate(3) X."),
              "t.cga:2:3: unknown operation or rule 'frobnicate': city/README.md lists what is read");
    EXPECT_EQ(errorOf("Lot -->\n  extrude(9) comp(f) { top : envelope(normal, 30) { X. } }").substr(0, 58),
              "t.cga:2:30: the operation 'envelope' is not supported: use");
    EXPECT_EQ(errorOf("Lot --> inline(unify) { A }").substr(0, 39), "t.cga:1:9: the operation 'inline' is no");
    EXPECT_EQ(errorOf("Lot --> X.\nextension Roof --> X."),
              "t.cga:2:1: 'extension' is not supported: leave it out, and declare the rule in a style");
    EXPECT_EQ(errorOf("Lot --> extrude(heigth) X.").substr(0, 36), "t.cga:1:17: unknown name 'heigth': d");
    EXPECT_EQ(errorOf("a = fileRandom(\"*.jpg\")\nLot --> X.").substr(0, 50),
              "t.cga:1:5: the function 'fileRandom' is not suppor");
    EXPECT_EQ(errorOf("Lot --> comp(m) { all : X. }").substr(0, 37), "t.cga:1:9: comp(m) is not supported: ");
    EXPECT_EQ(errorOf("Lot --> comp(f) { fron : X. }").substr(0, 36), "t.cga:1:19: unknown selector 'fron':");
    EXPECT_EQ(errorOf("Lot --> split(u) { 1 : X. }").substr(0, 30), "t.cga:1:9: split(u) is not sup");
    EXPECT_EQ(errorOf("Lot --> A(1)\nA --> X.").substr(0, 47), "t.cga:1:9: rule 'A' takes 0 arguments, not 1");
    EXPECT_EQ(errorOf("f(x) = x\nLot --> report(\"k\", f) X.").substr(0, 43),
              "t.cga:2:21: 'f' takes 1 arguments, not 0");
    EXPECT_EQ(errorOf("Lot --> s(1, 2) X.").substr(0, 43), "t.cga:1:9: 's' takes 3 arguments, not 2: wr");
    EXPECT_EQ(errorOf("Lot --> A\nA --> X.\nA --> Y.").substr(0, 21), "t.cga:3:1: rule 'A' w");
}

TEST(GrammarParse, AChoiceIsAWholeBody)
{
    const std::string message =
        "a choice (case, or a percentage) must be the whole body of a rule: put it into [ ] or into a rule of its own";
    EXPECT_EQ(errorOf("Lot --> extrude(3) case 1 > 2 : A. else : B."), "t.cga:1:20: " + message);
    EXPECT_EQ(errorOf("Lot --> extrude(3) 30% : A. else : B."), "t.cga:1:20: " + message);
}

TEST(GrammarParse, UnterminatedText)
{
    EXPECT_EQ(errorOf("Lot --> color(\"#ff"),
              "t.cga:1:15: this string is never closed: end it with \" on the same line");
    EXPECT_EQ(errorOf("Lot --> X.\n /* never"), "t.cga:2:2: this comment is never closed: end it with */");
    EXPECT_EQ(errorOf("Lot --> split(x) {\n 1 : A."),
              "t.cga:2:8: expected '|' or '}' in the block that opens at 1:18, found the end of the file");
    EXPECT_EQ(errorOf("Lot --> [ A."), "t.cga:1:9: this '[' is never closed: expected ']', found the end of the file");
    EXPECT_EQ(errorOf("Lot --> case 1 > 2 : A."),
              "t.cga:1:24: expected 'else' to end the choice that starts at 1:9, found the end of the file");
    EXPECT_EQ(errorOf("Lot --> extrude(3"), "t.cga:1:18: expected ',' between arguments, found the end of the file");
    EXPECT_EQ(errorOf("").substr(0, 39), "t.cga:1:1: the file declares no rule: w");
    EXPECT_EQ(errorOf("Lot --> X. \x01").substr(0, 12), "t.cga:1:12: ");
}

TEST(GrammarParse, DeepNestingIsRefused)
{
    const auto deep = [](std::string open, std::string inner, std::string close, int n) {
        std::string text;
        for (int k = 0; k < n; ++k) text += open;
        text += inner;
        for (int k = 0; k < n; ++k) text += close;
        return text;
    };
    const std::string blocks = deep("split(x) { 1 : ", "X.", " }", 20000), parentheses = deep("(", "1", ")", 20000),
                      pushes = deep("[ ", "X.", " ]", 20000);
    EXPECT_NE(errorOf("Lot --> " + blocks).find("nested deeper than"), std::string::npos);
    EXPECT_NE(errorOf("Lot --> " + pushes).find("nested deeper than"), std::string::npos);
    EXPECT_NE(errorOf("a = " + parentheses + "\nLot --> X.").find("nested deeper than"), std::string::npos);
    EXPECT_NE(errorOf("a = " + deep("-", "1", "", 20000) + "\nLot --> X.").find("nested deeper than"),
              std::string::npos);
    EXPECT_NE(errorOf("a = 1" + deep("+1", "", "", 20000) + "\nLot --> X.").find("nests deeper than"),
              std::string::npos);
    EXPECT_NE(errorOf("Lot --> " + deep("case 1 > 0 : ", "X.", " else : X.", 20000)).find("nested deeper than"),
              std::string::npos);
}

// Every prefix of a correct file, and the file with any one byte replaced, gives rules or errors that start with the
// place.
TEST(GrammarParse, AnyTextGivesRulesOrErrors)
{
    const std::string text = "version \"2021.0\"\n@Range(min=1)\nattr a = 30% : '1' else : 2 + f(3, \"x\\\"\")\nf(x, "
                             "y) = case x > 1 && !(y == \"b\") : x else : -x\n"
                             "Lot --> [ s('1, ~2, 3) X. ] split(x) { ~1 : A(a) | { '0.2 : B }* | 1.5 : NIL }* comp(f) "
                             "{ side = A. | 0 : B }\n";
    const auto check = [](const std::string& rules) {
        const auto parsed = parseRules(rules, "t.cga");
        if (parsed.ok()) return;
        const std::string& message = parsed.error().message;
        EXPECT_EQ(message.rfind("t.cga:", 0), 0u) << message;
        EXPECT_LE(std::count(message.begin(), message.end(), '\n'), 60) << message;
    };
    for (size_t length = 0; length < text.size(); ++length) check(text.substr(0, length));
    for (size_t k = 0; k < text.size(); ++k)
        for (const char c : {'(', '}', '"', '%', '\'', '.', '-', '\0', '\xFF'}) {
            std::string changed = text;
            changed[k] = c;
            check(changed);
        }
}

} // namespace
} // namespace helio::test
