// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "engine/view/renderer.h"
#include "tests/screens/ray_view.h"

namespace helio {

/// The rays of an engine camera.
RayCamera rayCamera(const Camera& camera, double aspect);

/// Draws the sun visibility of the renderer's present sun, and compares it with one primary ray and one shadow ray a
/// pixel.
Agreement checkSunVisibility(Renderer& renderer, const RayScene& rays, const Camera& camera, u32 width, u32 height);

/// Share of the pixels without an edge or a patch's border within one pixel where picture and rays see the same patch.
double checkPatchIds(Renderer& renderer, const RayScene& rays, const Camera& camera, u32 width, u32 height);

/// "99.87 % of 123 456 pixels agree (...)": one line.
std::string describe(const Agreement& agreement);

} // namespace helio
