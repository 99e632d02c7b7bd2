// SPDX-License-Identifier: Apache-2.0
#include "tools/bake/sun_option.h"

#include <cstdio>
#include <numbers>

#include "city/light/sun.h"
#include "tools/support/number_in.h"

namespace helio {

void addSunOptions(CLI::App& app, SunOptions& options)
{
    app.add_option("--sun", options.sun, "azimuth,elevation in degrees; azimuth clockwise from true north")
        ->capture_default_str();
    app.add_option("--dni", options.dni, "direct normal irradiance of the sun, W/m2")
        ->check(numberIn(0.0, 1e6))
        ->capture_default_str();
    app.add_option("--dhi", options.dhi, "diffuse horizontal irradiance of the uniform sky, W/m2")
        ->check(numberIn(0.0, 1e6))
        ->capture_default_str();
}

Result<glm::dvec3> directionOfSun(const SunOptions& options, double northDeg)
{
    double azimuth = 0.0, elevation = 0.0;
    int used = 0;
    if (std::sscanf(options.sun.c_str(), "%lf,%lf%n", &azimuth, &elevation, &used) != 2 ||
        size_t(used) != options.sun.size() || !(azimuth >= -360.0 && azimuth <= 360.0) ||
        !(elevation >= -90.0 && elevation <= 90.0))
        return Error{
            concat("--sun ", options.sun, ": expected AZIMUTH,ELEVATION in degrees, -360 to 360 and -90 to 90")};
    constexpr double kDegree = std::numbers::pi / 180.0;
    return sunDirection((azimuth - northDeg) * kDegree, elevation * kDegree);
}

} // namespace helio
