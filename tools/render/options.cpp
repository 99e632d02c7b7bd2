// SPDX-License-Identifier: Apache-2.0
#include "tools/render/options.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>

#include "city/sky/calendar.h"
#include "tools/support/number_in.h"

namespace helio {

namespace {

const std::map<std::string, u32> kModes{{"final", gpu::kModeFinal},        {"id", gpu::kModeId},
                                        {"depth", gpu::kModeDepth},        {"sun-visibility", gpu::kModeSunVisibility},
                                        {"esun", gpu::kModeSun},           {"esky", gpu::kModeSky},
                                        {"eindirect", gpu::kModeIndirect}, {"radiosity", gpu::kModeRadiosity},
                                        {"albedo", gpu::kModeAlbedo},      {"level", gpu::kModeLevel},
                                        {"links", gpu::kModeLinks},        {"residual", gpu::kModeResidual},
                                        {"error", gpu::kModeError}};
constexpr u32 kMaxSize = 16384;

std::string checkSize(const std::string& text, u32& width, u32& height)
{
    int used = 0;
    if (std::sscanf(text.c_str(), "%ux%u%n", &width, &height, &used) != 2 || size_t(used) != text.size() || width < 1 ||
        height < 1 || width > kMaxSize || height > kMaxSize)
        return concat("--size ", text, ": expected WIDTHxHEIGHT in pixels, 1 to ", kMaxSize, " each");
    return {};
}

std::string checkSun(const std::string& text, DaylightOptions& light)
{
    int used = 0;
    double &azimuth = light.azimuthDeg, &elevation = light.elevationDeg;
    if (std::sscanf(text.c_str(), "%lf,%lf%n", &azimuth, &elevation, &used) != 2 || size_t(used) != text.size() ||
        !(azimuth >= -360.0 && azimuth <= 360.0) || !(elevation >= -90.0 && elevation <= 90.0))
        return concat("--sun ", text, ": expected AZIMUTH,ELEVATION in degrees, -360 to 360 and -90 to 90");
    return {};
}

} // namespace

ViewOptions viewOf(const RenderOptions& o)
{
    ViewOptions view;
    view.mode = o.mode;
    view.picked = o.picked;
    view.samples = o.samples;
    view.smoothLight = o.smooth;
    view.exposureStops = o.exposureStops;
    return view;
}

Result<RenderOptions> parseCommandLine(int argc, char** argv, bool& done)
{
    RenderOptions o;
    std::string sun = "180,45", sky = "uniform", size = "1280x720", per = "patch", view = "final";
    bool noEmission = false, flat = false;
    CLI::App app{
        "Lights a pack and draws it without a window: pictures, outputs of every stage, tables of irradiance.\n"
        "Exit codes: 0 = ok, 1 = bad input or usage, 2 = device or internal.",
        "heliopolis-render"};
    app.add_option("PACK", o.pack, "pack folder, from heliopolis-bake")->required();
    DaylightOptions& light = o.daylight;
    auto* sunOption = app.add_option("--sun", sun, "azimuth,elevation in degrees; azimuth clockwise from true north")
                          ->capture_default_str();
    auto* date = app.add_option("--date", light.date, "day YYYY-MM-DD, with --time: the sun over the pack's place")
                     ->excludes(sunOption);
    auto* time = app.add_option("--time", light.time, "HH:MM or HH:MM:SS of --date")->needs(date);
    date->needs(time);
    app.add_option("--utc-offset", light.utcOffset, "hours that the clock of --time is ahead of UTC")
        ->check(numberIn(-15.0, 15.0))
        ->capture_default_str();
    auto* dni = app.add_option("--dni", light.dni, "direct normal irradiance of the sun, W/m2")
                    ->check(numberIn(0.0, 1e6))
                    ->capture_default_str();
    app.add_option("--sky", sky, "uniform, cie:N (ISO 15469 type 1 to 15; 16 = traditional overcast) or perez")
        ->capture_default_str();
    auto* dhi = app.add_option("--dhi", light.dhi, "diffuse horizontal irradiance of the sky, W/m2")
                    ->check(numberIn(0.0, 1e6))
                    ->capture_default_str();
    app.add_option("--turbidity", light.turbidity,
                   "Linke turbidity, 1 to 10: --dni and --dhi of a cloudless sky at --date (2-3 clean, 4-6 hazy air)")
        ->check(numberIn(1.0, 10.0))
        ->excludes(dni)
        ->excludes(dhi);
    app.add_flag("--no-emission", noEmission, "switch off what patches emit themselves");
    app.add_option("--camera", o.camera, "aerial, street, top, or x,y,z,tx,ty,tz[,fov] (m, vertical degrees)")
        ->capture_default_str();
    app.add_option("--size", size, "WIDTHxHEIGHT of the picture, pixels")->capture_default_str();
    auto* residual =
        app.add_option(
               "--residual", o.residual,
               "sweep until the relative residual is at most this, and the error estimated from its fall half of it")
            ->check(numberIn(1e-7, 1.0))
            ->capture_default_str();
    app.add_option("--iterations", o.sweeps, "make exactly this many sweeps instead")
        ->check(CLI::Range(1u, 100000u))
        ->excludes(residual);
    app.add_option("--sun-texel", o.sunTexel, "size of a texel of the sun raster, m; 0 = 0.04 or what the scene allows")
        ->check(numberIn(0.0, 100.0))
        ->capture_default_str();
    app.add_option("--sun-samples", o.sunSamples, "sun rasters with shifted texels, whose counts add up")
        ->check(CLI::Range(1u, 256u))
        ->capture_default_str();
    app.add_option("--samples", o.samples, "samples a pixel along each axis")
        ->check(CLI::Range(1u, 4u))
        ->capture_default_str();
    app.add_option("--exposure", o.exposureStops, "stops added to the automatic exposure")
        ->check(numberIn(-20.0, 20.0))
        ->capture_default_str();
    app.add_flag(
        "--exact-links", o.exactLinks,
        "keep links in full precision on the device, 16 bytes each: what their short form rounds is about 0.05 %");
    app.add_flag("--flat", flat, "one light value a patch in the picture, not interpolated");
    auto* png = app.add_option("-o,--output", o.png, "picture as PNG, sRGB");
    auto* path =
        app.add_option("--path", o.path,
                       "camera path: a line a key, seconds x,y,z,tx,ty,tz[,fov]; pictures NAME-0000.png and on")
            ->needs(png);
    app.add_option("--frames", o.frames, "pictures along --path")->check(CLI::Range(1u, 100000u))->needs(path);
    auto* dayOption =
        app.add_option("--day", o.day,
                       "day YYYY-MM-DD: every time of it with the sun up, each solved from the one before; "
                       "pictures NAME-0610.png and on")
            ->excludes(sunOption)
            ->excludes(date)
            ->excludes(path);
    std::string every = "60m";
    app.add_option("--every", every, "minutes between the times of --day, as 10m")
        ->needs(dayOption)
        ->capture_default_str();
    app.add_flag("--lag", o.lag, "print how far each time of --day is from a solution to 1e-6")->needs(dayOption);
    app.add_flag("--sheet", o.sheet, "the pictures of --path or --day on one sheet")->needs(png);
    auto* exr = app.add_option(
        "--exr", o.exr, "picture as EXR, linear: W/m2/sr for final, without display tints; else the view's own unit");
    app.add_option(
           "--first-light", o.firstLight,
           "table as --table writes it: its E_sun and E_sky stand in place of the sun raster and the sky links, "
           "so that a table of the result shows the error of the links alone")
        ->excludes(png)
        ->excludes(exr);
    app.add_option("--table", o.table, "irradiance and radiosity as CSV, W/m2");
    app.add_option("--per", per, "row of the table: patch, or face of the OBJ")
        ->check(CLI::IsMember({"patch", "face"}))
        ->capture_default_str();
    app.add_option("--view", view,
                   "final, id, depth, sun-visibility, esun, esky, eindirect, radiosity, albedo; in false colour level, "
                   "links (of --pick), residual, or error (expected, of E_indirect)")
        ->check(CLI::IsMember(kModes))
        ->capture_default_str();
    app.add_option("--pick", o.picked, "patch whose links --view links shows")->capture_default_str();
    app.add_option("--device", o.device,
                   "part of the Vulkan device's name (default: HELIO_DEVICE, else the fastest kind)");
    app.add_option("--dump-graph", o.dumpGraph,
                   "write the frame graphs that run, once each, as DOT: passes, what they wait for, sizes");
    app.add_flag("--validate", o.validate, "run under the validation layer; any message is a failure (exit 2)");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            done = true;
            app.exit(error);
            return o;
        }
        return Error{concat(error.what(), "; see --help")};
    }
    if (const std::string wrong = checkSun(sun, light); !wrong.empty()) return Error{wrong};
    const Result<SkyChoice> choice = parseSky(sky);
    if (!choice) return Error{concat("--sky: ", choice.error().message)};
    light.sky = *choice;
    if (!light.date.empty())
        if (const Result<double> day = parseJulianDay(light.date, light.time, light.utcOffset); !day)
            return Error{concat("--date, --time: ", day.error().message)};
    if (const std::string wrong = checkSize(size, o.width, o.height); !wrong.empty()) return Error{wrong};
    if (!o.path.empty() && o.frames == 0) return Error{"--path: say how many pictures with --frames"};
    if (!o.path.empty() && !o.exr.empty()) return Error{"--exr: one picture; --path makes PNG files"};
    if (o.sheet && o.path.empty() && o.day.empty()) return Error{"--sheet: for --path or --day"};
    if (!o.day.empty()) {
        if (const Result<double> noon = parseJulianDay(o.day, "12:00", 0.0); !noon)
            return Error{concat("--day: ", noon.error().message)};
        int used = 0;
        if (std::sscanf(every.c_str(), "%um%n", &o.every, &used) != 1 || size_t(used) != every.size() || o.every < 1 ||
            o.every > 24 * 60)
            return Error{concat("--every ", every, ": expected minutes as 10m, 1 to 1440")};
        if (!o.exr.empty() || !o.table.empty() || !o.firstLight.empty())
            return Error{"--day makes pictures and a report: no --exr, --table or --first-light with it"};
    } else if (light.date.empty() && (app.count("--turbidity") > 0 || app.count("--utc-offset") > 0)) {
        return Error{"--turbidity and --utc-offset need --date or --day"};
    }
    if (o.day.empty() && o.png.empty() && o.exr.empty() && o.table.empty())
        return Error{"nothing to do: ask for a picture (-o A.png, --exr A.exr) or a table (--table T.csv); see --help"};
    o.emission = !noEmission;
    o.smooth = !flat;
    o.rows = per == "face" ? TableRows::Face : TableRows::Patch;
    o.mode = kModes.at(view);
    return o;
}

} // namespace helio
