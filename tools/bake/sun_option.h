// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "city/base/result.h"

namespace helio {

/// Sun and sky as the command line gives them.
struct SunOptions
{
    std::string sun = "180,45"; ///< AZIMUTH,ELEVATION in degrees, azimuth clockwise from true north
    double dni = 800.0, dhi = 120.0;
};

/// Adds --sun, --dni and --dhi; what heliopolis-render calls by the same names.
void addSunOptions(CLI::App& app, SunOptions& options);

/// Unit vector to the sun in a tile frame whose +y points northDeg clockwise from true north; or what is wrong with the
/// text.
Result<glm::dvec3> directionOfSun(const SunOptions& options, double northDeg);

} // namespace helio
