// SPDX-License-Identifier: Apache-2.0
// What one run says about several mistakes: each once, in order, with the line and a caret.
#include <algorithm>

#include "city/grammar/error_list.h"
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

std::string errorsOf(std::string_view rules)
{
    const auto parsed = parseRules(rules, "t.cga");
    return parsed ? "no error" : parsed.error().message;
}

/// The places of the mistakes, `line:column` separated by spaces.
std::string placesOf(std::string_view rules)
{
    std::string places, rest = errorsOf(rules);
    while (!rest.empty()) {
        const std::string line = rest.substr(0, rest.find('\n'));
        rest.erase(0, std::min(rest.size(), line.size() + 1));
        if (line.rfind("t.cga:", 0) != 0) continue;
        const size_t colon = line.find(':', line.find(':', 6) + 1);
        places += concat(places.empty() ? "" : " ", line.substr(6, colon - 6));
    }
    return places;
}

TEST(GrammarErrors, ThreeMistakesAreThreeErrors)
{
    EXPECT_EQ(errorsOf("attr a = 5 +\n"
                       "Lot --> extrude(a) comp(f) { top : Roof | side : Wal(3) }\n"
                       "Roof --> color(\"#aabbcc) X.\n"
                       "Good --> X.\n"),
              "t.cga:2:1: expected a value, found 'Lot'\n"
              "    Lot --> extrude(a) comp(f) { top : Roof | side : Wal(3) }\n"
              "    ^\n"
              "t.cga:2:50: unknown operation or rule 'Wal': city/README.md lists what is read\n"
              "    Lot --> extrude(a) comp(f) { top : Roof | side : Wal(3) }\n"
              "                                                     ^\n"
              "t.cga:3:16: this string is never closed: end it with \" on the same line\n"
              "    Roof --> color(\"#aabbcc) X.\n"
              "                   ^");
}

TEST(GrammarErrors, TwentyAreShown)
{
    std::string text;
    for (int k = 1; k <= 25; ++k) text += concat("R", k, " --> frob(", k, ")\n");
    const std::string errors = errorsOf(text);
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '^'), 20);
    EXPECT_NE(errors.find("t.cga:20:"), std::string::npos);
    EXPECT_EQ(errors.find("t.cga:21:"), std::string::npos);
    const std::string end = "\nand more: these are the first 20 errors";
    EXPECT_EQ(errors.substr(errors.size() - end.size()), end);
    const std::string twenty = errorsOf(text.substr(0, text.find("R21")));
    EXPECT_EQ(std::count(twenty.begin(), twenty.end(), '^'), 20);
    EXPECT_EQ(twenty.find("and more"), std::string::npos);
}

TEST(GrammarErrors, AMistakeHasNoConsequences)
{
    // Inside blocks, the parser goes on at the next part.
    EXPECT_EQ(placesOf("Lot --> split(x) { 1 A | 2 : frob(1) | ~ : C | 4 : D }\nD --> frob(2)"), "1:22 1:30 1:42 2:7");
    EXPECT_EQ(placesOf("Lot --> split(x) { f(1 : A | { 2 : split(y) { 3 B | 4 : C } }* | 5 6 : D }"), "1:24 1:49 1:68");
    EXPECT_EQ(placesOf("Lot --> comp(f) { top A | side = frob(1) | all : B }"), "1:23 1:34");
    // A block that is never closed ends at the next declaration.
    EXPECT_EQ(placesOf("Lot --> split(x) { 1 : split(y) { 1 : A\nA --> X.\nB --> frob(1)"), "2:1 3:7");
    EXPECT_EQ(placesOf("Lot --> comp(f) { top : A\n  side = B }\nB --> frob(1)"), "2:3 3:7");
    // Too many of closing brackets
    EXPECT_EQ(placesOf("Lot --> split(x) { 1 : A } } )\nA --> frob(1)"), "1:28 2:7");
    // What uses a declaration that could not be read is right.
    EXPECT_EQ(placesOf("attr h = (3\nf(x) = x *\nR(a) --> [ A\nLot --> extrude(h) R(f(2))"), "2:1 3:1 3:10");
    EXPECT_EQ(placesOf("attr = 3\nLot --> extrude(h) frob(k)"), "1:1");
    EXPECT_EQ(placesOf("/* never\nLot --> X."), "1:1");
    EXPECT_EQ(placesOf("import a : \"a.cga\"\nLot --> extrude(a.h) a.Run(a.f(1))"), "1:1");
    // What is refused is read to its end.
    EXPECT_EQ(placesOf("b = 1\na = [1, 2, [3]] + b[7] + size(comp(f) { all : c })\n"
                       "Lot --> extrude(9) union { X } inline(unify) { Y } frob(1)"),
              "2:5 2:20 2:26 2:31 3:20 3:32 3:52");
    EXPECT_EQ(placesOf("extension Lot --> X.\nA --> frob(1)"), "1:1 2:7");
    // A choice that is no whole body, and a second `else`
    EXPECT_EQ(placesOf("Lot --> t(1, 0, 0) case 1 > 2 : A else : B\nA --> frob(1)"), "1:20 2:7");
    EXPECT_EQ(placesOf("Lot --> case 1 > 2 : A else : B else : C\nA --> frob(1)"), "1:33 2:7");
    EXPECT_EQ(placesOf("Lot --> X. $ ? \xC3\xA4\xC3\xB6 ! Y.\nA --> frob(1)"), "1:14 2:7");
}

