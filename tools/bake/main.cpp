// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <optional>

#include "city/base/file.h"
#include "city/grammar/explain.h"
#include "city/pack/pipeline.h"
#include "city/pack/rule_source.h"
#include "city/pack/stats_text.h"
#include "city/pack/writer.h"
#include "city/sky/sky_dome.h"
#include "tools/bake/compare.h"
#include "tools/bake/export_command.h"
#include "tools/bake/factors.h"
#include "tools/bake/inspect.h"
#include "tools/bake/interrupt.h"
#include "tools/bake/progress.h"
#include "tools/bake/reference.h"
#include "tools/support/complain.h"
#include "tools/support/number_in.h"

namespace helio {
namespace {

struct CommandLine
{
    BakeOptions bake;
    std::string output, stats, pack, surfaces, explain;
    std::vector<std::string> attributes; ///< NAME=VALUE
    std::vector<double> bbox;            ///< west, south, east, north
    std::string method = methodName(LinkMethod::Heliopolis), patch = "piece", front = "auto",
                tree = treeShapeName(TreeShape::Grammar), senders = "linear", receivers = "tree";
    bool zstd = false, compactLinks = false;
    FactorOptions factors;
    ExportOptions exporting;
    ReferenceOptions reference;
    CompareOptions comparing;
};

void addBakeOptions(CLI::App& app, CommandLine& line)
{
    BakeOptions& bake = line.bake;
    app.add_option("INPUT", bake.input,
                   "GeoJSON or CityJSON footprints, or an OBJ scene with --surfaces; without it the built-in city");
    app.add_option("-o,--output", line.output, "pack folder to write; an existing pack is replaced");
    app.add_option(
           "--surfaces", line.surfaces,
           "lod2: take the walls and roofs that a CityJSON file models; else the CSV file of an OBJ scene, whose "
           "row k describes face k")
        ->type_name("lod2|CSV");
    app.add_option("--streets", bake.import.streets,
                   "GeoJSON of street centre-lines, in the footprints' coordinates: fronts face them");
    app.add_option(
           "--front", line.front,
           "front of a footprint: auto = the edge that faces the nearest street, else the longest free one; first = "
           "the first edge of its ring")
        ->check(CLI::IsMember({"auto", "first"}))
        ->type_name("EDGE")
        ->capture_default_str();
    app.add_option("--bbox", line.bbox, "only footprints whose centroid lies in this box of the file's coordinates")
        ->expected(4)
        ->delimiter(',')
        ->type_name("WEST,SOUTH,EAST,NORTH");
    app.add_option("--limit", bake.import.limit, "only the first footprints, in the order of the file")
        ->check(CLI::PositiveNumber);
    app.add_option("--rules", bake.rules,
                   "CGA rule file, or a shipped one by name: midrise.cga, rowhouse.cga, tower.cga, city.cga (default: "
                   "city.cga for the built-in city, else midrise.cga); assets from its folder's assets/ or ../assets/");
    app.add_option("--style", bake.style, "style of the rule file");
    app.add_option("--explain", line.explain, "print attributes and rule graph of a rule file, and do nothing else")
        ->type_name("RULES");
    app.add_option("--patch", line.patch,
                   "what exchanges light as one: piece, or bay = wall and opening of a bay together")
        ->check(CLI::IsMember({"piece", "bay"}))
        ->type_name("MODE")
        ->capture_default_str();
    app.add_option("--tree", line.tree,
                   "levels above the patches: grammar = those of the rules; free = one balanced tree of rectangles a "
                   "plane; faces = none (both to measure against)")
        ->check(CLI::IsMember({"grammar", "free", "faces"}))
        ->type_name("SHAPE")
        ->capture_default_str();
    app.add_flag("--tree-only", bake.treeOnly,
                 "derive the buildings and make their node tree, print statistics, and stop: no links, no pack");
    app.add_option("--set", line.attributes,
                   "attribute of the rules for all buildings, repeatable: LOD=mass, height=20")
        ->type_name("NAME=VALUE")
        ->take_all()
        ->allow_extra_args(false);
    app.add_option("--lat", bake.latitudeDeg,
                   "latitude of the origin, degrees (default: what the input says, else 50.1)")
        ->check(numberIn(-90.0, 90.0));
    app.add_option("--lon", bake.longitudeDeg,
                   "longitude of the origin, degrees (default: what the input says, else 14.4)")
        ->check(numberIn(-180.0, 180.0));
    app.add_option("--north", bake.northDeg, "clockwise angle from true north to +y, degrees")
        ->check(numberIn(-360.0, 360.0))
        ->capture_default_str();
    app.add_option("--height", bake.import.defaultHeight, "height of footprints that do not state one, metres")
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
    app.add_option("--error", bake.light.error,
                   "error of the indirect light to aim at, rms over its mean: chooses how far patches are split, the "
                   "links and the rays; halving it costs about 1.5 times the links")
        ->check(numberIn(0.001, 0.5))
        ->capture_default_str();
    app.add_option("--split", bake.light.splitGrowth,
                   "patches may become at most this many times as many; 1 = none is split")
        ->check(numberIn(1.0, 16.0))
        ->capture_default_str();
    app.add_option("--senders", line.senders, "what a link knows of its sender: linear = mean and slope, or constant")
        ->check(CLI::IsMember({"linear", "constant"}))
        ->type_name("NAME")
        ->capture_default_str();
    app.add_option("--receivers", line.receivers,
                   "where links end: tree = at every level, handed down; patches = rows of the patches alone")
        ->check(CLI::IsMember({"tree", "patches"}))
        ->type_name("NAME")
        ->capture_default_str();
    app.add_option("--epsilon", bake.light.formFactorEpsilon,
                   "error that one link may leave, as a fraction of the mean radiosity (paper methods: largest form "
                   "factor of a link); "
                   "0 = by --error, or the paper's default")
        ->check(numberIn(0.0, 1.0))
        ->capture_default_str();
    app.add_option("--rays", bake.light.raysPerPatch,
                   "sky rays per patch, at least; 0 = chosen by --error and the number of patches")
        ->check(CLI::Range(0u, 65536u))
        ->capture_default_str();
    bake.light.skyPatches = 0;
    app.add_option(
           "--sky-patches", bake.light.skyPatches,
           "parts of the sky that patches know apart; 1 = a smaller pack, for uniform skies only; 0 = 48, or 24 "
           "beyond 200,000 patches")
        ->check(CLI::Range(0u, SkyDome::kMaxCells))
        ->capture_default_str();
    app.add_option("--link-rays", bake.light.raysPerLink,
                   "visibility rays per pair of parts of a link that is seen in part; 0 = 2")
        ->check(CLI::Range(0u, 1024u))
        ->capture_default_str();
    app.add_option("--cutoff", bake.light.cutoff, "paper methods: no link beyond this distance, metres; 0 = none")
        ->check(numberIn(0.0, 1e6))
        ->capture_default_str();
    app.add_option("--stats", line.stats, "JSON file for the statistics");
    app.add_flag("--zstd", line.zstd, "pack the sections with zstd: a smaller file that is not mapped but unpacked");
    app.add_flag("--compact-links", line.compactLinks,
                 "store links in a quarter of the bytes; adds less than 0.1 % to the error of the indirect light");
}

void addFactorOptions(CLI::App& command, FactorOptions& factors)
{
    command.add_option("PAIRS", factors.pairs, "JSON list of {id, a, b, occluders}; polygons in metres")->required();
    command.add_option("-o,--output", factors.output, "CSV file to write: id,F_ab,F_ba,visibility,error,evaluations")
        ->required();
    command.add_flag("--reference", factors.reference, "as exact as double coordinates allow (slower)");
    command.add_option("--jobs", factors.jobs, "threads; 0 = all cores; the file does not depend on it")
        ->check(CLI::Range(0u, 1024u))
        ->capture_default_str();
}

/// Takes over what CLI11 cannot put into the options itself.
Status completeOptions(CommandLine& line)
{
    if (line.surfaces == "lod2")
        line.bake.import.lod2 = true;
    else
        line.bake.surfaces = line.surfaces;
    if (!line.bbox.empty()) {
        if (!(line.bbox[0] < line.bbox[2] && line.bbox[1] < line.bbox[3]))
            return Error{"--bbox WEST,SOUTH,EAST,NORTH: west must be below east, and south below north"};
        line.bake.import.bbox = Box2{{line.bbox[0], line.bbox[1]}, {line.bbox[2], line.bbox[3]}};
    }
    for (const std::string& text : line.attributes) {
        const size_t equals = text.find('=');
        if (equals == 0 || equals == std::string::npos)
            return Error{concat("--set ", text, ": NAME=VALUE is needed; see --help")};
        line.bake.attributes[text.substr(0, equals)] = attributeFromText(text.substr(equals + 1));
    }
    for (const LinkMethod method : {LinkMethod::Heliopolis, LinkMethod::Paper, LinkMethod::PaperLiteral})
        if (line.method == methodName(method)) line.bake.light.method = method;
    line.bake.light.constantSenders = line.senders == "constant";
    line.bake.light.leafReceivers = line.receivers == "patches";
    line.bake.import.keepFirstEdge = line.front == "first";
    line.bake.nodes.patch = line.patch == "bay" ? PatchMode::Bay : PatchMode::Piece;
    for (const TreeShape shape : {TreeShape::Grammar, TreeShape::Free, TreeShape::Faces})
        if (line.tree == treeShapeName(shape)) line.bake.nodes.tree = shape;
    return Nothing{};
}

int runExplain(const CommandLine& line)
{
    const Result<RuleSource> source = readRules(line.explain, line.bake.style);
    if (!source) return complain(source.error().message, kBadInput);
    std::fputs(explainRules(source->rules).c_str(), stdout);
    return kOk;
}

/// The bake, with its progress; the error has been complained about.
std::optional<BakeResult> bakeWithProgress(CommandLine& line, ProgressLine& progress)
{
    line.bake.light.progress = [&](const char* step, double done) { progress.show(step, done); };
    Result<BakeResult> result = bake(line.bake);
    if (result) return std::move(*result);
    progress.clear();
    complain(result.error().message, kBadInput);
    return {};
}

int runTreeOnly(CommandLine& line)
{
    if (!line.output.empty()) return complain("--tree-only writes no pack: leave out -o", kBadInput);
    ProgressLine progress;
    const std::optional<BakeResult> result = bakeWithProgress(line, progress);
    if (!result) return kBadInput;
    progress.clear();
    const double peak = peakMemoryMiB();
    if (!line.stats.empty())
        if (Status written = writeTextAtomically(line.stats, statsJson(result->stats, peak)); !written)
            return complain(written.error().message, kBadInput);
    std::printf("%s: derived\n%s", result->content.index.source.c_str(), statsText(result->stats, peak).c_str());
    return kOk;
}

int runBake(CommandLine& line)
{
    if (Status status = completeOptions(line); !status) return complain(status.error().message, kBadInput);
    // A bad target shows before the work, not after it.
    if (!line.stats.empty())
        if (Status status = checkFileTarget(line.stats); !status) return complain(status.error().message, kBadInput);
    if (line.bake.treeOnly) return runTreeOnly(line);
    if (line.output.empty()) return complain("-o PACK is missing: where shall the pack go? See --help", kBadInput);
    if (Status status = checkPackTarget(line.output); !status) return complain(status.error().message, kBadInput);
    ProgressLine progress;
    std::optional<BakeResult> result = bakeWithProgress(line, progress);
    if (!result) return kBadInput;
    progress.show("writing", 0.0);
    if (Status good = checkContent(result->content, line.output); !good) {
        progress.clear();
        return complain(good.error().message, kInternal);
    }
    const double peak = peakMemoryMiB();
    {
        const InterruptGuard guard;
        const Result<LinkBytes> linkBytes = writePack(
            result->content, line.output, {line.zstd, line.compactLinks, [] { return InterruptGuard::caught() != 0; }});
        Status written = linkBytes ? Status(Nothing{}) : linkBytes.error();
        if (linkBytes) result->stats.linkBytes = *linkBytes;
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
    for (CLI::App* command : {info, verify}) command->add_option("PACK", line.pack, "pack folder")->required();
    CLI::App* exporting = addExportCommand(app, line.exporting);
    CLI::App* reference = addReferenceCommand(app, line.reference);
    CLI::App* comparing = addCompareCommand(app, line.comparing);
    CLI::App* factors = app.add_subcommand("factors", "form factors and visibility of pairs of polygons");
    addFactorOptions(*factors, line.factors);
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
    if (factors->parsed()) {
        const Status status = writeFactors(line.factors);
        return status ? kOk : complain(status.error().message, kBadInput);
    }
    if (exporting->parsed()) return runExport(line.exporting);
    if (reference->parsed()) return runReference(line.reference);
    if (comparing->parsed()) return runCompare(line.comparing);
    return line.explain.empty() ? runBake(line) : runExplain(line);
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
