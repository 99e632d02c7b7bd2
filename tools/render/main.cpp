// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <set>

#include "city/base/file.h"
#include "engine/view/energy_audit.h"
#include "engine/view/picture_file.h"
#include "engine/view/renderer.h"
#include "tools/render/first_light.h"
#include "tools/render/options.h"
#include "tools/render/sequence.h"
#include "tools/render/table.h"
#include "tools/support/complain.h"

namespace helio {

namespace {

/// Prints the seconds since the last call, by name.
class Steps
{
public:
    void done(const char* name)
    {
        const auto now = std::chrono::steady_clock::now();
        std::printf("  %-28s %9.1f ms\n", name, std::chrono::duration<double, std::milli>(now - last_).count());
        last_ = now;
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// What to add where the sweeps ended before the residual that was asked for.
const char* shortfall(const RenderOptions& o, const SolveReport& report)
{
    return o.sweeps == 0 && !(report.residual <= o.residual) ? " (the residual asked for was not reached)" : "";
}

void printSolve(const RenderOptions& o, const SolveReport& report)
{
    if (o.firstLight.empty())
        std::printf(
            "Sun raster: %u views of %u x %u texels of %.3f m; of %u patches that face the sun %u take an ancestor's "
            "ratio, %u clamped\n",
            report.sunViews, report.sunWidth, report.sunHeight, report.sunTexel, report.litPatches,
            report.flaggedPatches, report.excessPatches);
    std::printf("Residual %.3g after %u sweeps%s%s; mean radiosity %.4g W/m2 (solar)\n", report.residual, report.sweeps,
                report.accelerated ? " of Chebyshev's semi-iteration" : "", shortfall(o, report),
                report.meanRadiosity.a);
    const glm::dvec4 &bound = report.bound, &number = report.contraction;
    const double largest = std::max(std::max(number.r, number.g), std::max(number.b, number.a));
    if (largest < 1.0)
        std::printf(
            "No radiosity is further from the links' solution than %.3g W/m2 (r %.3g, g %.3g, b %.3g); contraction "
            "number %.3f\n",
            bound.a, bound.r, bound.g, bound.b, largest);
    else
        std::printf("The distance to the links' solution has no bound: contraction number %.3f\n", largest);
    std::printf("On the device:\n");
    for (const PassTime& stage : report.stages)
        std::printf("  %-28s %9.2f ms\n", stage.name.c_str(), stage.milliseconds);
}

void printAudit(const EnergyAudit& audit)
{
    const double in = audit.in().a, percent = in > 0.0 ? 100.0 / in : 0.0;
    const glm::dvec4 missing = 100.0 * audit.unexplainedShare();
    std::printf(
        "Energy (solar): in %.6g W = sun %.2f %% + sky %.2f %% + emitters %.2f %%; absorbed %.2f %%, out to the "
        "sky %.2f %%, out of the scene %.2f %%; unexplained %.3f %% (r %.3f, g %.3f, b %.3f)\n",
        in, percent * audit.sun.a, percent * audit.sky.a, percent * audit.emission.a, percent * audit.absorbed.a,
        percent * audit.toSky.a, percent * audit.away.a, missing.a, missing.r, missing.g, missing.b);
}

void printPicture(const Picture& picture)
{
    std::printf("  %-28s %9.2f ms\n", "4 forward shading, tone", totalTime(picture.passes));
}

void printPictureNote(const Renderer& renderer)
{
    if (!renderer.pictureNote().empty()) std::printf("Note: %s\n", renderer.pictureNote().c_str());
}

std::string describeLight(const RenderOptions& o, const Daylight& light, const SolveReport& report)
{
    return concat(o.firstLight.empty() ? light.description : concat("first light of ", o.firstLight),
                  o.emission ? ", emitters on" : ", emitters off", "; residual ", report.residual, " after ",
                  report.sweeps, " sweeps", shortfall(o, report));
}

Status writePictures(Renderer& renderer, const Camera& camera, const RenderOptions& o)
{
    ViewOptions view = viewOf(o);
    if (!o.png.empty()) {
        const Picture picture = renderer.render(camera, o.width, o.height, view);
        printPicture(picture);
        if (Status written = writePng(o.png, o.width, o.height, picture.display); !written) return written;
    }
    if (!o.exr.empty()) {
        view.display = false;
        view.smoothLight = false;
        const Picture picture = renderer.render(camera, o.width, o.height, view);
        if (o.png.empty()) printPicture(picture);
        if (Status written = writeExr(o.exr, o.width, o.height, exrChannels(picture, o.mode)); !written) return written;
    }
    return Nothing{};
}

Status writeGraphs(const RenderOptions& o, const std::set<std::string>& graphs)
{
    if (o.dumpGraph.empty()) return Nothing{};
    std::string text;
    for (const std::string& graph : graphs) text += graph;
    return writeTextAtomically(o.dumpGraph, text);
}

/// The exit code: what the validation layer said is a failure.
int reportValidation(Context& context, const RenderOptions& o)
{
    if (!o.validate) return kOk;
    for (const std::string& message : context.messages().all()) complain(message, kInternal);
    if (context.messages().count() > 0) return kInternal;
    std::printf("No validation messages\n");
    return kOk;
}

int runMain(int argc, char** argv)
{
    bool done = false;
    const Result<RenderOptions> parsed = parseCommandLine(argc, argv, done);
    if (!parsed) return complain(parsed.error().message, kBadInput);
    if (done) return kOk;
    const RenderOptions& o = *parsed;
    for (const std::string& output : {o.png, o.exr, o.table, o.dumpGraph})
        if (const Status free = output.empty() ? Nothing{} : checkFileTarget(output); !free)
            return complain(free.error().message, kBadInput);
    std::signal(SIGXFSZ, SIG_IGN); // A file that grows too large is a failed write, reported as such.

    Steps steps;
    const Result<Pack> pack = Pack::open(o.pack);
    if (!pack) return complain(pack.error().message, kBadInput);
    if (o.rows == TableRows::Face && !o.table.empty() && pack->index().sourceFaceCount == 0)
        return complain(
            concat(o.pack, ": the pack was not made from an OBJ scene, so it has no faces: use --per patch"),
            kBadInput);
    if (o.mode == gpu::kModeError && pack->tile().patchErrors.empty())
        return complain(concat(o.pack, ": the pack says nothing of errors, as of bakes by the paper's methods: "
                                       "bake it with --method heliopolis"),
                        kBadInput);
    if (o.picked >= pack->patchCount())
        return complain(concat("--pick ", o.picked, ": the pack has ", pack->patchCount(), " patches, 0 on"),
                        kBadInput);
    std::shared_ptr<const FirstLight> given;
    if (!o.firstLight.empty()) {
        const Result<FirstLight> read = readFirstLight(o.firstLight, *pack);
        if (!read) return complain(read.error().message, kBadInput);
        given = std::make_shared<const FirstLight>(*read);
    }
    const Result<Daylight> light = daylightOver(*pack, o.daylight);
    if (!light) return complain(concat(o.pack, ": ", light.error().message), kBadInput);
    const Result<Camera> camera = parseCamera(o.camera, *pack);
    if (!camera) return complain(camera.error().message, kBadInput);

    std::vector<PathKey> path;
    if (!o.path.empty()) {
        const Result<std::string> text = readTextFile(o.path);
        if (!text) return complain(text.error().message, kBadInput);
        Result<std::vector<PathKey>> keys = parseCameraPath(*text);
        if (!keys) return complain(concat(o.path, ": ", keys.error().message), kBadInput);
        path = std::move(*keys);
    }

    ContextOptions contextOptions;
    contextOptions.validation = o.validate;
    contextOptions.device = o.device;
    const Result<std::unique_ptr<Context>> opened = Context::create(contextOptions);
    if (!opened) return complain(opened.error().message, kInternal);
    Context& context = **opened;
    if (o.validate && !context.validating())
        return complain("the validation layer is missing: install the Debian package vulkan-validationlayers",
                        kInternal);
    const u32 largest = context.facts().maxImageDimension2D;
    if (o.width * o.samples > largest || o.height * o.samples > largest)
        return complain(concat("--size ", o.width, "x", o.height, " with ", o.samples,
                               " samples is beyond this device's ", largest,
                               " texels; make the picture or --samples smaller"),
                        kBadInput);
    std::printf("%s on %s: %u patches, %u nodes, %zu links\n", o.pack.c_str(), context.describe().c_str(),
                pack->patchCount(), pack->nodeCount(), pack->tile().linkColumns.size());
    steps.done("read the pack, open device");

    RendererOptions options;
    options.solve.residual = o.residual;
    options.solve.exactSweeps = o.sweeps;
    if (o.sunTexel > 0.0) options.sun.texel = o.sunTexel;
    options.upload.exactLinks = o.exactLinks;
    std::set<std::string> graphs;
    if (!o.dumpGraph.empty()) options.onGraph = [&](const std::string& dot) { graphs.insert(dot); };
    const Result<std::unique_ptr<Renderer>> created = Renderer::create(context, *pack, options);
    if (!created) return complain(concat(o.pack, ": ", created.error().message), kBadInput);
    Renderer& renderer = **created;
    steps.done("upload");

    if (!renderer.note().empty()) std::printf("Note: %s\n", renderer.note().c_str());
    if (o.day.empty()) std::printf("Light: %s\n", given ? o.firstLight.c_str() : light->description.c_str());
    if (!o.day.empty()) {
        const Status drawn = renderDay(renderer, context, *pack, *camera, o);
        if (!drawn) return complain(drawn.error().message, kBadInput);
        steps.done("day");
        printPictureNote(renderer);
        if (const Status written = writeGraphs(o, graphs); !written)
            return complain(written.error().message, kBadInput);
        return reportValidation(context, o);
    }
    renderer.setFirstLight(given);
    renderer.setSun(light->azimuthDeg, light->elevationDeg, light->dni);
    renderer.setSky(light->dhi, light->skyRadiance);
    renderer.setEmission(o.emission);
    SolveReport report = renderer.solve();
    for (u32 k = 1; k < o.sunSamples; ++k) report = renderer.refineSun();
    steps.done("solve");
    printSolve(o, report);
    const LightTables tables = renderer.readTables();
    printAudit(auditEnergy(pack->tile(), tables, o.emission));
    if (const Status written = o.path.empty() ? writePictures(renderer, *camera, o) : renderPath(renderer, path, o);
        !written)
        return complain(written.error().message, kBadInput);
    printPictureNote(renderer);
    if (!o.table.empty()) {
        const Result<std::string> text = tableText(*pack, tables, o.rows, describeLight(o, *light, report));
        if (!text) return complain(text.error().message, kBadInput);
        if (const Status written = writeTextAtomically(o.table, *text); !written)
            return complain(written.error().message, kBadInput);
    }
    steps.done("pictures and table");
    if (const Status written = writeGraphs(o, graphs); !written) return complain(written.error().message, kBadInput);
    return reportValidation(context, o);
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
