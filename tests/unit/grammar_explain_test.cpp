// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/explain.h"

#include "city/grammar/program.h"
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

TEST(GrammarExplain, SaysWhatTheRulesDeclare)
{
    RuleOptions options;
    options.style = "Tall";
    options.readImport = [](const std::string&) -> Result<std::string> {
        return std::string("attr pitch = 30\nTop --> roof.Top.\nGable --> Tiles.\nstyle Steep\nattr pitch = 60");
    };
    const auto rules = parseRules(
        "import roof(Steep) : \"roof.cga\"\n"
        "attr loose = rand(1, // drawn\n  2)\n"
        "@Group(\"Facade\", 2) @Order(2) @Range(min=1, max=4, stepsize=0.5)\n"
        "attr bay = 2.5\n"
        "@Group(\"Facade\", 2) @Order(1) @Enum(\"a\", \"b\") @Description(\"which window\")\n"
        "attr kind = \"a\"\n"
        "@Group(\"Mass\", 1) @Range(3, 30)\n"
        "attr height = 9\n"
        "@Hidden @Color\n"
        "attr tint = \"#ffffff\"\n"
        "const wide = bay * 2\n"
        "half(x) = x / 2\n"
        "Lot --> extrude(height) comp(f) { side : Wall(1) | top : roof.Top | bottom : NIL }\n"
        "Wall(n) --> case n > 1 : Brick. else : [ t(0, 0, 1) Sign. ] split(x) { { ~wide : Wall(n + 1) }* | 1 : Edge }\n"
        "Old --> Older\n"
        "Older --> NIL\n"
        "style Tall\n"
        "attr height = 20\n",
        "main.cga", options);
    ASSERT_TRUE(rules.ok()) << rules.error().message;
    EXPECT_EQ(explainRules(*rules), R"(main.cga: 6 rules, start rule Lot
styles: Default, Tall; in force: Tall
import roof: roof.cga, style Steep

attributes
  Mass
    height = 20         (3 to 30)
  Facade
    kind = "a"          (one of a, b; which window)
    bay = 2.5           (1 to 4 in steps of 0.5)
  loose = rand(1, 2)
  tint = "#ffffff"      (@Hidden; @Color)
  roof.pitch = 60

functions and constants
  const wide = bay * 2
  half(x) = x / 2

rules
  Lot -> Wall, roof.Top  [extrude comp NIL]
  Wall(n) -> Brick., Sign., Wall, Edge.  [t split]
  Old -> Older  (never reached)
  Older -> -  [NIL]  (never reached)
  roof.Top -> roof.Top.
  roof.Gable -> Tiles.  (never reached)
)");
}

TEST(GrammarExplain, SmallRules)
{
    const auto rules = parseRules("A --> X.", "t.cga");
    ASSERT_TRUE(rules.ok());
    EXPECT_EQ(explainRules(*rules),
              "t.cga: 1 rules, start rule none: name one Lot, or mark one with @StartRule\n\nrules\n"
              "  A -> X.  (never reached)\n");
}

} // namespace
} // namespace helio::test
