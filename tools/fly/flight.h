// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "city/base/types.h"

namespace helio {

/// What keys and mouse ask for during one frame.
struct FlightInput
{
    glm::dvec3 move{0.0};  ///< right, forward, up: -1, 0 or 1 each
    bool fast = false;     ///< six times the speed
    glm::dvec2 turn{0.0};  ///< degrees, right and up
    glm::dvec2 sun{0.0};   ///< azimuth and elevation: -1, 0 or 1 each
    double exposure = 0.0; ///< -1, 0 or 1
};

/// All that the keys change: where the camera is, where the sun is, how bright the picture is.
struct Flight
{
    glm::dvec3 eye{0.0};          ///< m, tile frame
    double headingDeg = 0.0;      ///< clockwise from +y, [0, 360)
    double pitchDeg = 0.0;        ///< above the horizon, [-89, 89]
    double speed = 20.0;          ///< m/s
    double sunAzimuthDeg = 0.0;   ///< clockwise from true north, [0, 360)
    double sunElevationDeg = 0.0; ///< [-10, 90]
    double exposureStops = 0.0;   ///< added to the picture's exposure, [-10, 10]

    bool operator==(const Flight&) const = default;
};

inline constexpr double kFastFactor = 6.0;
inline constexpr double kSunDegreesPerSecond = 20.0;
inline constexpr double kStopsPerSecond = 2.0;

/// A flight that starts at a point with a view (unit), at a speed that crosses a scene of this size (m, of its
/// diagonal) in 20 s, but 4 to 30 m/s. The sun is given in degrees.
Flight startFlight(glm::dvec3 eye, glm::dvec3 forward, double sceneSize, glm::dvec2 sunDegrees);

/// Unit view direction in the tile frame (x east, y north, z up).
glm::dvec3 viewDirection(const Flight& flight);

/// Moves everything by `seconds` of this input: the eye along the view (W, S), level sideways (A, D) and straight up
/// (E, Q); the sun by 20 degrees and the exposure by 2 stops a second. Angles stay in their ranges.
void advance(Flight& flight, const FlightInput& input, double seconds);

} // namespace helio
