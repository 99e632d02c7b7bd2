// SPDX-License-Identifier: Apache-2.0
// Imports, styles and local values: which declaration a name means.
#include "city/grammar/program.h"
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

using Files = std::map<std::string, std::string>;

RuleOptions reading(const Files& files, std::string style = "")
{
    RuleOptions options;
    options.style = std::move(style);
    options.readImport = [files](const std::string& path) -> Result<std::string> {
        const auto found = files.find(path);
        if (found == files.end()) return Error{path + ": there is no such file"};
        return found->second;
    };
    return options;
}

/// The first line of the error of rules that must be refused.
std::string refusal(std::string_view text, const RuleOptions& options, std::string_view name = "main.cga")
{
    const auto rules = parseRules(text, name, options);
    return rules ? "no error" : rules.error().message.substr(0, rules.error().message.find('\n'));
}

/// What the rules report under "k" on a box of 10 x 8 m.
double reported(std::string_view text, const RuleOptions& options, std::map<std::string, Attribute> properties = {},
                std::map<std::string, Attribute> set = {})
{
    const auto rules = parseRules(text, "main.cga", options);
    EXPECT_TRUE(rules.ok()) << (rules ? "" : rules.error().message);
    if (!rules) return NAN;
    Footprint footprint = boxFootprint(10, 8, 0);
    footprint.attributes = std::move(properties);
    DeriveOptions derivation = unitAssets();
    derivation.attributes = std::move(set);
    const auto derived = derive(*rules, std::vector{footprint}, derivation);
    EXPECT_TRUE(derived.ok()) << (derived ? "" : derived.error().message);
    if (!derived) return NAN;
    const auto found = derived->reports.find("k");
    return found == derived->reports.end() ? NAN : found->second;
}

// ---- imports
TEST(GrammarImport, NamesOfImportsStartWithTheirId)
{
    const RuleOptions options =
        reading({{"part.cga", "attr size = 3\nconst twice = 2 * size\nadd(x) = x + twice\nLot --> Own\n"
                              "Own --> report(\"k\", add(100)) Wall."}});
    // add and twice are found inside part.cga, Own as well, although the importing file has rules of these names.
    EXPECT_EQ(reported("import part : \"part.cga\"\nOwn --> NIL\nadd(x) = 0\ntwice = 0\nLot --> part.Lot", options),
              106);
    EXPECT_EQ(
        reported("import part : \"part.cga\"\nLot --> report(\"k\", part.add(part.size) + part.twice) X.", options),
        3 + 6 + 6);
    const auto rules = parseRules("import part : \"part.cga\"\nLot --> part.Lot part.Wall", "main.cga", options);
    ASSERT_TRUE(rules.ok());
    EXPECT_EQ(rules->ruleNames(), (std::vector<std::string>{"Lot", "part.Lot", "part.Own"}));
    EXPECT_EQ(rules->attributeNames(), std::vector<std::string>{"part.size"});
    EXPECT_EQ(rules->program().warnings.size(), 1u); // part.Wall is a terminal there, not a rule
}

TEST(GrammarImport, AnAttributeOfTheImportingFileStandsForTheImportedOne)
{
    const Files files{{"part.cga", "attr size = 3\nattr other = 5\nRun --> report(\"k\", size + 10 * other) X."}};
    const std::string run = "Lot --> p.Run\n", size = "attr size = 7\n";
    EXPECT_EQ(reported("import p : \"part.cga\"\n" + run, reading(files)), 53);
    EXPECT_EQ(reported("import p : \"part.cga\"\n" + run + size, reading(files)), 57);
    EXPECT_EQ(reported("import p : \"part.cga\"\n" + run + size, reading(files), {{"size", 8.0}}), 58);
    EXPECT_EQ(reported("import p : \"part.cga\"\n" + run + size, reading(files), {}, {{"size", 9.0}}), 59);
    // set() on either name changes both: they are one attribute.
    EXPECT_EQ(reported("import p : \"part.cga\"\nLot --> set(size, 1) p.Run\n" + size, reading(files)), 51);
    EXPECT_EQ(reported("import p : \"part.cga\"\nLot --> set(p.size, 2) p.Run\n" + size, reading(files)), 52);
    // A constant of the name is something else.
    EXPECT_EQ(reported("import p : \"part.cga\"\n" + run + "const size = 7\n", reading(files)), 53);
}