/// The first line of the errors.
std::string firstOf(std::string_view rules)
{
    const std::string errors = errorsOf(rules);
    return errors.substr(0, errors.find('\n'));
}

TEST(GrammarErrors, UnknownWordsAreNamed)
{
    EXPECT_EQ(firstOf("Lot --> comp(q) { all : A }"),
              "t.cga:1:9: 'comp' does not know the bare word 'q': write comp(f) { front : Front | side : Wall | top : "
              "Roof }");
    EXPECT_EQ(firstOf("Lot --> split(w) { 1 : A }"),
              "t.cga:1:9: 'split' does not know the bare word 'w': write split(x) { 1 : A | ~2 : B }");
    EXPECT_EQ(firstOf("Lot --> split(3) { 1 : A }"),
              "t.cga:1:9: a bare word is missing in 'split': write split(x) { 1 : A | ~2 : B }");
    EXPECT_NE(firstOf("Lot --> scatter(surface, 5, evenly) { A }").find("the bare words 'surface', 'evenly':"),
              std::string::npos);
    for (const char* word : {"g", "m", "h"})
        EXPECT_EQ(firstOf(concat("Lot --> comp(", word, ") { all : A }")),
                  concat("t.cga:1:9: comp(", word,
                         ") is not supported: faces have no groups, materials or holes of their own: use comp(f) and "
                         "select faces by where they look"));
    for (const char* word : {"u", "v"})
        EXPECT_EQ(firstOf(concat("Lot --> split(", word, ") { 1 : A }")),
                  concat("t.cga:1:9: split(", word,
                         ") is not supported: there are no texture coordinates: use split(x), split(y) or split(z)"));
}

TEST(GrammarErrors, SetNeedsAnAttribute)
{
    EXPECT_NE(firstOf("Lot --> set(tint, 3) A").find("'tint': declare attr tint = .."), std::string::npos);
    EXPECT_NE(firstOf("const tint = 2\nLot --> set(tint, 3) A").find("'tint' is a constant: declare it with attr"),
              std::string::npos);
    EXPECT_EQ(errorsOf("attr tint = 2\nLot --> set(tint, 3) A.\n"), "no error");
}

TEST(GrammarErrors, SelectorsAreNoExpressions)
{
    for (const char* selector : {"front && side", "!front", "front || top"})
        EXPECT_EQ(firstOf(concat("Lot --> comp(f) { ", selector, " : A }")).substr(0, 95),
                  "t.cga:1:19: boolean expressions of selectors are not supported: use one selector after another;")
            << selector;
    EXPECT_EQ(firstOf("Lot --> comp(f) { \"front\" : A }"),
              "t.cga:1:19: a selector is a bare word: write front without quotes");
    EXPECT_NE(firstOf("Lot --> comp(f) { tagged(1) : A }").find("unknown selector 'tagged(..)': use front,"),
              std::string::npos);
}

