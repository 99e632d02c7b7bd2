// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "city/base/result.h"
#include "city/sky/sky_dome.h"

namespace helio {

/// Solar irradiance outside the atmosphere at one astronomical unit, W/m2 (Kopp and Lean 2011).
inline constexpr double kSolarConstant = 1361.0;

/// Which distribution of radiance over the sky.
enum class SkyKind : u8
{
    Uniform,
    Cie,  ///< CIE S 011 / ISO 15469 general sky
    Perez ///< Perez, Seals, Michalsky 1993, from DNI and DHI
};

/// What a user asks for.
struct SkyChoice
{
    SkyKind kind = SkyKind::Uniform;
    u32 cieType = 1; ///< 1 to 15, and 16 = the traditional overcast sky, (1 + 2 sin of the elevation) / 3
};

/// Parses "uniform", "cie:N" with N of 1 to 16, or "perez". Error: one line.
Result<SkyChoice> parseSky(std::string_view text);

/// A distribution up to a factor: (1 + a exp(b / cos Z)) (1 + c exp(d chi) + offset + e cos^2 chi) for the zenith angle
/// Z of a direction and its angle chi to the sun.
struct SkyShape
{
    double a = 0.0, b = 0.0, c = 0.0, d = 0.0, e = 0.0;
    double offset = 0.0;              ///< -c exp(d pi/2) for CIE, 0 for Perez
    bool traditionalOvercast = false; ///< (1 + 2 cos Z) / 3 instead
    glm::dvec3 toSun{0.0, 0.0, 1.0};  ///< unit

    /// Radiance in an upward direction (unit, z > 0) in units of the shape's own, >= 0.
    double operator()(const glm::dvec3& direction) const;
};

/// CIE general sky of a type 1 to 16. A sun below the horizon counts as at it.
SkyShape cieSky(u32 type, const glm::dvec3& toSun);

/// Perez's all-weather sky. DNI and DHI in W/m2, DHI > 0; `extraterrestrial` is the normal irradiance above the
/// atmosphere. The brightness is kept within [0.01, 0.6] and at least 0.2 for clearness of 1.065 to 2.8, where the
/// published fit turns negative (as gendaylit does); a sun below the horizon counts as at it.
SkyShape perezSky(double dni, double dhi, double extraterrestrial, const glm::dvec3& toSun);

/// Radiance of a cell of a dome, W/m2/sr: mean + slope . SkyDome::placeIn, nowhere negative.
struct CellSky
{
    double mean = 0.0;
    glm::dvec2 slope{0.0};
};

/// Radiance of each cell of a dome: the shape's mean over the cell and, where `linear`, its slopes by least squares;
/// scaled so that an unobstructed horizontal plane gets `dhi` from these cells exactly. A shape that is dark everywhere
/// gives the uniform sky.
std::vector<CellSky> domeRadiance(const SkyDome& dome, const SkyShape& shape, double dhi, bool linear = true);

} // namespace helio
