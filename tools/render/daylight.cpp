// SPDX-License-Identifier: Apache-2.0
#include "tools/render/daylight.h"

#include <glm/geometric.hpp>

#include "city/sky/calendar.h"
#include "city/sky/clear_sky.h"
#include "city/sky/solar_position.h"

namespace helio {
namespace {

/// The dome that a pack's sky patches but the ground beyond are the cells of. Error: none.
Result<SkyDome> domeOf(const Pack& pack)
{
    const auto& patches = pack.tile().skyPatches;
    const Error other{
        "the pack does not know parts of the sky apart: bake it with --sky-patches 48, or use --sky uniform"};
    const u32 cells = skyCellCount(patches);
    if (cells < 2 || cells > SkyDome::kMaxCells) return other;
    const SkyDome dome(cells);
    for (u32 cell = 0; cell < dome.cellCount(); ++cell)
        if (!(glm::distance(glm::dvec3(patches[cell].direction), dome.centreOf(cell)) < 1e-5)) return other;
    return dome;
}

std::string nameOf(const SkyChoice& sky)
{
    if (sky.kind == SkyKind::Cie) return concat("CIE sky ", sky.cieType);
    return sky.kind == SkyKind::Perez ? "Perez sky" : "uniform sky";
}

} // namespace

Result<Daylight> daylightOver(const Pack& pack, const DaylightOptions& options)
{
    Daylight light{options.azimuthDeg, options.elevationDeg, options.dni, options.dhi, {}, {}};
    double extraterrestrial = kSolarConstant;
    std::string when;
    if (!options.date.empty()) {
        const Result<double> day = parseJulianDay(options.date, options.time, options.utcOffset);
        if (!day) return day.error();
        const PackIndex& index = pack.index();
        Site site;
        site.latitudeDeg = index.latitudeDeg;
        site.longitudeDeg = index.longitudeDeg;
        const SunPosition sun = sunPosition(*day, site);
        light.azimuthDeg = sun.azimuthDeg;
        light.elevationDeg = sun.elevationDeg;
        extraterrestrial /= sun.distance * sun.distance;
        if (options.turbidity > 0.0) {
            const ClearSky clear =
                clearSky(sun.elevationDeg, options.turbidity, site.elevation, site.pressure, extraterrestrial);
            light.dni = clear.dni;
            light.dhi = clear.dhi;
        }
        when = concat(options.date, " ", options.time, " (UTC", options.utcOffset < 0.0 ? "" : "+", options.utcOffset,
                      ") at ", index.latitudeDeg, ", ", index.longitudeDeg, " degrees: ");
    }
    if (options.sky.kind != SkyKind::Uniform) {
        const Result<SkyDome> dome = domeOf(pack);
        if (!dome) return dome.error();
        const glm::dvec3 toSun = sunDirection(light.azimuthDeg, light.elevationDeg, pack.index().northDeg);
        SkyShape shape; // a sky without light is uniform, whatever its kind
        if (options.sky.kind == SkyKind::Cie)
            shape = cieSky(options.sky.cieType, toSun);
        else if (light.dhi > 0.0)
            shape = perezSky(light.dni, light.dhi, extraterrestrial, toSun);
        const bool linear = !pack.tile().skyOffsets.empty();
        for (const CellSky& cell : domeRadiance(*dome, shape, light.dhi, linear))
            light.skyRadiance.push_back({float(cell.mean), glm::vec2(cell.slope)});
    }
    light.description = concat(when, "sun azimuth ", light.azimuthDeg, " elevation ", light.elevationDeg,
                               " degrees, DNI ", light.dni, ", ", nameOf(options.sky), " DHI ", light.dhi);
    return light;
}

} // namespace helio
