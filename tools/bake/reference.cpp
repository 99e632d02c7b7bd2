// SPDX-License-Identifier: Apache-2.0
#include "tools/bake/reference.h"

#include <array>
#include <chrono>
#include <cstdio>

#include "city/base/file.h"
#include "city/light/path_tracer.h"
#include "city/pack/patch_scene.h"
#include "shaders/shared/disc.h"
#include "tools/bake/interrupt.h"
#include "tools/bake/progress.h"
#include "tools/support/complain.h"
#include "tools/support/number_in.h"

namespace helio {
namespace {

constexpr std::array<const char*, 4> kChannels{"r", "g", "b", "solar"};

void append(std::string& text, const glm::dvec4& value)
{
    char buffer[40];
    for (int c = 0; c < 4; ++c) {
        const int length = std::snprintf(buffer, sizeof(buffer), ",%.9g", value[c]);
        text.append(buffer, size_t(length));
    }
}

/// The columns of heliopolis-render --table, then a standard error for each quantity and for their sum.
std::string tableOf(const NodeTree& tree, const PathReference& reference, bool emission, const std::string& note)
{
    std::string text =
        concat("# area in m2, all light in W/m2 (linear r, g, b, broadband solar); ", note, "\npatch,building,area");
    for (const char* quantity :
         {"E_sun", "E_sky", "E_indirect", "B", "E_sun_se", "E_sky_se", "E_indirect_se", "E_total_se"})
        for (const char* channel : kChannels) text += concat(",", quantity, "_", channel);
    text += "\n";
    for (u32 i = 0; i < tree.patchCount(); ++i) {
        const Patch& patch = tree.patches[i];
        const PatchLight& light = reference.patches[i];
        const glm::dvec4 total = light.indirect + light.sun + light.sky;
        char area[40];
        std::snprintf(area, sizeof(area), ",%.9g", patch.area);
        text += concat(i, ",", patch.building == kNoIndex ? i64(-1) : i64(patch.building), area);
        for (const glm::dvec4& value :
             {glm::dvec4(light.sun), light.sky, light.indirect,
              (emission ? patch.emission : glm::dvec4(0.0)) + patch.rho * total, glm::dvec4(light.sunError),
              light.skyError, light.indirectError, light.totalError})
            append(text, value);
        text += "\n";
    }
    return text;
}

} // namespace

CLI::App* addReferenceCommand(CLI::App& app, ReferenceOptions& options)
{
    CLI::App* command = app.add_subcommand(
        "reference", "light the patches by path tracing: irradiance and its standard error, to judge a table with");
    command->add_option("PACK", options.pack, "pack folder")->required();
    command->add_option("-o,--output", options.output, "table as CSV, W/m2, one row a patch")->required();
    addSunOptions(*command, options.light);
    command->add_option("--spp", options.samples, "paths per patch; at 32 or more rounded up to whole groups")
        ->check(CLI::Range(2u, 1u << 30))
        ->capture_default_str();
    command->add_option("--seed", options.seed, "seed of the paths")->capture_default_str();
    command->add_option("--jobs", options.jobs, "threads; 0 = all cores; the table does not depend on it")
        ->check(CLI::Range(0u, 1024u))
        ->capture_default_str();
    command->add_flag("--sun-disc", options.sunDisc, "the sun is a disc of 0.53 degrees with penumbras, not a point");
    command->add_flag("--no-emission", options.noEmission, "switch off what patches emit themselves");
    command->add_flag("--first-hand", options.firstHand,
                      "light of sun and sky alone, for heliopolis-render --first-light: much faster, E_indirect is 0");
    return command;
}

int runReference(const ReferenceOptions& options)
{
    const Result<Pack> pack = Pack::open(options.pack);
    if (!pack) return complain(pack.error().message, kBadInput);
    const Result<glm::dvec3> toSun = directionOfSun(options.light, pack->index().northDeg);
    if (!toSun) return complain(toSun.error().message, kBadInput);
    if (Status status = checkFileTarget(options.output); !status) return complain(status.error().message, kBadInput);

    ProgressLine progress;
    const InterruptGuard guard;
    progress.show("rays", 0.0);
    const NodeTree tree = patchTree(*pack);
    const Visibility visibility(tree);
    const auto start = std::chrono::steady_clock::now();
    const PathReference reference = tracePaths(tree, visibility,
                                               {.toSun = *toSun,
                                                .dni = options.light.dni,
                                                .sunRadius = options.sunDisc ? double(gpu::kSunRadius) : 0.0,
                                                .dhi = options.light.dhi,
                                                .farGround = glm::dvec4(farGroundOf(pack->tile())),
                                                .emission = !options.noEmission,
                                                .firstHand = options.firstHand,
                                                .samples = options.samples,
                                                .seed = options.seed,
                                                .jobs = options.jobs,
                                                .progress = [&](double done) {
                                                    progress.show("paths", done);
                                                    return InterruptGuard::caught() == 0;
                                                }});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    progress.clear();
    if (InterruptGuard::caught() != 0) dieOf(InterruptGuard::caught());
    const std::string note =
        concat("path tracing, ", reference.samples, " paths a patch in ", reference.groups, " groups, seed ",
               options.seed, "; sun ", options.light.sun, options.sunDisc ? " (disc)" : "", ", DNI ", options.light.dni,
               ", DHI ", options.light.dhi, options.firstHand ? ", first-hand light alone" : "", "; ",
               reference.cutPaths, " paths cut off after ", kMostBounces, " bounces");
    if (Status written = writeTextAtomically(options.output, tableOf(tree, reference, !options.noEmission, note));
        !written)
        return complain(written.error().message, kBadInput);
    std::printf("%s: %u patches, %u paths each, %.4g rays in %.2f s, %.3g million a second, %llu paths cut off\n",
                options.output.c_str(), tree.patchCount(), reference.samples, double(reference.rays), seconds,
                double(reference.rays) / seconds * 1e-6, static_cast<unsigned long long>(reference.cutPaths));
    return kOk;
}

} // namespace helio
