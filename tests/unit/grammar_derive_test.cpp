// SPDX-License-Identifier: Apache-2.0
// Rules, values, randomness, limits and the tree that a derivation keeps.
#include <cstring>

#include "city/grammar/limits.h"
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

double report(std::string_view rules, const DeriveOptions& options = unitAssets(),
              Footprint footprint = boxFootprint(10, 8, 6))
{
    const Derivation d = mustDerive(rules, {footprint}, options);
    const auto found = d.reports.find("k");
    return found == d.reports.end() ? NAN : found->second;
}

// ---- rules
TEST(GrammarRules, SuccessorsSpawnWithTheCurrentState)
{
    const Derivation d =
        mustDerive("Lot --> color(\"#000000\") A. color(\"#ffffff\") B. C\nC --> t(0, 1, 0)", {boxFootprint(10, 8, 6)});
    EXPECT_EQ(d.shapes.surfaces[leavesOf(d, "A")[0]->surface].rho.r, 0);
    EXPECT_EQ(d.shapes.surfaces[leavesOf(d, "B")[0]->surface].rho.r, 0.95);
    EXPECT_NEAR(boundsOf(d, *leavesOf(d, "C")[0]).first.z, 1,
                1e-12); // a body without successor is a leaf, as its operations left it
    EXPECT_EQ(leavesOf(d, "Lot").size(), 0u);
}