TEST(GrammarImport, ValuesInTheParenthesesWin)
{
    const Files files{{"part.cga", "attr size = 3\nattr other = 5\nRun --> report(\"k\", size + 10 * other) X."}};
    const std::string rest = "Lot --> p.Run\nattr size = 7\nattr base = 4\n";
    EXPECT_EQ(reported("import p : \"part.cga\" (other = base * 2)\n" + rest, reading(files)), 87);
    EXPECT_EQ(reported("import p : \"part.cga\" (size = 1, other = 2)\n" + rest, reading(files), {{"size", 8.0}}), 21);
    EXPECT_EQ(reported("import p : \"part.cga\" (size = 1 other = 2)\n" + rest, reading(files)), 21);
    // A name alone, or (), keeps what the file itself says.
    EXPECT_EQ(reported("import p : \"part.cga\" (size)\n" + rest, reading(files)), 53);
    EXPECT_EQ(reported("import p : \"part.cga\" ()\n" + rest + "attr other = 9\n", reading(files)), 53);
    EXPECT_EQ(refusal("import p : \"part.cga\" (sise = 1)\n" + rest, reading(files)),
              "main.cga:1:24: 'part.cga' declares no attribute 'sise' that could be set here");
    EXPECT_EQ(refusal("import p : \"part.cga\" (size = bse)\n" + rest, reading(files)).substr(0, 37),
              "main.cga:1:31: unknown name 'bse': de");
    EXPECT_EQ(refusal("import p : \"part.cga\" (Run --> NIL)\n" + rest, reading(files)),
              "main.cga:1:28: rules of an imported file cannot be replaced: declare a style there");
}

TEST(GrammarImport, AttributesThatNobodyOverridesCanBeSet)
{
    const RuleOptions options = reading({{"part.cga", "attr size = 3\nRun --> report(\"k\", size) X."}});
    const std::string text = "import p : \"part.cga\"\nLot --> p.Run";
    EXPECT_EQ(reported(text, options, {{"size", 8.0}}), 8); // properties of features know nothing of imports
    EXPECT_EQ(reported(text, options, {}, {{"p.size", 9.0}}), 9);
}

TEST(GrammarImport, AttributesReachImportsOfImports)
{
    const Files files{{"a.cga", "import b : \"b.cga\"\nRun --> b.Run"},
                      {"b.cga", "attr size = 3\nRun --> report(\"k\", size) X."}};
    EXPECT_EQ(reported("import a : \"a.cga\"\nLot --> a.Run", reading(files)), 3);
    EXPECT_EQ(reported("import a : \"a.cga\"\nattr size = 7\nLot --> a.Run", reading(files)), 7);
    EXPECT_EQ(reported("import a : \"a.cga\"\nattr size = 7\nLot --> a.b.Run", reading(files)), 7);
    Files nearer = files;
    nearer["a.cga"] += "\nattr size = 4";
    EXPECT_EQ(reported("import a : \"a.cga\"\nLot --> a.Run", reading(nearer)), 4);
    EXPECT_EQ(reported("import a : \"a.cga\" (size = 5)\nattr size = 7\nLot --> a.Run", reading(nearer)), 5);
    EXPECT_EQ(refusal("import a : \"a.cga\" (b.size = 5)\nLot --> a.Run", reading(files)).substr(0, 15),
              "main.cga:1:21: "); // second-level imports are not reached into
}

TEST(GrammarImport, OneFileTwiceIsTwoSetsOfRules)
{
    const RuleOptions options = reading({{"part.cga", "attr size = 3\nRun --> report(\"k\", size) X."}});
    EXPECT_EQ(reported("import p : \"part.cga\" (size = 10)\nimport q : \"part.cga\"\nLot --> p.Run q.Run", options),
              13);
}

TEST(GrammarImport, PathsAreRelativeToTheImportingFile)
{
    const RuleOptions options =
        reading({{"rules/parts/a.cga", "import b : \"../b.cga\"\nRun --> b.Run"}, {"rules/b.cga", "Run --> X."}});
    const auto rules = parseRules("import a : \"parts/./a.cga\"\nLot --> a.Run", "rules/main.cga", options);
    ASSERT_TRUE(rules.ok()) << rules.error().message;
    std::vector<std::string> names;
    for (const cga::SourceFile& file : rules->files()) names.push_back(file.name);
    EXPECT_EQ(names, (std::vector<std::string>{"rules/main.cga", "rules/parts/a.cga", "rules/b.cga"}));
    EXPECT_EQ(rules->files()[2].text, "Run --> X.");
}

