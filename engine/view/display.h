// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <optional>

#include "engine/stages/sun_view.h"
#include "engine/view/camera.h"
#include "engine/view/light_state.h"
#include "engine/view/picture_sky.h"
#include "shaders/shared/view.h"

namespace helio {

/// What the forward pass needs to know about one picture, in its two parts. For display: tinted sun and sky, haze, the
/// sky of PictureSky, and panes that reflect it; else plain radiance before a uniform sky.
gpu::ForwardParams forwardParams(const Camera& camera, double aspect, const SunView& sun, bool display);

/// The ground beyond the scene.
struct FarGround
{
    double z = 0.0;      ///< m, where it lies
    glm::dvec3 rho{0.0}; ///< its reflectance; 0: the light solve knows none, and only pictures for display show one.
                         ///< They take its luminance alone, in the colour of fields
};
/// size: of the picture, in samples. sky: where the picture is for display.
gpu::ViewRecord viewRecord(const Camera& camera, glm::dvec2 size, const LightState& light, const SunView& sun,
                           const FarGround& ground, const std::optional<PictureSky>& sky);

/// Display scale of a radiance, per W/m2/sr: brings the scene's mean radiance to a fixed grey. meanRadiosity: W/m2,
/// area-weighted over the patches. Depends on the light alone, not on the camera, so pictures of one light compare.
double autoExposure(const glm::dvec4& meanRadiosity, const LightState& light);

/// Value shown as white in the debug view of a mode: W/m2 for irradiances and radiosity, m for the depth that is shown
/// as middle grey, 1 for visibility.
double falseColourScale(u32 mode, const glm::dvec4& meanRadiosity, const LightState& light);

} // namespace helio
