// SPDX-License-Identifier: Apache-2.0
// heliopolis-fly as a program: under a virtual display, without one, and with bad input.
#include <algorithm>
#include <array>
#include <cstdio>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/screens/test_packs.h"
#include "tests/support/image_compare.h"
#include "tools/fly/flight.h"
#include "tools/fly/script.h"

namespace helio {
namespace {

constexpr u32 kWidth = 320, kHeight = 180;
constexpr const char* kCamera = "-30,-48,30,0,-2,4,45";
// -noreset: without it the server starts anew when its last client leaves, and refuses the next one meanwhile.
constexpr const char* kDisplay = "xvfb-run -a -s '-screen 0 640x360x24 -noreset' ";
constexpr const char* kNoDisplay = "env -u DISPLAY -u WAYLAND_DISPLAY ";

struct Outcome
{
    int code = -1;
    std::string text; ///< standard output and error
};

Outcome runCommand(const std::string& command)
{
    Outcome outcome;
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    if (!pipe) return outcome;
    std::array<char, 4096> part;
    while (const size_t n = fread(part.data(), 1, part.size(), pipe)) outcome.text.append(part.data(), n);
    const int status = pclose(pipe);
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    return outcome;
}

std::string flyCommand(const std::string& arguments)
{
    return concat("'", HELIO_FLY, "' ", arguments);
}

std::filesystem::path outFile(const char* name)
{
    std::filesystem::create_directories(HELIO_SCREENS_OUT);
    const std::filesystem::path path = std::filesystem::path(HELIO_SCREENS_OUT) / name;
    std::filesystem::remove(path);
    return path;
}

/// The picture that a flight sees, without any window.
TestImage renderFlight(const Flight& flight)
{
    Renderer& renderer = testRenderer(TestPack::City);
    renderer.setSun(flight.sunAzimuthDeg, flight.sunElevationDeg, 800.0);
    Camera camera;
    camera.eye = flight.eye;
    camera.target = flight.eye + viewDirection(flight);
    camera.fovDegrees = 45.0;
    const Picture picture = renderer.render(camera, kWidth, kHeight);
    TestImage image = makeTestImage(kWidth, kHeight, 0);
    for (size_t pixel = 0; pixel < size_t(kWidth) * kHeight; ++pixel)
        for (size_t channel = 0; channel < 3; ++channel)
            image.rgb[3 * pixel + channel] = float(picture.display[4 * pixel + channel]);
    return image;
}

TEST(Fly, ScriptedSecondShowsWhatTheFlightSees)
{
    const std::filesystem::path shot = outFile("fly.png");
    const Outcome outcome = runCommand(
        concat("HELIO_DEVICE=llvmpipe ", kDisplay,
               flyCommand(concat("'", testPackFolder(TestPack::City).string(), "' --validate --size 320x180 --camera ",
                                 kCamera, " --script 'sun 215,35; forward 0.5; turn 8,-2; right 0.5; screenshot ",
                                 shot.string(), "'"))));
    ASSERT_EQ(outcome.code, 0) << outcome.text;

    const Pack& pack = testPack(TestPack::City);
    const Camera start = parseCamera(kCamera, pack).value();
    const PackIndex& index = pack.index();
    Flight flight = startFlight(start.eye, glm::normalize(start.target - start.eye),
                                double(glm::length(index.boundsMax - index.boundsMin)), {215, 35});
    const TestImage before = renderFlight(flight);
    advance(flight, {.move = {0, 1, 0}}, 0.5);
    advance(flight, {.turn = {8, -2}}, 0.0);
    advance(flight, {.move = {1, 0, 0}}, 0.5);
    const TestImage expected = renderFlight(flight);

    const Result<TestImage> shown = readTestImage(shot);
    ASSERT_TRUE(shown.ok()) << shown.error().message;
    // Same driver, same shaders, and 60 small steps end within 1e-12 m of one large one: only a pixel centre that falls
    // exactly on an edge could differ.
    constexpr Tolerance kSame{1, 0.0002, 0.01};
    const Difference difference = compareImages(*shown, expected, kSame.maxDifference);
    EXPECT_TRUE(accepts(kSame, difference)) << describe(difference, kSame) << "\n" << shot.string();
    EXPECT_GT(compareImages(*shown, before, 5).share, 0.5) << "the camera has not moved";
}

TEST(Fly, ResizesAndLeavesAtTheEndOfItsScript)
{
    // A window larger than the display's 640 x 360, then a smaller one; no validation message.
    const Outcome outcome = runCommand(
        concat("HELIO_DEVICE=llvmpipe ", kDisplay,
               flyCommand(concat("'", testPackFolder(TestPack::SceneS).string(),
                                 "' --validate --size 700x400 --script 'wait 0.05; size 400,300; wait 0.05'"))));
    EXPECT_EQ(outcome.code, 0) << outcome.text;
}

TEST(Fly, ChangesBetweenViewsOfDifferentSampling)
{
    // Views of ids take one sample a pixel: the pictures are made anew while the window may still read the old ones.
    const Outcome outcome =
        runCommand(concat("HELIO_DEVICE=llvmpipe ", kDisplay,
                          flyCommand(concat("'", testPackFolder(TestPack::SceneS).string(),
                                            "' --validate --samples 2 --size 320x180 "
                                            "--script 'wait 0.05; view 2; wait 0.05; view 1; wait 0.05'"))));
    EXPECT_EQ(outcome.code, 0) << outcome.text;
}

TEST(Fly, NeedsADisplay)
{
    const Outcome outcome =
        runCommand(kNoDisplay + flyCommand(concat("'", testPackFolder(TestPack::City).string(), "'")));
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.text.find("there is no display"), std::string::npos) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
}

TEST(Fly, RefusesBadInput)
{
    const auto refuse = [](const std::string& arguments, const char* part) {
        const Outcome outcome = runCommand(kNoDisplay + flyCommand(arguments));
        EXPECT_EQ(outcome.code, 1) << arguments << "\n" << outcome.text;
        EXPECT_NE(outcome.text.find(part), std::string::npos) << outcome.text;
        EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    };
    refuse("--script 'jump 1'", "script step 'jump 1'");
    refuse("--size 12", "--size 12");
    refuse("--sun 12", "--sun");
    refuse("--dni nan", "--dni");
    refuse("--sun 150,500", "--sun");
    const Outcome noPack = runCommand(concat(kDisplay, flyCommand("'no such pack' --script 'wait 0'")));
    EXPECT_EQ(noPack.code, 1) << noPack.text;
    EXPECT_NE(noPack.text.find("no such pack"), std::string::npos) << noPack.text;
}

TEST(Fly, HelpNamesTheKeys)
{
    const Outcome outcome = runCommand(flyCommand("--help"));
    EXPECT_EQ(outcome.code, 0);
    for (const char* part : {"W A S D", "arrows", "[ ]", "1..9", "F2", "Esc", "--script", "degrees", "W/m2"})
        EXPECT_NE(outcome.text.find(part), std::string::npos) << part;
}

} // namespace
} // namespace helio
