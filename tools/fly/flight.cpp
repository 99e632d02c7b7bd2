// SPDX-License-Identifier: Apache-2.0
#include "tools/fly/flight.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace helio {
namespace {

double wrapDegrees(double degrees)
{
    const double wrapped = std::fmod(degrees, 360.0);
    return wrapped < 0 ? wrapped + 360.0 : wrapped;
}

} // namespace

Flight startFlight(glm::dvec3 eye, glm::dvec3 forward, double sceneSize, glm::dvec2 sunDegrees)
{
    Flight flight;
    flight.eye = eye;
    flight.headingDeg = glm::degrees(std::atan2(forward.x, forward.y));
    flight.pitchDeg = glm::degrees(std::asin(std::clamp(forward.z, -1.0, 1.0)));
    flight.speed = std::clamp(sceneSize / 20.0, 4.0, 30.0);
    flight.sunAzimuthDeg = sunDegrees.x;
    flight.sunElevationDeg = sunDegrees.y;
    advance(flight, {}, 0.0); // brings the angles into their ranges
    return flight;
}

glm::dvec3 viewDirection(const Flight& flight)
{
    const double heading = glm::radians(flight.headingDeg), pitch = glm::radians(flight.pitchDeg);
    return {std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch), std::sin(pitch)};
}

void advance(Flight& flight, const FlightInput& input, double seconds)
{
    flight.headingDeg = wrapDegrees(flight.headingDeg + input.turn.x);
    flight.pitchDeg = std::clamp(flight.pitchDeg + input.turn.y, -89.0, 89.0);

    const double heading = glm::radians(flight.headingDeg);
    const glm::dvec3 right(std::cos(heading), -std::sin(heading), 0.0);
    const double distance = flight.speed * seconds * (input.fast ? kFastFactor : 1.0);
    flight.eye += distance * (input.move.x * right + input.move.y * viewDirection(flight) +
                              input.move.z * glm::dvec3(0.0, 0.0, 1.0));

    flight.sunAzimuthDeg = wrapDegrees(flight.sunAzimuthDeg + kSunDegreesPerSecond * seconds * input.sun.x);
    flight.sunElevationDeg =
        std::clamp(flight.sunElevationDeg + kSunDegreesPerSecond * seconds * input.sun.y, -10.0, 90.0);
    flight.exposureStops = std::clamp(flight.exposureStops + kStopsPerSecond * seconds * input.exposure, -10.0, 10.0);
}

} // namespace helio
