// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "engine/view/camera_path.h"
#include "engine/view/renderer.h"
#include "tools/render/options.h"

namespace helio {

/// Draws o.frames pictures along a path, from its first key to its last, under the light that is set:
/// stages 1 to 3 run once. Files: NAME-0000.png and so on beside o.png; with o.sheet one picture of all. Prints a line a
/// frame. Error: a file.
Status renderPath(Renderer& renderer, const std::vector<PathKey>& path, const RenderOptions& o);

/// Draws the times of o.day that have the sun above the horizon, o.every minutes apart, each solved from the solution
/// before it. Files as renderPath's, by their time: NAME-0610.png. Prints sun, sweeps and times of each; with o.lag also
/// how far its E_indirect is from a solution to 1e-6, rms over the mean. Error: the day, no sun, or a file.
Status renderDay(Renderer& renderer, Context& context, const Pack& pack, const Camera& camera, const RenderOptions& o);

} // namespace helio
