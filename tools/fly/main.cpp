// SPDX-License-Identifier: Apache-2.0
// heliopolis-fly: a window on a baked city.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "tools/fly/app.h"
#include "tools/fly/builtin_pack.h"
#include "tools/support/number_in.h"

namespace helio {
namespace {

constexpr int kOk = 0, kBadInput = 1, kInternal = 2;

constexpr const char* kKeys = R"(Keys:
  W A S D            fly forward, left, back, right; Q E down, up; Shift six times as fast
  mouse, button held look around
  arrows             sun: left, right its azimuth; up, down its elevation
  [ ]                darker, brighter
  1..9               final, patches, sun visibility, E_sun, E_sky, E_indirect, radiosity, depth, final without display effects
  F2 or P            screenshot, heliopolis-NNNN.png in the current folder
  Esc                leave

Script: steps divided by semicolons, at 60 frames a second of the flight, whatever a frame takes:
  forward|back|left|right|up|down|wait SECONDS; turn RIGHT,UP; sun AZIMUTH,ELEVATION; size WIDTH,HEIGHT;
  view 1..9; screenshot FILE.png
  for example --script "forward 1; sun 180,30; screenshot A.png"

Exit codes: 0 = ok, 1 = bad input or usage, 2 = no display, device or internal.)";

int complain(const std::string& message, int code)
{
    std::cerr << "heliopolis-fly: " << message << std::endl;
    return code;
}

/// Reads "WIDTHxHEIGHT"; false unless both are 16..16384.
bool readSize(const std::string& text, u32& width, u32& height)
{
    char rest = 0;
    return std::sscanf(text.c_str(), "%5ux%5u%c", &width, &height, &rest) == 2 && width >= 16 && height >= 16 &&
           width <= 16384 && height <= 16384;
}

int run(int argc, char** argv)
{
    FlyOptions options;
    std::string script, size = "1280x720";
    std::vector<double> sun;
    CLI::App app{
        "Flies through a baked city, lit as the sun stands. Without a pack: the built-in city, baked into the cache "
        "folder on the first start."};
    app.footer(kKeys);
    app.add_option("PACK", options.pack, "Folder written by heliopolis-bake");
    app.add_option("--sun", sun, "Azimuth clockwise from north and elevation, degrees (default 150,40)")
        ->delimiter(',')
        ->expected(2);
    app.add_option("--dni", options.dni, "Sunlight on a plane that faces the sun, W/m2")
        ->check(numberIn(0.0, 1e6))
        ->capture_default_str();
    app.add_option("--dhi", options.dhi, "Light of the uniform sky on the ground, W/m2")
        ->check(numberIn(0.0, 1e6))
        ->capture_default_str();
    app.add_option("--camera", options.camera,
                   "aerial, street, top, or x,y,z,tx,ty,tz[,fov]: eye and target, m; degrees")
        ->capture_default_str();
    app.add_option("--size", size, "Picture size, pixels, WIDTHxHEIGHT")->capture_default_str();
    app.add_option("--samples", options.samples, "Samples a pixel along each axis")
        ->check(CLI::Range(1, 4))
        ->capture_default_str();
    app.add_option("--script", script, "Flies by itself, then leaves; see below");
    app.add_flag("--validate", options.validation,
                 "Turns the Vulkan validation layer on; a message ends with exit code 2");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& problem) {
        if (problem.get_exit_code() == 0) return app.exit(problem);
        return complain(concat(problem.what(), "; see --help"), kBadInput);
    }
    if (!readSize(size, options.width, options.height))
        return complain(concat("--size ", size, ": expected WIDTHxHEIGHT, 16 to 16384 each"), kBadInput);
    if (!sun.empty()) options.sun = {sun[0], sun[1]};
    if (!std::isfinite(options.sun.x) || !(options.sun.y >= -90.0 && options.sun.y <= 90.0))
        return complain("--sun: expected an azimuth and an elevation of -90 to 90 degrees", kBadInput);
    if (!script.empty()) {
        Result<std::vector<ScriptStep>> steps = parseScript(script);
        if (!steps) return complain(steps.error().message, kBadInput);
        options.script = std::move(*steps);
    }

    if (Status display = Window::checkDisplay(); !display) return complain(display.error().message, kInternal);
    if (options.pack.empty()) {
        Result<std::filesystem::path> pack = builtinPack(cacheFolder());
        if (!pack) return complain(pack.error().message, kInternal);
        options.pack = *pack;
    }
    FlyApp::Failure failure;
    const std::unique_ptr<FlyApp> fly = FlyApp::open(options, failure);
    if (!fly) return complain(failure.message, failure.badInput ? kBadInput : kInternal);
    std::cout << "Device: " << fly->describe() << std::endl;
    if (const Status done = fly->run(); !done) return complain(done.error().message, kBadInput);
    const std::vector<std::string> messages = fly->messages();
    for (const std::string& message : messages) std::cerr << message << std::endl;
    return messages.empty() ? kOk : complain(concat(messages.size(), " validation messages"), kInternal);
}

} // namespace
} // namespace helio

int main(int argc, char** argv)
{
    try {
        return helio::run(argc, argv);
    } catch (const std::exception& failure) { // Memory, threads, files: what the libraries throw.
        return helio::complain(failure.what(), helio::kInternal);
    }
}