TEST(GrammarImport, RefusalsOfImports)
{
    const std::string rest = "\nLot --> a.Run";
    EXPECT_EQ(refusal("import a : \"a.cga\"" + rest, {}),
              "main.cga:1:1: import \"a.cga\": these rules are read without a folder, so they cannot import files");
    EXPECT_EQ(refusal("import a : \"a.cga\"" + rest, reading({})),
              "main.cga:1:1: import \"a.cga\": a.cga: there is no such file");
    EXPECT_EQ(refusal("import a : \"/a.cga\"" + rest, reading({})),
              "main.cga:1:1: import \"/a.cga\": write the file's path relative to this file");
    EXPECT_EQ(
        refusal("attr f = \"a\"\nimport a : f" + rest, reading({})),
        "main.cga:2:12: dynamic imports are not supported: write the file's name in quotes, and choose with case");
    EXPECT_EQ(refusal("import a : \"a.cga\"\nimport a : \"a.cga\"" + rest, reading({{"a.cga", "Run --> X."}})),
              "main.cga:2:1: two imports are called 'a'");
    EXPECT_EQ(refusal("import a : \"a.cga\"" + rest, reading({{"a.cga", "Run --> frob(1)"}})),
              "a.cga:1:9: unknown operation or rule 'frob': city/README.md lists what is read");
    EXPECT_EQ(refusal("import a : \"a.cga\"" + rest, reading({{"a.cga", "import m : \"main.cga\"\nRun --> X."}})),
              "a.cga:1:1: import \"main.cga\": the files import each other: main.cga -> a.cga -> main.cga");
}

TEST(GrammarImport, ManyImportsAreLimited)
{
    Files chain;
    for (int k = 0; k < 20; ++k)
        chain[std::to_string(k) + ".cga"] = "import a : \"" + std::to_string(k + 1) + ".cga\"\nRun --> X.";
    EXPECT_EQ(refusal("import a : \"0.cga\"\nLot --> X.", reading(chain)),
              "7.cga:1:1: import \"8.cga\": imports nest deeper than 8 levels");
    // Twice two to the 8: refused long before they are all read.
    Files tree;
    for (int k = 0; k < 20; ++k) {
        const std::string next = ": \"" + std::to_string(k + 1) + ".cga\"\n";
        tree[std::to_string(k) + ".cga"] = "import a " + next + "import b " + next + "Run --> X.";
    }
    EXPECT_NE(refusal("import a : \"0.cga\"\nimport b : \"0.cga\"\nLot --> X.", reading(tree)).find(".cga:"),
              std::string::npos);
}

TEST(GrammarImport, DerivationNamesTheImportedFile)
{
    const RuleOptions options =
        reading({{"part.cga", "Run -->\n  report(\"k\", 1 / (scope.sx - 10)) X.\nLow --> extrude(-1) X."}});
    const auto fails = parseRules("import p : \"part.cga\"\nLot --> p.Run", "main.cga", options);
    ASSERT_TRUE(fails.ok());
    const auto derived = derive(*fails, std::vector{boxFootprint(10, 8, 6)}, unitAssets());
    ASSERT_FALSE(derived.ok());
    EXPECT_EQ(derived.error().message, "part.cga:2:17: building 'b': the division by 0 gives no finite number");
    const auto warns = parseRules("import p : \"part.cga\"\nLot --> p.Low", "main.cga", options);
    ASSERT_TRUE(warns.ok());
    const auto warned = derive(*warns, std::vector{boxFootprint(10, 8, 6)}, unitAssets());
    ASSERT_TRUE(warned.ok());
    ASSERT_EQ(warned->warnings.size(), 1u);
    EXPECT_EQ(warned->warnings[0].rfind("part.cga:3:9: ", 0), 0u) << warned->warnings[0];
}

// ---- styles
const char* const kStyled =
    "attr a = 1\nattr b = 10\nconst c = 100\nLot --> Run\nRun --> report(\"k\", a + b + c) X.\n"
    "style Low\nattr a = 2\nconst c = 200\n"
    "style High extends Low\nattr a = 3\nattr b = 30\n"
    "style Other\nRun --> report(\"k\", a + b + c + extra) X.\nextra = 0.5\n@StartRule\nBegin --> Run Run\n";

TEST(GrammarStyle, AStyleRedefinesWhatItDeclares)
{
    EXPECT_EQ(reported(kStyled, {}), 111);
    EXPECT_EQ(reported(kStyled, reading({}, "Default")), 111);
    EXPECT_EQ(reported(kStyled, reading({}, "Low")), 212);
    EXPECT_EQ(reported(kStyled, reading({}, "High")), 233);
    EXPECT_EQ(reported(kStyled, reading({}, "Other")), 223); // its own start rule runs Run twice
    const auto rules = parseRules(kStyled, "main.cga");
    ASSERT_TRUE(rules.ok());
    EXPECT_EQ(rules->styles(), (std::vector<std::string>{"Default", "Low", "High", "Other"}));
    EXPECT_EQ(rules->ruleNames(), (std::vector<std::string>{"Lot", "Run"})); // Begin is Other's
}

