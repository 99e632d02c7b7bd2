// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "city/base/result.h"
#include "tools/fly/flight.h"

namespace helio {

inline constexpr double kScriptStep = 1.0 / 60.0; ///< s, a frame of a scripted flight, however long it takes

/// One step of a script: an input held for some frames, or a change at once.
struct ScriptStep
{
    enum class Kind
    {
        Hold,      ///< `input` for `frames` frames
        Turn,      ///< `pair` degrees right and up
        Sun,       ///< `pair` azimuth, elevation
        Size,      ///< `pair` width, height of the window in pixels
        View,      ///< debug view `number`, 1..9
        Screenshot ///< to `path`
    };
    Kind kind = Kind::Hold;
    FlightInput input;
    u32 frames = 0;
    glm::dvec2 pair{0.0};
    u32 number = 0;
    std::string path;
};

/// Reads "forward 1; turn 30,-5; sun 180,30; size 640,360; view 2; screenshot A.png": steps divided by semicolons. Held
/// for some seconds (rounded to frames, at most 600): forward, back, left, right, up, down, wait. Error: names the step
/// and what is expected.
Result<std::vector<ScriptStep>> parseScript(std::string_view text);

} // namespace helio
