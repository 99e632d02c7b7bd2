// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "city/base/result.h"
#include "city/base/types.h"
#include "engine/view/renderer.h"
#include "shaders/shared/view.h"
#include "tools/render/daylight.h"
#include "tools/render/table.h"

namespace helio {

/// The command line of heliopolis-render.
struct RenderOptions
{
    std::string pack;
    DaylightOptions daylight;
    bool emission = true;
    std::string camera = "aerial";
    u32 width = 1280, height = 720;
    u32 sweeps = 0; ///< > 0: exactly this many
    double residual = 1e-3;
    double sunTexel = 0.0; ///< m; 0 = the default
    u32 sunSamples = 1;    ///< sun rasters with shifted texels
    u32 samples = 3;
    double exposureStops = 0.0;
    bool smooth = true;
    bool exactLinks = false; ///< in full precision on the device
    std::string png, exr, table;
    std::string path;       ///< of a camera path; "" = the camera stands
    u32 frames = 0;         ///< along it
    std::string day;        ///< YYYY-MM-DD, every `every` minutes of it; "" = one light
    u32 every = 60;         ///< minutes
    bool lag = false;       ///< of each time of the day against a converged solution
    bool sheet = false;     ///< pictures of a path or a day on one sheet
    std::string firstLight; ///< table of E_sun and E_sky in place of what the sun raster and the sky links give
    TableRows rows = TableRows::Patch;
    u32 mode = gpu::kModeFinal;
    u32 picked = 0;
    std::string device;
    std::string dumpGraph; ///< file for the graphs that run, in DOT
    bool validate = false;
};

/// What a picture of these options shows.
ViewOptions viewOf(const RenderOptions& options);

/// Parses the command line. `done` is set when the program has nothing more to do (--help). Errors: one line each.
Result<RenderOptions> parseCommandLine(int argc, char** argv, bool& done);

} // namespace helio
