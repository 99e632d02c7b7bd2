// SPDX-License-Identifier: Apache-2.0
// sun_visibility_check PACK: compares the engine's sun visibility with an Embree ray per pixel, for cameras given by
// hand.
#include <CLI/CLI.hpp>
#include <iostream>

#include "tests/screens/visibility_check.h"

namespace helio {
namespace {

struct CheckOptions
{
    std::filesystem::path pack;
    std::vector<double> sun{180.0, 45.0};
    std::vector<std::string> cameras;
    u32 width = 640, height = 360;
    double atLeast = 99.5;
    std::string map;
};

Result<bool> check(const CheckOptions& options)
{
    const Result<Pack> pack = Pack::open(options.pack);
    if (!pack) return pack.error();
    const Result<std::unique_ptr<Context>> context = Context::create({});
    if (!context) return context.error();
    const Result<std::unique_ptr<Renderer>> renderer = Renderer::create(**context, *pack);
    if (!renderer) return renderer.error();
    (*renderer)->setSun(options.sun[0], options.sun[1], 800.0);
    const RayScene rays(pack->tile());
    std::cout << rays.triangleCount() << " triangles, sun at " << options.sun[0] << ", " << options.sun[1]
              << " degrees\n";
    bool good = true;
    for (const std::string& text : options.cameras) {
        const Result<Camera> camera = parseCamera(text, *pack);
        if (!camera) return camera.error();
        const Agreement agreement = checkSunVisibility(**renderer, rays, *camera, options.width, options.height);
        std::cout << text << ": " << describe(agreement) << std::endl;
        good = good && 100 * agreement.share() >= options.atLeast;
        if (options.map.empty()) continue;
        if (Status written = writeTestImage(concat(options.map, text, ".png"), agreement.map); !written)
            return written.error();
    }
    return good;
}

} // namespace
} // namespace helio

int main(int argc, char** argv)
{
    helio::CheckOptions options;
    CLI::App app{
        "Compares the engine's sun visibility with an Embree ray per pixel. Exit code 0 = every camera agrees, "
        "1 = one does not, 2 = no answer."};
    app.add_option("PACK", options.pack, "Folder written by heliopolis-bake")->required();
    app.add_option("--sun", options.sun, "Azimuth,elevation in degrees")->delimiter(',')->expected(2);
    app.add_option("--camera", options.cameras, "aerial, street, top or x,y,z,tx,ty,tz[,fov]; may be repeated")
        ->required();
    app.add_option("--width", options.width, "Pixels")->capture_default_str();
    app.add_option("--height", options.height, "Pixels")->capture_default_str();
    app.add_option("--at-least", options.atLeast, "Percent of the pixels that must agree")->capture_default_str();
    app.add_option("--map", options.map, "Writes a map for each camera to this name + CAMERA.png");
    CLI11_PARSE(app, argc, argv);
    const helio::Result<bool> good = helio::check(options);
    if (!good) {
        std::cerr << "sun_visibility_check: " << good.error().message << std::endl;
        return 2;
    }
    return *good ? 0 : 1;
}
