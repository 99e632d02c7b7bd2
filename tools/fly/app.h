// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/view/renderer.h"
#include "engine/view/window.h"
#include "tools/fly/flight.h"
#include "tools/fly/script.h"

namespace helio {

/// What the command line asks for.
struct FlyOptions
{
    std::filesystem::path pack;
    std::string camera = "aerial";   ///< see parseCamera
    glm::dvec2 sun{150.0, 40.0};     ///< azimuth, elevation, degrees
    double dni = 800.0, dhi = 120.0; ///< W/m2
    u32 width = 1280, height = 720;
    u32 samples = 1; ///< a pixel along each axis, 1..4
    bool validation = false;
    std::vector<ScriptStep> script; ///< empty: keys and mouse
};

/// The open window, from the first frame to the last.
class FlyApp
{
public:
    /// Opens window, device and pack. Errors of the pack are bad input; those of window and device are not.
    struct Failure
    {
        std::string message;
        bool badInput = false;
    };
    static std::unique_ptr<FlyApp> open(const FlyOptions& options, Failure& failure);

    /// Runs until the user leaves or the script ends. Error: a screenshot that could not be written.
    Status run();
    /// Validation messages so far; empty without validation.
    std::vector<std::string> messages() { return context_->messages().all(); }
    std::string describe() const;

private:
    FlyApp() = default;
    FlightInput readKeys() const;
    /// Draws one frame and shows it; false if nothing was shown.
    bool drawFrame(ShownPicture* capture);
    Status saveScreenshot(const std::filesystem::path& path);
    Status runScript();
    Status runKeys();
    void updateTitle();

    FlyOptions options_;
    std::unique_ptr<Window> window_;
    std::unique_ptr<Context> context_;
    std::unique_ptr<Pack> pack_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<Swapchain> swapchain_;
    std::unique_ptr<Recorder> recorder_;
    Flight flight_;
    double fovDegrees_ = 45.0;
    u32 view_ = 1;
    double frameMs_ = 0.0;
    bool noted_ = false; // did it print the renderer's note on pictures?
    SolveReport report_;
};

/// Name of debug view 1..9.
const char* viewName(u32 number);

} // namespace helio
