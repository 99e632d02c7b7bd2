// SPDX-License-Identifier: Apache-2.0
#include "tools/bake/export_command.h"

#include <cstdio>

#include "city/pack/export.h"
#include "city/pack/export_mitsuba.h"
#include "city/pack/export_radiance.h"
#include "tools/bake/interrupt.h"
#include "tools/support/complain.h"

namespace helio {
namespace {

Status writeAll(const Pack& pack, const ExportOptions& options, const SceneLight& light)
{
    Status status = Nothing{};
    if (!options.surfaces.empty()) status = writeSurfaces(pack, options.surfaces);
    if (status && !options.radiance.empty() && InterruptGuard::caught() == 0)
        status = writeRadiance(pack, light, options.radiance);
    if (status && !options.mitsuba.empty() && InterruptGuard::caught() == 0)
        status = writeMitsuba(pack, light, options.mitsuba, options.meters);
    return status;
}

} // namespace

CLI::App* addExportCommand(CLI::App& app, ExportOptions& options)
{
    CLI::App* command =
        app.add_subcommand("export", "write the patches as polygons, in the order of their ids, for other programs");
    command->add_option("PACK", options.pack, "pack folder")->required();
    command->add_option("--surfaces", options.surfaces, "OBJ and CSV: name of the two files without .obj and .csv");
    command->add_option("--radiance", options.radiance,
                        "Radiance: folder for scene, lights, sensor points and a README with the commands");
    command->add_option("--mitsuba", options.mitsuba,
                        "Mitsuba 3: name of the XML file; meshes, sky and sensor points go beside it");
    addSunOptions(*command, options.light);
    command->add_option("--points", options.points, "sensor points per patch, for Radiance and Mitsuba")
        ->check(CLI::Range(1u, 65536u))
        ->capture_default_str();
    command
        ->add_option("--meters", options.meters,
                     "Mitsuba: this many patches, evenly spaced by id, get an irradiancemeter each; it "
                     "measures E_sky + E_indirect, as no meter sees a directional sun")
        ->check(CLI::Range(0u, 100000u))
        ->capture_default_str();
    return command;
}

int runExport(const ExportOptions& options)
{
    if (options.surfaces.empty() && options.radiance.empty() && options.mitsuba.empty())
        return complain("export: --surfaces is required, or --radiance, or --mitsuba; see --help", kBadInput);
    const Result<Pack> pack = Pack::open(options.pack);
    if (!pack) return complain(pack.error().message, kBadInput);
    const Result<glm::dvec3> toSun = directionOfSun(options.light, pack->index().northDeg);
    if (!toSun) return complain(toSun.error().message, kBadInput);
    {
        const InterruptGuard guard;
        const Status written = writeAll(*pack, options, {*toSun, options.light.dni, options.light.dhi, options.points});
        if (InterruptGuard::caught() != 0) dieOf(InterruptGuard::caught());
        if (!written) return complain(written.error().message, kBadInput);
    }
    if (!options.surfaces.empty())
        std::printf("%s.obj, %s.csv: %u patches\n", options.surfaces.c_str(), options.surfaces.c_str(),
                    pack->patchCount());
    for (const std::string& scene : {options.radiance, options.mitsuba})
        if (!scene.empty())
            std::printf("%s: %u patches, %u sensor points each\n", scene.c_str(), pack->patchCount(), options.points);
    return kOk;
}

} // namespace helio