TEST(GrammarErrors, FunctionsAreNoOperations)
{
    EXPECT_EQ(firstOf("Lot --> rint(3) A."),
              "t.cga:1:9: 'rint' is a function: use it in a value, as in s(rint(..), 1, 1)");
    EXPECT_EQ(firstOf("f(x) = x\nLot --> f(3) A."),
              "t.cga:2:9: 'f' is a function: use it in a value, as in s(f(..), 1, 1)");
    EXPECT_EQ(firstOf("Lot --> contextCount(inter, \"a\") A."),
              "t.cga:1:9: the function 'contextCount' is not supported: use touches(inter), which knows the walls that "
              "neighbours cover");
    EXPECT_EQ(errorsOf("Lot --> rint(3)\nrint(n) --> A."), "no error"); // a rule of this name
}

TEST(GrammarErrors, BlocksAndSizesSayWhereTheyBelong)
{
    EXPECT_EQ(firstOf("Lot --> Part { 1 : A }"),
              "t.cga:1:9: unknown operation 'Part': a block { .. } belongs to split, comp, setback, setbackPerEdge, "
              "innerRectangle, shapeL, shapeU, shapeO and scatter, not to a rule");
    const std::string sizes = "' (relative to the scope) belongs to sizes of s, t, scatter and split, ~ to those of "
                              "split";
    EXPECT_EQ(firstOf("Lot --> extrude('2) A."), concat("t.cga:1:18: ", sizes, ", not to 'extrude'"));
    EXPECT_EQ(firstOf("Lot --> s(~2, 1, 1) A."), concat("t.cga:1:12: ", sizes, ", not to 's'"));
    EXPECT_EQ(firstOf("Lot --> A('2)\nA(x) --> B."), concat("t.cga:1:12: ", sizes, ": a rule takes plain values"));
}

TEST(GrammarErrors, AnnotationsAndSeparators)
{
    EXPECT_EQ(placesOf("@Range(min=1, (\nattr a = 1\nLot --> frob(1)"), "1:15 3:9");
    EXPECT_EQ(placesOf("@ 3\nattr a = 1\nLot --> frob(1)"), "1:3 3:9");
    EXPECT_EQ(errorsOf("attr a = 1; const b = 2;; Lot --> X.; ; A --> Y.;"), "no error");
}

TEST(GrammarErrors, ExcerptsShowTheColumn)
{
    EXPECT_EQ(cga::excerptOf("one\n\ttwo\tthree\r\nfour", {2, 6}), "    \ttwo\tthree\n    \t   \t^");
    EXPECT_EQ(cga::excerptOf("one\n\n  \nfour", {2, 1}), "");
    EXPECT_EQ(cga::excerptOf("one", {1, 4}), "    one\n       ^");
    EXPECT_EQ(cga::excerptOf("one", {7, 1}), "");
    EXPECT_EQ(cga::excerptOf("\xEF\xBB\xBFone", {1, 2}), "    one\n     ^");
    EXPECT_EQ(cga::excerptOf("\"\xC3\xA4\" ?", {1, 5}), "    \"\xC3\xA4\" ?\n        ^"); // 2 bytes, 1 column
    EXPECT_EQ(cga::excerptOf("a\x1b[31m ?", {1, 2}), "    a [31m ?\n     ^");             // not to the terminal
}

TEST(GrammarErrors, LongLinesAreCutAroundTheColumn)
{
    const std::string line = std::string(1000, 'a') + "?" + std::string(1000, 'b');
    EXPECT_EQ(cga::excerptOf(line, {1, 1001}),
              "    ..." + std::string(60, 'a') + "?" + std::string(39, 'b') + "...\n    " + std::string(63, ' ') + "^");
    EXPECT_EQ(cga::excerptOf(line, {1, 1}), "    " + std::string(100, 'a') + "...\n    ^");
    EXPECT_EQ(cga::excerptOf(line, {1, 2002}),
              "    ..." + std::string(60, 'b') + "\n    " + std::string(63, ' ') + "^");
}

} // namespace
} // namespace helio::test