TEST(GrammarStyle, ARedefinitionKeepsTheAnnotations)
{
    const auto rules =
        parseRules("@Range(min=1, max=4)\nattr a = 1\nLot --> X.\nstyle S\nattr a = 2", "main.cga", reading({}, "S"));
    ASSERT_TRUE(rules.ok());
    const RuleAttribute a = rules->attributes().at(0);
    EXPECT_EQ(a.defaultText, "2");
    ASSERT_EQ(a.annotations->size(), 1u);
    EXPECT_EQ(a.annotations->at(0).arguments.at(1).key, "max");
    EXPECT_EQ(a.annotations->at(0).arguments.at(1).number, 4.0);
}

TEST(GrammarStyle, RefusalsOfStyles)
{
    EXPECT_EQ(refusal(kStyled, reading({}, "None")),
              "main.cga:1:1: 'main.cga' has no style 'None', but Default, Low, High, Other");
    EXPECT_EQ(refusal("Lot --> X.\nstyle A extends B\nstyle B", {}),
              "main.cga:2:17: no style 'B' is declared before this one");
    EXPECT_EQ(refusal("Lot --> X.\nstyle A\nstyle A", {}), "main.cga:3:1: style 'A' is declared twice");
    EXPECT_EQ(refusal("Lot --> X.\nstyle A\nattr a = 1\nattr a = 2", {}), "main.cga:4:6: 'a' is declared twice");
    // Also a style that is not in force must be right.
    EXPECT_EQ(refusal("Lot --> X.\nstyle A\nRun --> extrude(heigth) X.", {}).substr(0, 34),
              "main.cga:3:17: unknown name 'heigt");
}

TEST(GrammarStyle, AnImportChoosesAStyle)
{
    const RuleOptions options =
        reading({{"part.cga", "attr a = 1\nRun --> report(\"k\", a) X.\nstyle Two\nattr a = 2\nstyle "
                              "Three\nattr a = 3"}});
    EXPECT_EQ(reported("import p : \"part.cga\"\nimport q(Two) : \"part.cga\"\nimport r(Three, Two) : \"part.cga\"\n"
                       "Lot --> p.Run q.Run r.Run",
                       options),
              6);
    EXPECT_EQ(refusal("import p(Four) : \"part.cga\"\nLot --> p.Run", options),
              "main.cga:1:1: 'part.cga' has no style 'Four', but Default, Two, Three");
}

// ---- local values
TEST(GrammarLocals, LocalsFollowTheParameters)
{
    const auto rules =
        parseRules("f(n) with (m := n + 1 k := m * n) = n + m + k\nLot with (x := f(2), y := x) --> X.", "main.cga");
    ASSERT_TRUE(rules.ok()) << rules.error().message;
    const cga::Program& program = rules->program();
    const cga::Global& f = program.globals.at(0);
    ASSERT_EQ(f.locals.size(), 2u);
    EXPECT_EQ(f.parameters.size(), 1u);
    EXPECT_EQ(f.locals[0].args.at(0).kind, cga::ExprKind::Parameter);
    EXPECT_EQ(f.locals[0].args.at(0).index, 0u);
    EXPECT_EQ(f.locals[1].args.at(0).index, 1u); // m
    EXPECT_EQ(f.value.args.at(1).index, 2u);     // k, the last one added
    ASSERT_EQ(program.rules.at(0).locals.size(), 2u);
    EXPECT_EQ(program.rules[0].locals[1].kind, cga::ExprKind::Parameter);
    EXPECT_EQ(program.rules[0].locals[1].index, 0u);
}

TEST(GrammarLocals, AreEvaluatedOnceOnEntry)
{
    EXPECT_EQ(reported("f(n) with (m := n + 1 k := m * n) = n + 10 * m + 100 * k\nLot --> report(\"k\", f(2)) X.", {}),
              2 + 30 + 600);
    // On entry the box is 10 m wide; the value does not follow the shape.
    EXPECT_EQ(reported("Lot(n) with (w := scope.sx * n) --> s(1, 1, 1) report(\"k\", w) [ report(\"k\", w) X. ] X.\n"
                       "@StartRule Begin --> Lot(2)",
                       {}),
              40);
    EXPECT_EQ(reported("attr a with (x := 3) = x * x\nLot --> report(\"k\", a) X.", {}), 9);
    EXPECT_EQ(refusal("Lot with (x := y, y := 1) --> X.", {}).substr(0, 33), "main.cga:1:16: unknown name 'y': ");
}

} // namespace
} // namespace helio::test
