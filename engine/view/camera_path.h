// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
#include <vector>

#include "city/base/result.h"
#include "engine/view/camera.h"

namespace helio {

/// Where a camera is at a time.
struct PathKey
{
    double seconds = 0.0;
    Camera camera;
};

/// Reads a path: a line a key, "seconds x,y,z,tx,ty,tz[,fov]" (s, m, vertical degrees; times ascending, from 0 on), '#' and
/// what follows is a comment. Error: the line, and what is wrong with it; fewer than two keys.
Result<std::vector<PathKey>> parseCameraPath(std::string_view text);

/// The camera at a time: through every key, on cubic curves whose speed at a key is that from the key before to the key
/// after (Catmull and Rom 1974, for times that differ). Before the first and after the last key it stands there.
Camera cameraAt(const std::vector<PathKey>& path, double seconds);

} // namespace helio