TEST(GrammarRules, NilRemovesAndUndeclaredRulesStay)
{
    const Derivation d =
        mustDerive("Lot --> split(x) { 2 : NIL | 3 : Undeclared | ~1 : B }\nB --> NIL A.", {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(totalArea(d), 24, 1e-9);
    EXPECT_EQ(leavesOf(d, "Undeclared").size(), 1u);
    ASSERT_EQ(d.warnings.size(), 1u);
    EXPECT_EQ(d.warnings[0].substr(0, 41), "t.cga:1:34: rule 'Undeclared' is not decl");
}

TEST(GrammarRules, ParametersAndRecursion)
{
    EXPECT_EQ(report("Lot --> Tier(1, 7)\nTier(n, h) --> case h > 3 : report(\"k\", n) Tier(n + 1, h - 3) else : "
                     "report(\"k\", 100 * h) X."),
              1 + 2 + 100);
    EXPECT_EQ(report("Lot --> A(1) A(1, 2)\nA(x) --> report(\"k\", x) X.\nA(x, y) --> report(\"k\", 10 * y) X."), 21);
}

TEST(GrammarRules, TreeOfRuleSplitComponentAndPush)
{
    const Derivation d = mustDerive("Lot --> extrude(6) comp(f) { front : Wall | all : NIL }\nWall --> split(x) { 1 : "
                                    "Bay | ~1 : color(\"#808080\") }\nBay --> [ t(0, 0, 1) A. ] B.",
                                    {boxFootprint(2, 2, 6)});
    std::string text;
    for (const Shape& shape : d.shapes.shapes) {
        static const char* kOps[] = {"root", "rule", "split", "comp", "insert", "group"};
        text += concat(d.shapes.names[shape.name], ":", kOps[int(shape.op)], ":",
                       shape.parent == kNoIndex ? -1 : int(shape.parent), shape.polygonCount > 0 ? "* " : " ");
        EXPECT_EQ(shape.building, 0u);
    }
    EXPECT_EQ(text, "Lot:root:-1 Wall:comp:0 Bay:split:1 push:group:2 A:rule:3* B:rule:2* split:split:1* ");
    EXPECT_EQ(d.shapes.buildingIds, std::vector<std::string>{"b"});
}

// ---- values
TEST(GrammarValues, Expressions)
{
    const auto value = [](const std::string& expression) {
        return report("Lot --> report(\"k\", " + expression + ") X.");
    };
    EXPECT_EQ(value("2 + 3 * 4 - 6 / 3"), 12);
    EXPECT_EQ(value("-(2 + 3) * 2"), -10);
    EXPECT_EQ(value("7.5 % 2"), 1.5);
    EXPECT_EQ(value("rint(0.5) + 10 * rint(1.5) + 100 * rint(2.5)"), 220); // halves to the even number
    EXPECT_EQ(value("floor(-1.5) + ceil(1.2)"), 0);
    EXPECT_NEAR(value("sin(30) + cos(60) + tan(45) + atan2(1, 1) + asin(1)"), 0.5 + 0.5 + 1 + 45 + 90, 1e-9);
    EXPECT_NEAR(value("sqrt(16) + pow(2, 3) + exp(0) + ln(1) + log10(100) + abs(-2)"), 4 + 8 + 1 + 0 + 2 + 2, 1e-12);
    EXPECT_EQ(value("min(3, 1, 2) + max(3, 5) + clamp(9, 0, 4)"), 10);
    EXPECT_EQ(value("1 < 2 && !(2 <= 1) || 1 / 0 > 1"), 1); // short-circuit: the division is never made
    EXPECT_EQ(value("\"a\" + 1 == \"a1\""), 1);
    EXPECT_EQ(value("len(\"abcd\") + count(\"banana\", \"an\") + find(\"banana\", \"an\", 1)"), 4 + 2 + 3);
    EXPECT_EQ(value("substring(\"facade\", 1, 4) == \"aca\""), 1);
    EXPECT_EQ(value("float(\"2.5\") + float(true) + float(\" 3 \")"), 6.5);
    EXPECT_EQ(value("str(2.5) + str(3) + str(true) == \"2.53true\""), 1);
    EXPECT_EQ(value("bool(1) != bool(\"\")"), 1);
    EXPECT_EQ(value("rgb(1, 0.5, 0) == \"#ff8000\""), 1);
}

TEST(GrammarValues, TypeErrorsNameThePlace)
{
    EXPECT_EQ(errorOf("Lot --> extrude(\"a\") X."),
              "t.cga:1:17: building 'b': a number is needed here, but the value is text");
    EXPECT_EQ(errorOf("Lot --> case 1 : A. else : B."),
              "t.cga:1:14: building 'b': true or false is needed here, but the value is a number");
    EXPECT_EQ(errorOf("Lot --> color(1 + 2) X.").substr(0, 45), "t.cga:1:17: building 'b': text is needed here");
    EXPECT_EQ(errorOf("Lot --> report(\"k\", 1 / (2 - 2)) X."),
              "t.cga:1:23: building 'b': the division by 0 gives no finite number");
    EXPECT_EQ(errorOf("Lot --> report(\"k\", \"a\" < 1) X.").substr(0, 52),
              "t.cga:1:25: building 'b': this needs numbers on both");
    EXPECT_EQ(errorOf("Lot --> color(\"red\") X.").substr(0, 49), "t.cga:1:9: building 'b': 'red' is no colour: writ");
    EXPECT_EQ(errorOf("Lot --> report(\"k\", sqrt(-1)) X.").substr(0, 44),
              "t.cga:1:21: building 'b': sqrt gives no fini");
}

TEST(GrammarValues, AttributesComeFromRuleFootprintAndOptions)
{
    const std::string rules = "attr height = 3\nattr n = 1\nattr name = \"x\"\nattr on = false\nconst fixed = 5\n"
                              "Lot --> report(\"k\", height + 10 * n + 100 * len(name) + (case on : 1000 else : 0)) X.";
    Footprint footprint = boxFootprint(10, 8, 6);
    EXPECT_EQ(report(rules), 6 + 10 + 100); // height is the footprint's
    footprint.attributes = {{"n", 2.0}, {"name", std::string("abc")}, {"on", true}, {"unknown", 1.0}};
    EXPECT_EQ(report(rules, unitAssets(), footprint), 6 + 20 + 300 + 1000);
    DeriveOptions options = unitAssets();
    options.attributes = {{"n", 3.0}, {"height", 1.0}};
    EXPECT_EQ(report(rules, options, footprint), 1 + 30 + 300 + 1000); // the command line wins
    footprint.attributes = {{"n", std::string("4")}, {"name", 12.0}};
    EXPECT_EQ(report(rules, unitAssets(), footprint), 6 + 40 + 200); // read as the attribute's own kind
    footprint.attributes = {{"n", std::string("many")}};
    const Derivation d = mustDerive(rules, {footprint});
    EXPECT_EQ(d.reports.at("k"), 6 + 10 + 100);
    EXPECT_EQ(d.warnings.size(), 1u);
    options.attributes = {{"fixed", 1.0}};
    const auto refused = deriveText(rules, {footprint}, options);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().message, "t.cga: the rules declare no attribute 'fixed' that could be set");
}

TEST(GrammarValues, AttributesAreDrawnOnceAndFunctionsAtEveryCall)
{
    EXPECT_EQ(report("attr a = rand()\nconst c = rand()\nLot --> report(\"k\", a - a + c - c) X."), 0);
    EXPECT_NE(report("f = rand()\nLot --> report(\"k\", f - f) X."), 0);
    // Streams of their own: another attribute before it does not change the draw.
    EXPECT_EQ(report("attr b = rand()\nattr a = rand()\nLot --> report(\"k\", a) X."),
              report("attr a = rand()\nLot --> report(\"k\", a) X."));
    EXPECT_EQ(errorOf("attr a = b\nattr b = a\nLot --> extrude(a) X.").substr(0, 62),
              "t.cga:1:6: building 'b': the value of 'a' depends on itself");
    EXPECT_EQ(
        report("attr a = 1\nLot --> set(a, 5) A\nA --> report(\"k\", a) [ set(a, 7) B ] B\nB --> report(\"k\", a) X."),
        5 + 7 + 5);
}

// ---- surfaces
TEST(GrammarSurfaces, ColorMaterialAndEmission)
{
    const auto surface = [](const std::string& operations) {
        const Derivation d = mustDerive("Lot --> " + operations + " A.", {boxFootprint(10, 8, 6)});
        return d.shapes.surfaces[leavesOf(d, "A")[0]->surface];
    };
    // sRGB 128/255 is 0.21586 linear (IEC 61966-2-1); solar from the colour where no material is named.
    const Surface grey = surface("color(\"#808080\")");
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(grey.rho[k], 0.215861, 1e-6);
    EXPECT_NEAR(surface("color(\"#00ff00\")").rho.a, 0.7152 * 1.0, 1e-9);
    EXPECT_EQ(surface("").rho, glm::dvec4(0.5));
    const Surface glass = surface("set(material.name, \"glass\")");
    EXPECT_EQ(glass.rho, glm::dvec4(0.12));
    EXPECT_EQ(glass.name, "glass");
    // The colour gives r, g, b, the known material the solar channel.
    const Surface tinted = surface("set(material.name, \"glass\") color(0, 0, 0)");
    EXPECT_EQ(tinted.rho, glm::dvec4(0, 0, 0, 0.12));
    EXPECT_EQ(surface("set(material.color.rgb, \"#808080\")").rho, grey.rho);
    EXPECT_NEAR(surface("color(\"#000000\") set(material.color.g, 0.5)").rho.g, 0.214041, 1e-6);
    const Surface lamp = surface("set(material.emissive.r, 100) set(material.emissive.b, 10)");
    EXPECT_EQ(lamp.emission, glm::dvec4(100, 0, 10, 0.2126 * 100 + 0.0722 * 10));
    EXPECT_EQ(errorOf("Lot --> set(material.emissive.r, -1) X.").substr(0, 55),
              "t.cga:1:34: building 'b': an emission must not be negat");
    EXPECT_EQ(mustDerive("Lot --> set(material.bumpmap, \"x\") texture(\"y\") projectUV(0) A.", {boxFootprint(1, 1, 1)})
                  .warnings.size(),
              2u);
}

// ---- randomness
TEST(GrammarRandom, SharesFollowThePercentages)
{
    std::vector<Footprint> boxes;
    for (int k = 0; k < 4000; ++k) {
        boxes.push_back(boxFootprint(1, 1, 1));
        boxes.back().id = std::to_string(k);
    }
    const std::string rules = "Lot --> 30% : A. 20% : B. else : C.";
    const auto counts = [&](u64 seed) {
        DeriveOptions options = unitAssets();
        options.seed = seed;
        const Derivation d = mustDerive(rules, boxes, options);
        return std::array{leavesOf(d, "A").size(), leavesOf(d, "B").size(), leavesOf(d, "C").size()};
    };
    const auto first = counts(1);
    // Four standard deviations of a binomial with n = 4000.
    EXPECT_NEAR(double(first[0]), 1200, 4 * std::sqrt(4000 * 0.3 * 0.7));
    EXPECT_NEAR(double(first[1]), 800, 4 * std::sqrt(4000 * 0.2 * 0.8));
    EXPECT_EQ(first[0] + first[1] + first[2], 4000u);
    EXPECT_EQ(first, counts(1));
    EXPECT_NE(first, counts(2));
    EXPECT_EQ(errorOf("Lot --> 60% : A. 50% : B. else : C.").substr(0, 58),
              "t.cga:1:9: building 'b': the percentages add up to 110, mo");
}

TEST(GrammarRandom, ASubtreeRollsByItsOwnPath)
{
    // Another building before it, and another successor after it, leave the draws of a building alone.
    const auto draws = [](const std::string& rules, std::vector<Footprint> boxes) {
        const Derivation d = mustDerive(rules, boxes);
        std::vector<double> values;
        for (const Shape& shape : d.shapes.shapes)
            if (d.shapes.names[shape.name] == "A" && shape.building + 1 == boxes.size())
                values.push_back(boundsOf(d, shape).first.z);
        return values;
    };
    const std::string rules = "Lot --> split(x) { ~1 : A }*\nA --> t(0, rand(100), 0)";
    Footprint other = boxFootprint(3, 3, 3);
    other.id = "other";
    const auto alone = draws(rules, {boxFootprint(5, 5, 5)});
    ASSERT_EQ(alone.size(), 5u);
    EXPECT_NE(alone[0], alone[1]);
    // More shapes inside an earlier sibling do not shift the path.
    const std::string later = "Lot --> P split(x) { ~1 : A }*\nA --> t(0, rand(100), 0)\n";
    const auto one = draws(later + "P --> X.", {boxFootprint(5, 5, 5)});
    EXPECT_EQ(one, draws(later + "P --> X. t(0, 1, 0) Y. Z.", {boxFootprint(5, 5, 5)}));
    EXPECT_EQ(alone, draws(rules, {other, boxFootprint(5, 5, 5)}));
    EXPECT_EQ(alone,
              draws("Lot --> split(x) { ~1 : A }* B\nA --> t(0, rand(100), 0)\nB --> X.", {boxFootprint(5, 5, 5)}));
}

/// Every number of a derivation, byte for byte.
std::string bytesOf(const Derivation& d)
{
    std::string bytes;
    const auto add = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    for (const Shape& s : d.shapes.shapes) {
        for (const u32 v : {s.parent, s.name, s.building, u32(s.op), s.polygonBegin, s.polygonCount, s.surface, s.asset,
                            u32(s.placement)})
            add(v);
        add(s.worldFromAsset);
    }
    for (const Polygon3& polygon : d.shapes.polygons) {
        for (const glm::dvec3& p : polygon.outer) add(p);
        for (const Ring3& hole : polygon.holes)
            for (const glm::dvec3& p : hole) add(p);
    }
    for (const Surface& surface : d.shapes.surfaces) {
        bytes += surface.name;
        add(surface.rho);
        add(surface.emission);
    }
    for (const auto* list : {&d.shapes.names, &d.shapes.assets, &d.shapes.buildingIds, &d.warnings})
        for (const std::string& text : *list) bytes += text + '\n';
    for (const auto& [key, value] : d.reports) {
        bytes += key;
        add(value);
    }
    return bytes;
}

TEST(GrammarRandom, SameBytesForAnyNumberOfThreads)
{
    const std::string rules =
        "attr tint = rgb(rand(), rand(), rand())\nLot --> extrude(5 + rand(10)) comp(f) { side : W | top : color(tint) "
        "Undeclared | all : NIL }\n"
        "W --> report(\"area\", geometry.area * rand()) split(y) { ~3 : split(x) { ~2 : B }* }*\n"
        "B --> 50% : color(tint) A. else : s('1, '1, 0.2) t(0, 0, -0.2) i(n) A.\nn = 50% : \"a.glb\" else : \"b.glb\"";
    std::vector<Footprint> boxes;
    for (int k = 0; k < 60; ++k) {
        boxes.push_back(boxFootprint(5 + k % 7, 9, 6));
        boxes.back().id = std::to_string(k);
    }
    DeriveOptions one = unitAssets(), two = unitAssets();
    two.jobs = 2;
    const std::string bytes = bytesOf(mustDerive(rules, boxes, one));
    EXPECT_GT(bytes.size(), 100000u);
    EXPECT_TRUE(bytes == bytesOf(mustDerive(rules, boxes, two)));
    one.seed = 1;
    EXPECT_FALSE(bytes == bytesOf(mustDerive(rules, boxes, one)));
}

// ---- limits: no rule text may crash, hang or fill the memory
TEST(GrammarLimits, RunawayRulesEndWithAMessage)
{
    const auto says = [](const std::string& rules, const std::string& part) {
        const std::string message = errorOf(rules);
        EXPECT_NE(message.find(part), std::string::npos) << message;
        EXPECT_EQ(message.rfind("t.cga:", 0), 0u) << message;
    };
    says("Lot --> A\nA --> B\nB --> A", "nest deeper than");
    says("Lot --> [ Lot ] X.", "nest deeper than");
    says("Lot --> split(x) { ~1 : Lot }", "nest deeper than");
    says("f(x) = f(x + 1)\nLot --> extrude(f(1)) X.", "deep");
    says("f(x) = case x > 150 : 1 else : f(x + 1) + f(x + 1)\nLot --> extrude(f(1)) X.", "steps");
    says("f(x, n) = case n > 100 : x else : f(x + x, n + 1)\nLot --> report(f(\"aa\", 0), 1) X.", "longer than");
    says("Lot --> split(x) { 0 : A. }*", "no extent");
    says("Lot --> split(x) { ~0 : A. }*", "no extent");
    says("Lot --> split(x) { 0.00001 : A. }*", "at most");
    says("Lot --> A(0)\nA(n) --> case n > 30 : X. else : A(n + 1) A(n + 1)", "more than");
    // Work inside one term counts too: looking for a long text, copying many attributes.
    says("d(x) = x + x\nB = d(d(d(d(d(d(d(d(d(d(d(\"aaaaaaaaaaaaaaaa\")))))))))))\nP = substring(B, 0, 16000) + \"b\"\n"
         "F = find(B, P)\nLot --> report(\"n\", F + F + F + F + F + F + F + F) X.",
         "steps");
    says("Lot --> extrude(1e9) X.", "grows beyond");
    says("Lot --> t(0, 1e300, 0) t(0, 1e300, 0) X.", "grows beyond");
    says("Lot --> extrude(3) extrude(3) X.", "solid");
    says("Lot --> i(\"a.glb\") split(x) { 1 : X. }", "cannot be divided");
    says("Lot --> primitiveCube(0, 1, 1) X.", "above 0");
}

TEST(GrammarLimits, AssetsThatCannotBeReadAreErrors)
{
    DeriveOptions options = unitAssets();
    options.assetBox = [](const std::string& name) -> Result<AssetBox> { return Error{"no such asset as " + name}; };
    const auto missing = deriveText("Lot --> i(\"x.glb\") X.", {boxFootprint(1, 1, 1)}, options);
    ASSERT_FALSE(missing.ok());
    EXPECT_EQ(missing.error().message, "t.cga:1:9: building 'b': i(\"x.glb\"): no such asset as x.glb");
    options.assetBox = nullptr;
    EXPECT_FALSE(deriveText("Lot --> i(\"x.glb\") X.", {boxFootprint(1, 1, 1)}, options).ok());
}

TEST(GrammarLimits, FootprintsWithoutAreaAreNotDerived)
{
    Footprint line = footprintOf({{0, 0}, {5, 0}, {9, 0}}, 3),
              clockwise = footprintOf({{0, 0}, {0, 5}, {5, 5}, {5, 0}}, 3), pair = footprintOf({{0, 0}, {1, 1}}, 3);
    const Derivation d = mustDerive("Lot --> extrude(3) X.", {line, clockwise, pair, boxFootprint(1, 1, 1)});
    EXPECT_EQ(d.shapes.shapes.size(), 3u + 2u);
    EXPECT_EQ(d.warnings.size(), 1u);
}

TEST(GrammarLimits, StartRules)
{
    Footprint named = boxFootprint(1, 1, 1);
    named.rule = "Other";
    const Derivation d = mustDerive("Lot --> A.\nOther --> B.", {named, boxFootprint(2, 2, 2)});
    EXPECT_NEAR(areaOf(d, "B"), 1, 1e-12);
    EXPECT_NEAR(areaOf(d, "A"), 4, 1e-12);
    EXPECT_EQ(errorOf("House --> X."), "t.cga: no start rule: name one Lot, or mark one with @StartRule");
    named.rule = "Missing";
    EXPECT_FALSE(deriveText("Lot --> A.", {named}).ok());
}

} // namespace
} // namespace helio::test
