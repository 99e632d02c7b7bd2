// SPDX-License-Identifier: Apache-2.0
// Sizes of split and repeat. The vectors are the worked examples of the language's split page (scope of 10 units) and
// our own decisions where that page is silent.
#include "city/grammar/split_sizes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/grammar_support.h"

namespace helio::cga {
namespace {

SplitItem absolute(double v)
{
    return {SizeKind::Absolute, v, 0, {}};
}
SplitItem relative(double v)
{
    return {SizeKind::Relative, v, 0, {}};
}
SplitItem floating(double v)
{
    return {SizeKind::Floating, v, 0, {}};
}
SplitItem repeat(std::vector<SplitItem> pattern)
{
    return {SizeKind::Absolute, 0.0, 0, std::move(pattern)};
}

void expectSizes(double size, const std::vector<SplitItem>& items, const std::vector<double>& expected)
{
    const auto parts = splitParts(size, items);
    ASSERT_TRUE(parts.ok()) << parts.error().message;
    ASSERT_EQ(parts->size(), expected.size());
    double at = 0.0;
    for (size_t k = 0; k < expected.size(); ++k) {
        EXPECT_NEAR((*parts)[k].end - (*parts)[k].begin, expected[k], 1e-5) << "part " << k;
        EXPECT_NEAR((*parts)[k].begin, at, 1e-5) << "part " << k;
        at += expected[k];
    }
}

std::vector<double> repeated(std::vector<double> pattern, int times)
{
    std::vector<double> all;
    for (int k = 0; k < times; ++k) all.insert(all.end(), pattern.begin(), pattern.end());
    return all;
}

TEST(GrammarSplit, RelativePartsLeaveAGap)
{
    expectSizes(10, {relative(.5), relative(.1), relative(.2)}, {5, 1, 2});
}
TEST(GrammarSplit, FloatingPartsFill)
{
    expectSizes(10, {floating(.5), floating(.1), floating(.2)}, {6.25, 1.25, 2.5});
}
TEST(GrammarSplit, FloatingTakesTheRest)
{
    expectSizes(10, {absolute(3.3), floating(3), absolute(5)}, {3.3, 1.7, 5});
}
TEST(GrammarSplit, OversizedIsCutAndTheRestNeverMade)
{
    expectSizes(10, {relative(.5), relative(.6), absolute(3)}, {5, 5});
}
TEST(GrammarSplit, AbsoluteRepeatIsCutAtTheEnd)
{
    expectSizes(10, {repeat({absolute(2), absolute(1)})}, {2, 1, 2, 1, 2, 1, 1});
}
TEST(GrammarSplit, FloatingRepeatStretchesLeast)
{
    expectSizes(10, {repeat({floating(2), floating(1)})}, repeated({2.222222, 1.111111}, 3));
}
TEST(GrammarSplit, RepeatBetweenAbsoluteEnds)
{
    std::vector<double> expected = repeated({.9, .2, .9}, 4);
    expected.insert(expected.begin(), 1);
    expected.push_back(1);
    expectSizes(10, {absolute(1), repeat({floating(1), absolute(.2), floating(1)}), absolute(1)}, expected);
}
TEST(GrammarSplit, AbabaRhythm)
{
    expectSizes(10, {repeat({absolute(1), floating(2.7)}), absolute(1)}, {1, 3.5, 1, 3.5, 1});
}
TEST(GrammarSplit, ShortFacadeKeepsOneFloor)
{
    expectSizes(1, {repeat({floating(3)})}, {1});
}
TEST(GrammarSplit, EndsEatEverythingAndTheRepeatVanishes)
{
    expectSizes(.4, {absolute(.3), repeat({floating(2)}), absolute(.3)}, {.3, .1});
}

// The pattern is ~3 and two inner repeats of 0.5 m each, 4 m in all: three times in 12 m, without stretch.
TEST(GrammarSplit, NestedRepeatIsLaidOutInsideItsShare)
{
    expectSizes(12, {repeat({floating(3), repeat({absolute(.5)}), repeat({absolute(.5)})})}, repeated({3, .5, .5}, 3));
}

TEST(GrammarSplit, TwoRepeatsShareTheRest)
{
    expectSizes(10, {repeat({floating(1)}), absolute(2), repeat({floating(2)})}, {1, 1, 1, 1, 2, 2, 2});
}
// 1.9 / 1.1 rounds to two, but the fixed parts of two, 2 m, would leave nothing to the floating ones.
TEST(GrammarSplit, FixedPartsOfARepeatMustFit)
{
    expectSizes(1.9, {repeat({absolute(.9), floating(.1), absolute(.1)})}, {.9, .9, .1});
}
TEST(GrammarSplit, NegativeSizesCountAsNothing)
{
    expectSizes(10, {absolute(-3), floating(1)}, {10});
}
TEST(GrammarSplit, EmptyScopeMakesNothing)
{
    expectSizes(0, {repeat({floating(1)}), absolute(1)}, {});
}

TEST(GrammarSplit, RepeatWithoutExtentIsAnError)
{
    const auto parts = splitParts(10, {repeat({absolute(0)})});
    ASSERT_FALSE(parts.ok());
    EXPECT_NE(parts.error().message.find("no extent"), std::string::npos);
    EXPECT_FALSE(splitParts(10, {repeat({absolute(-1), floating(0)})}).ok());
}

TEST(GrammarSplit, GiantCountsAreErrors)
{
    EXPECT_FALSE(splitParts(10, {repeat({absolute(1e-6)})}).ok());
    EXPECT_FALSE(splitParts(10, {repeat({floating(1e-7)})}).ok());
    EXPECT_FALSE(splitParts(1e5, {repeat({repeat({absolute(0.1)}), absolute(1)})}).ok()); // 10^5 x ... through nesting
}

/// The warnings of rules on a box of 10 x 10 x 10 m, without the first line's place.
std::vector<std::string> warningsOf(std::string_view rules)
{
    std::vector<std::string> lines;
    for (const std::string& line : test::mustDerive(rules, {test::boxFootprint(10, 10, 10)}).warnings)
        lines.push_back(line.substr(0, line.find('\n')));
    return lines;
}

TEST(GrammarSplit, WarnsOfNegativeSizes)
{
    EXPECT_EQ(warningsOf("Lot --> split(x) { 4 - 6 : A. | ~1 : B. }"),
              std::vector<std::string>{"t.cga:1:20: this size of a split is negative and counts as 0 (-2)"});
    EXPECT_EQ(warningsOf("Lot --> split(x) { 4 - 4 : A. | ~1 : B. }"), std::vector<std::string>{});
}

TEST(GrammarSplit, WarnsOfASplitWithoutParts)
{
    EXPECT_EQ(warningsOf("Lot --> split(x) { 0 : A. | '0 : B. }"),
              std::vector<std::string>{"t.cga:1:9: this split makes no part: no size is above 0 and fits"});
    EXPECT_EQ(warningsOf("Lot --> split(y) { ~1 : A. }"), // of a plane
              std::vector<std::string>{"t.cga:1:9: this split makes no part: its shape has no extent along the axis"});
    EXPECT_EQ(warningsOf("Lot --> extrude(2) split(y) { ~1 : A. }"), std::vector<std::string>{});
}

} // namespace
} // namespace helio::cga
