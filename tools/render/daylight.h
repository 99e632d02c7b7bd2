// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "city/base/result.h"
#include "city/format/pack.h"
#include "city/sky/sky_model.h"
#include "engine/view/light_state.h"

namespace helio {

/// What the command line says of sun and sky.
struct DaylightOptions
{
    double azimuthDeg = 180.0, elevationDeg = 45.0; ///< of the sun, unless there is a date
    double dni = 800.0, dhi = 120.0;                ///< W/m2, unless there is a turbidity
    std::string date, time;                         ///< both or none
    double utcOffset = 0.0;                         ///< h, of the clock that shows `time`
    double turbidity = 0.0;                         ///< Linke's; 0 = dni and dhi are given
    SkyChoice sky;
};

/// Sun and sky over a pack.
struct Daylight
{
    double azimuthDeg = 0.0, elevationDeg = 0.0; ///< clockwise from true north; as it appears, refraction included
    double dni = 0.0, dhi = 0.0;                 ///< W/m2
    std::vector<CellRadiance> skyRadiance;       ///< of the cells of the pack's sky; empty = uniform
    std::string description;                     ///< one line
};

/// Places the sun by the pack's latitude and longitude where a date is given, and spreads the sky's light over the
/// pack's sky patches. Errors: a date or time that is none; a sky that is not uniform over a pack whose sky patches are
/// not those of a SkyDome of at least two cells.
Result<Daylight> daylightOver(const Pack& pack, const DaylightOptions& options);

} // namespace helio
