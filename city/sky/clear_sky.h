// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace helio {

/// Sunlight under a cloudless sky, W/m2.
struct ClearSky
{
    double dni = 0.0; ///< direct, on a plane that faces the sun
    double dhi = 0.0; ///< diffuse, on the horizontal
};

/// P. Ineichen, R. Perez, "A new airmass independent formulation for the Linke turbidity coefficient", Solar Energy 73
/// (2002): from the sun's apparent elevation (degrees), the Linke turbidity (1 = clean and dry, 2-3 cold or rural air,
/// 4-6 hot, humid or urban), the height above the sea (m), the pressure (hPa) and the normal irradiance above the
/// atmosphere (W/m2). Both are 0 for a sun at or below the horizon.
ClearSky clearSky(double elevationDeg, double turbidity, double height, double pressure, double extraterrestrial);

} // namespace helio
