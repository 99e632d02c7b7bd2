// SPDX-License-Identifier: Apache-2.0
#include "tools/fly/app.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <glm/geometric.hpp>
#include <iostream>
#include <utility>

#include "engine/view/picture_file.h"

namespace helio {
namespace {

constexpr u32 kMostSunSamples = 16;

using Clock = std::chrono::steady_clock;

constexpr double kDegreesPerPixel = 0.15;
constexpr double kTitleInterval = 0.25; // s
constexpr double kLongestFrame = 0.1;   // s; a slower frame moves the camera by no more than this
constexpr double kIdleWait = 0.1;       // s between looks at a minimised window
constexpr u32 kShowAttempts = 10;       // a resize loses a frame or two

struct DebugView
{
    const char* name;
    u32 mode;
    bool display;
};
constexpr std::array<DebugView, 9> kViews{{
    {"final", gpu::kModeFinal, true},
    {"patches", gpu::kModeId, true},
    {"sun visibility", gpu::kModeSunVisibility, true},
    {"E_sun", gpu::kModeSun, true},
    {"E_sky", gpu::kModeSky, true},
    {"E_indirect", gpu::kModeIndirect, true},
    {"radiosity", gpu::kModeRadiosity, true},
    {"depth", gpu::kModeDepth, true},
    {"final without display effects", gpu::kModeFinal, false},
}};

double secondsSince(Clock::time_point begin)
{
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

double axis(bool positive, bool negative)
{
    return double(positive) - double(negative);
}

std::filesystem::path nextScreenshot()
{
    for (u32 number = 1;; ++number) {
        char name[32];
        std::snprintf(name, sizeof name, "heliopolis-%04u.png", number);
        if (!std::filesystem::exists(name)) return name;
    }
}

} // namespace

const char* viewName(u32 number)
{
    return kViews.at(number - 1).name;
}

std::unique_ptr<FlyApp> FlyApp::open(const FlyOptions& options, Failure& failure)
{
    const auto fail = [&](const Error& error, bool badInput) {
        failure = {error.message, badInput};
        return nullptr;
    };
    std::unique_ptr<FlyApp> app(new FlyApp);
    app->options_ = options;
    Result<Pack> pack = Pack::open(options.pack);
    if (!pack) return fail(pack.error(), true);
    app->pack_ = std::make_unique<Pack>(std::move(*pack));
    const Result<Camera> camera = parseCamera(options.camera, *app->pack_);
    if (!camera) return fail(camera.error(), true);
    const PackIndex& index = app->pack_->index();
    app->flight_ = startFlight(camera->eye, axesOf(*camera).forward,
                               double(glm::length(index.boundsMax - index.boundsMin)), options.sun);
    app->fovDegrees_ = camera->fovDegrees;

    Result<std::unique_ptr<Window>> window = Window::open("Heliopolis", options.width, options.height);
    if (!window) return fail(window.error(), false);
    app->window_ = std::move(*window);
    ContextOptions contextOptions;
    contextOptions.validation = options.validation;
    app->window_->connect(contextOptions);
    Result<std::unique_ptr<Context>> context = Context::create(contextOptions);
    if (!context) return fail(context.error(), false);
    app->context_ = std::move(*context);
    if (options.validation && !app->context_->validating())
        return fail(Error{"the validation layer is missing; install vulkan-validationlayers"}, false);
    Result<std::unique_ptr<Swapchain>> swapchain = Swapchain::create(*app->context_, *app->window_);
    if (!swapchain) return fail(swapchain.error(), false);
    app->swapchain_ = std::move(*swapchain);

    RendererOptions rendererOptions;
    // A script must give the same picture whatever came before; a hand on the sun wants speed.
    rendererOptions.solve.warmStart = options.script.empty();
    Result<std::unique_ptr<Renderer>> renderer = Renderer::create(*app->context_, *app->pack_, rendererOptions);
    if (!renderer) return fail(renderer.error(), true);
    app->renderer_ = std::move(*renderer);
    if (!app->renderer_->note().empty()) std::cout << "Note: " << app->renderer_->note() << std::endl;
    app->renderer_->setSky(options.dhi);
    app->recorder_ = std::make_unique<Recorder>(*app->context_);
    return app;
}

std::string FlyApp::describe() const
{
    return context_->describe();
}

Status FlyApp::run()
{
    return options_.script.empty() ? runKeys() : runScript();
}

bool FlyApp::drawFrame(ShownPicture* capture)
{
    const glm::uvec2 size = window_->pictureSize();
    if (size.x == 0 || size.y == 0) return false;
    const Clock::time_point begin = Clock::now();
    renderer_->setSun(flight_.sunAzimuthDeg, flight_.sunElevationDeg, options_.dni);
    report_ = renderer_->solve();
    // A sun that stands still gets finer; a script shows what one raster gives.
    if (options_.script.empty() && report_.cached && report_.sunSamples < kMostSunSamples)
        report_ = renderer_->refineSun();

    const DebugView& debug = kViews[view_ - 1];
    Camera camera;
    camera.eye = flight_.eye;
    camera.target = flight_.eye + viewDirection(flight_);
    camera.fovDegrees = fovDegrees_;
    ViewOptions view;
    view.mode = debug.mode;
    view.display = debug.display;
    // A window may be dragged beyond what the device can sample so often.
    const u32 largest = context_->facts().maxImageDimension2D;
    view.samples = std::clamp(largest / std::max(size.x, size.y), 1u, options_.samples);
    view.exposureStops = flight_.exposureStops;
    FrameGraph graph("frame");
    (void)renderer_->addFrame(graph, camera, size.x, size.y, view);
    const Status compiled = graph.compile(*context_);
    HELIO_CHECK(compiled.ok(), compiled.error().message);
    recorder_->begin();
    graph.execute(*recorder_);
    recorder_->submitAndWait();
    frameMs_ = 1000.0 * secondsSince(begin);
    if (!renderer_->pictureNote().empty() && !std::exchange(noted_, true))
        std::cout << "Note: " << renderer_->pictureNote() << std::endl;
    return swapchain_->show(renderer_->displayImage(), capture);
}

Status FlyApp::saveScreenshot(const std::filesystem::path& path)
{
    ShownPicture shown;
    bool captured = false;
    for (u32 attempt = 0; attempt < kShowAttempts && !captured; ++attempt) {
        window_->poll();
        captured = drawFrame(&shown);
    }
    if (!captured) return Error{concat(path.string(), ": no screenshot: the window is minimised")};
    if (Status written = writePng(path, shown.width, shown.height, shown.rgba); !written) return written;
    std::cout << "Screenshot " << path.string() << ", " << shown.width << " x " << shown.height << std::endl;
    return Nothing{};
}

Status FlyApp::runScript()
{
    for (const ScriptStep& step : options_.script) {
        switch (step.kind) {
        case ScriptStep::Kind::Hold:
            for (u32 frame = 0; frame < step.frames; ++frame) {
                window_->poll();
                if (window_->closing()) return Nothing{};
                advance(flight_, step.input, kScriptStep);
                drawFrame(nullptr);
                updateTitle();
            }
            break;
        case ScriptStep::Kind::Turn:
            advance(flight_, {.turn = step.pair}, 0.0);
            break;
        case ScriptStep::Kind::Sun:
            flight_.sunAzimuthDeg = step.pair.x;
            flight_.sunElevationDeg = step.pair.y;
            break;
        case ScriptStep::Kind::Size:
            window_->setSize(u32(step.pair.x), u32(step.pair.y));
            break;
        case ScriptStep::Kind::View:
            view_ = step.number;
            break;
        case ScriptStep::Kind::Screenshot:
            if (Status saved = saveScreenshot(step.path); !saved) return saved;
            break;
        }
    }
    return Nothing{};
}

FlightInput FlyApp::readKeys() const
{
    const auto down = [&](Key key) { return window_->isDown(key); };
    FlightInput input;
    input.move = {axis(down(Key::D), down(Key::A)), axis(down(Key::W), down(Key::S)), axis(down(Key::E), down(Key::Q))};
    input.fast = down(Key::Shift);
    const glm::dvec2 dragged = window_->dragged();
    input.turn = kDegreesPerPixel * glm::dvec2(dragged.x, -dragged.y);
    input.sun = {axis(down(Key::Right), down(Key::Left)), axis(down(Key::Up), down(Key::Down))};
    input.exposure = axis(down(Key::BracketRight), down(Key::BracketLeft));
    return input;
}

Status FlyApp::runKeys()
{
    Clock::time_point last = Clock::now(), titled = last;
    bool shown = true;
    while (!window_->closing()) {
        window_->poll(shown ? 0.0 : kIdleWait);
        if (window_->wasPressed(Key::Escape)) break;
        const double seconds = std::min(secondsSince(last), kLongestFrame);
        last = Clock::now();
        advance(flight_, readKeys(), seconds);
        for (u32 number = 1; number <= kViews.size(); ++number)
            if (window_->wasPressed(Key(u32(Key::Digit1) + number - 1))) view_ = number;
        if (window_->wasPressed(Key::F2) || window_->wasPressed(Key::P)) {
            // A full disk or a read-only folder is no reason to end the flight.
            if (Status saved = saveScreenshot(nextScreenshot()); !saved)
                std::cerr << saved.error().message << std::endl;
        }
        shown = drawFrame(nullptr);
        if (secondsSince(titled) > kTitleInterval) {
            updateTitle();
            titled = Clock::now();
        }
    }
    return Nothing{};
}

void FlyApp::updateTitle()
{
    char text[200];
    std::snprintf(text, sizeof text, "Heliopolis | sun %.1f, %.1f | residual %.1e in %u sweeps | %.1f ms | %s",
                  flight_.sunAzimuthDeg, flight_.sunElevationDeg, report_.residual, report_.sweeps, frameMs_,
                  viewName(view_));
    window_->setTitle(text);
}

} // namespace helio
