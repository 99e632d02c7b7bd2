// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tools/fly/flight.h"
#include "tools/fly/script.h"

namespace helio {
namespace {

void expectNear(glm::dvec3 a, glm::dvec3 b)
{
    EXPECT_NEAR(a.x, b.x, 1e-9);
    EXPECT_NEAR(a.y, b.y, 1e-9);
    EXPECT_NEAR(a.z, b.z, 1e-9);
}

TEST(Flight, HeadingIsClockwiseFromNorth)
{
    Flight flight;
    expectNear(viewDirection(flight), {0, 1, 0});
    flight.headingDeg = 90;
    expectNear(viewDirection(flight), {1, 0, 0});
    flight.pitchDeg = 30;
    expectNear(viewDirection(flight), {0.8660254037844387, 0, 0.5});
}

TEST(Flight, OneSecondForwardIsTheSpeed)
{
    Flight flight;
    flight.headingDeg = 180;
    flight.speed = 12;
    for (int frame = 0; frame < 60; ++frame) advance(flight, {.move = {0, 1, 0}}, kScriptStep);
    expectNear(flight.eye, {0, -12, 0});
    advance(flight, {.move = {1, 0, 0}}, 1.0); // facing south, right is west
    expectNear(flight.eye, {-12, -12, 0});
    advance(flight, {.move = {0, 0, 1}, .fast = true}, 0.5);
    expectNear(flight.eye, {-12, -12, 36});
}

TEST(Flight, SidewaysStaysLevelWhileLookingDown)
{
    Flight flight;
    flight.pitchDeg = -60;
    advance(flight, {.move = {1, 0, 0}}, 1.0);
    EXPECT_EQ(flight.eye.z, 0);
}

TEST(Flight, AnglesStayInRange)
{
    Flight flight;
    advance(flight, {.turn = {-10, 200}}, 0);
    EXPECT_DOUBLE_EQ(flight.headingDeg, 350);
    EXPECT_DOUBLE_EQ(flight.pitchDeg, 89);
    advance(flight, {.sun = {-1, 1}}, 10); // 200 degrees of both
    EXPECT_DOUBLE_EQ(flight.sunAzimuthDeg, 160);
    EXPECT_DOUBLE_EQ(flight.sunElevationDeg, 90);
    advance(flight, {.exposure = -1}, 100);
    EXPECT_DOUBLE_EQ(flight.exposureStops, -10);
}

TEST(Script, ReadsEveryStep)
{
    const auto steps = parseScript(
        " forward 1.0;left 0.5 ; turn 30,-5; sun 180, 30;view 2;size 64,48;wait 0.25; screenshot a b.png ;");
    ASSERT_TRUE(steps.ok()) << steps.error().message;
    ASSERT_EQ(steps->size(), 8u);
    EXPECT_EQ((*steps)[0].frames, 60u);
    EXPECT_EQ((*steps)[0].input.move, glm::dvec3(0, 1, 0));
    EXPECT_EQ((*steps)[1].frames, 30u);
    EXPECT_EQ((*steps)[1].input.move, glm::dvec3(-1, 0, 0));
    EXPECT_EQ((*steps)[2].kind, ScriptStep::Kind::Turn);
    EXPECT_EQ((*steps)[2].pair, glm::dvec2(30, -5));
    EXPECT_EQ((*steps)[3].kind, ScriptStep::Kind::Sun);
    EXPECT_EQ((*steps)[3].pair, glm::dvec2(180, 30));
    EXPECT_EQ((*steps)[4].number, 2u);
    EXPECT_EQ((*steps)[5].kind, ScriptStep::Kind::Size);
    EXPECT_EQ((*steps)[5].pair, glm::dvec2(64, 48));
    EXPECT_EQ((*steps)[6].frames, 15u);
    EXPECT_EQ((*steps)[7].path, "a b.png");
}

TEST(Script, RefusesWithTheStepInTheMessage)
{
    for (const char* bad :
         {"jump 1", "forward", "forward x", "forward -1", "forward 1e9", "sun 180", "sun 180,91", "view 0", "view 1.5",
          "size 10,200", "size 100", "size 100.5,100", "screenshot", "forward 1s"}) {
        const auto steps = parseScript(concat("wait 0;", bad));
        ASSERT_FALSE(steps.ok()) << bad;
        EXPECT_NE(steps.error().message.find(concat("'", bad, "'")), std::string::npos) << steps.error().message;
    }
    EXPECT_FALSE(parseScript("").ok());
    EXPECT_FALSE(parseScript(" ; ").ok());
}

} // namespace
} // namespace helio
