// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "city/base/file.h"
#include "city/pack/export.h"
#include "city/pack/pipeline.h"
#include "city/pack/stats_text.h"
#include "city/pack/writer.h"
#include "tools/bake/inspect.h"
#include "tools/bake/interrupt.h"
#include "tools/bake/progress.h"
#include "tools/support/complain.h"
#include "tools/support/number_in.h"

namespace helio {
namespace {

struct CommandLine
{
    BakeOptions bake;
    std::string output, stats, pack, surfaces;
    std::vector<std::string> attributes; ///< NAME=VALUE
    std::string method = methodName(LinkMethod::Heliopolis);
    bool zstd = false;
};

void addBakeOptions(CLI::App& app, CommandLine& line)
{
    BakeOptions& bake = line.bake;
    app.add_option("INPUT", bake.input,
                   "GeoJSON footprints (metres), or an OBJ scene with --surfaces; without it the built-in city");
    app.add_option("-o,--output", line.output, "pack folder to write; an existing pack is replaced");
    app.add_option("--surfaces", bake.surfaces, "CSV file of an OBJ scene: row k describes face k");
    app.add_option("--rules", bake.rules,
                   "CGA rule file (default: the shipped one); assets from its folder's assets/ or ../assets/");
    app.add_option("--set", line.attributes,
                   "attribute of the rules for all buildings, repeatable: LOD=mass, height=20")
        ->type_name("NAME=VALUE")
        ->take_all()
        ->allow_extra_args(false);
    app.add_option("--lat", bake.latitudeDeg, "latitude of the origin, degrees")
        ->check(numberIn(-90.0, 90.0))
        ->capture_default_str();
    app.add_option("--lon", bake.longitudeDeg, "longitude of the origin, degrees")
        ->check(numberIn(-180.0, 180.0))
        ->capture_default_str();
    app.add_option("--north", bake.northDeg, "clockwise angle from true north to +y, degrees")
        ->check(numberIn(-360.0, 360.0))
        ->capture_default_str();
    app.add_option("--height", bake.defaultHeight, "height of footprints that do not state one, metres")
        ->check(numberIn(1.0, 1000.0))
        ->capture_default_str();
    app.add_option("--seed", bake.light.seed, "seed of every random choice")->capture_default_str();
    app.add_option("--jobs", bake.light.jobs, "threads; 0 = all cores; the pack does not depend on it")
        ->check(CLI::Range(0u, 1024u))
        ->capture_default_str();
    app.add_option("--method", line.method, "how links are made: heliopolis, paper or paper-literal")
        ->check(CLI::IsMember({"heliopolis", "paper", "paper-literal"}))
        ->type_name("NAME")
        ->capture_default_str();
    app.add_option("--epsilon", bake.light.formFactorEpsilon,
                   "error that one link may leave, as a fraction of the mean radiosity (paper methods: largest form "
                   "factor of a link); "
                   "0 = the method's default")
        ->check(numberIn(0.0, 1.0))
        ->capture_default_str();
    app.add_option("--rays", bake.light.raysPerPatch, "sky rays per patch; 0 = chosen by the number of patches")
        ->check(CLI::Range(0u, 65536u))
        ->capture_default_str();
    app.add_option("--link-rays", bake.light.raysPerLink, "visibility rays per pair of parts of a link; 0 = 4")
        ->check(CLI::Range(0u, 1024u))
        ->capture_default_str();
    app.add_option("--cutoff", bake.light.cutoff, "paper methods: no link beyond this distance, metres; 0 = none")
        ->check(numberIn(0.0, 1e6))
        ->capture_default_str();
    app.add_option("--stats", line.stats, "JSON file for the statistics");
    app.add_flag("--zstd", line.zstd, "pack the sections with zstd: a smaller file that is not mapped but unpacked");
}

int runBake(CommandLine& line)
{
    if (line.output.empty()) return complain("-o PACK is missing: where shall the pack go? See --help", kBadInput);
    // A bad target shows before the work, not after it.
    if (Status status = checkPackTarget(line.output); !status) return complain(status.error().message, kBadInput);
    if (!line.stats.empty())
        if (Status status = checkFileTarget(line.stats); !status) return complain(status.error().message, kBadInput);

    for (const std::string& text : line.attributes) {
        const size_t equals = text.find('=');
        if (equals == 0 || equals == std::string::npos)
            return complain(concat("--set ", text, ": NAME=VALUE is needed; see --help"), kBadInput);
        line.bake.attributes[text.substr(0, equals)] = attributeFromText(text.substr(equals + 1));
    }
    for (const LinkMethod method : {LinkMethod::Heliopolis, LinkMethod::Paper, LinkMethod::PaperLiteral})
        if (line.method == methodName(method)) line.bake.light.method = method;
    ProgressLine progress;
    line.bake.light.progress = [&](const char* step, double done) { progress.show(step, done); };
    Result<BakeResult> result = bake(line.bake);
    if (!result) {
        progress.clear();
        return complain(result.error().message, kBadInput);
    }
    progress.show("writing", 0.0);
    if (Status good = checkContent(result->content, line.output); !good) {
        progress.clear();
        return complain(good.error().message, kInternal);
    }
    const double peak = peakMemoryMiB();
    {
        const InterruptGuard guard;
        Status written =
            writePack(result->content, line.output, {line.zstd, [] { return InterruptGuard::caught() != 0; }});
        if (written && !line.stats.empty() && InterruptGuard::caught() == 0)
            written = writeTextAtomically(line.stats, statsJson(result->stats, peak));
        progress.clear();
        if (InterruptGuard::caught() != 0) dieOf(InterruptGuard::caught());
        if (!written) return complain(written.error().message, kBadInput);
    }
    std::printf("%s: baked from %s\n%s", line.output.c_str(), result->content.index.source.c_str(),
                statsText(result->stats, peak).c_str());
    return kOk;
}

int runExport(const CommandLine& line)
{
    const Result<Pack> pack = Pack::open(line.pack);
    if (!pack) return complain(pack.error().message, kBadInput);
    {
        const InterruptGuard guard;
        Status written = writeSurfaces(*pack, line.surfaces);
        if (InterruptGuard::caught() != 0) dieOf(InterruptGuard::caught());
        if (!written) return complain(written.error().message, kBadInput);
    }
    std::printf("%s.obj, %s.csv: %u patches\n", line.surfaces.c_str(), line.surfaces.c_str(), pack->patchCount());
    return kOk;
}

int runMain(int argc, char** argv)
{
    CommandLine line;
    CLI::App app("Bakes a city for light: footprints and rules, or a scene of polygons, to a pack that "
                 "heliopolis-render reads.\n"
                 "Exit codes: 0 = ok, 1 = bad input or usage, 2 = internal.",
                 "heliopolis-bake");
    addBakeOptions(app, line);
    CLI::App* info = app.add_subcommand("info", "say what a pack holds");
    CLI::App* verify = app.add_subcommand("verify", "check every byte and index of a pack");
    CLI::App* exporting = app.add_subcommand("export", "write the patches as OBJ and CSV, in the order of their ids");
    for (CLI::App* command : {info, verify, exporting})
        command->add_option("PACK", line.pack, "pack folder")->required();
    exporting->add_option("--surfaces", line.surfaces, "name of the two files without .obj and .csv")->required();
    app.require_subcommand(0, 1);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        return complain(concat(error.what(), "; see --help"), kBadInput);
    }
    if (info->parsed() || verify->parsed()) {
        const Status status = info->parsed() ? printInfo(line.pack) : verifyPack(line.pack);
        return status ? kOk : complain(status.error().message, kBadInput);
    }
    return exporting->parsed() ? runExport(line) : runBake(line);
}

} // namespace
} // namespace helio

int main(int argc, char** argv)
{
    try {
        return helio::runMain(argc, argv);
    } catch (const std::exception& error) {
        return helio::complain(helio::concat("internal error: ", error.what()), helio::kInternal);
    }
}
