// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace helio {

/// Where an observer stands.
struct Site
{
    double latitudeDeg = 0.0;  ///< north positive, [-90, 90]
    double longitudeDeg = 0.0; ///< east positive, [-180, 180]
    double elevation = 0.0;    ///< m above the sea
    double pressure = 1013.25; ///< hPa, yearly mean at the site; only the refraction needs it
    double temperature = 12.0; ///< degrees Celsius, yearly mean; only the refraction needs it
};

/// The sun as seen from a site.
struct SunPosition
{
    double azimuthDeg = 0.0;       ///< clockwise from true north, [0, 360)
    double elevationDeg = 0.0;     ///< of the centre of the disc above the horizon, as it appears: refraction included
    double trueElevationDeg = 0.0; ///< the same without refraction
    double distance = 1.0;         ///< of the Earth from the sun, astronomical units
};

/// Terrestrial time minus universal time, s: its value of 2017 to 2026. A second moves the sun by 1.1e-5 degrees
/// against the stars, so that the true values of 1900 to 2100 (-3 to about 200 s) stay within 0.0015 degrees.
inline constexpr double kDeltaT = 69.0;

/// Position of the sun, uncertainty 0.0003 degrees in the years -2000 to 6000: I. Reda, A. Andreas, "Solar position
/// algorithm for solar radiation applications", Solar Energy 76 (2004), NREL/TP-560-34302 revised 2008, sections
/// 3.1-3.14. `julianDay` counts universal time; UTC for it adds at most 0.004 degrees. Refraction as there (Bennett's
/// formula, scaled by pressure and temperature) down to where the disc's upper limb touches the horizon, none below.
SunPosition sunPosition(double julianDay, const Site& site, double deltaT = kDeltaT);

/// Pressure of the standard atmosphere (ISO 2533) at a height above the sea, m, up to 11,000; hPa.
double standardPressure(double elevation);

} // namespace helio
