// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <span>

#include "engine/view/light_state.h"
#include "shaders/shared/records.h"

namespace helio {

/// The sky of a picture for display: radiance of direction d, W/m2/sr, linear r, g, b (shaders/lib/sky.glsl):
/// zenith (1 - h) + horizon h + glow (c^8 / 4 + c^64 / 2), h = (1 - d.z)^3, c = cosine to the sun, at least 0.
struct PictureSky
{
    glm::dvec3 zenith{0.0}, horizon{0.0}, glow{0.0};
    /// Of the light that sky and sun give to surfaces; luminance 1.
    glm::dvec3 tint{1.0}, sunTint{1.0};
};

/// Fits that sky to the light: in luminance by least squares to the cells' radiances, where it has some that shine,
/// else of the shape of a clear sky; the horizon at least a quarter as bright as the zenith; and such that an open
/// horizontal plane gets the DHI. Colours are for display alone: blue above and warm below where the sun is low, grey
/// where the sun stands above the horizon and does not come through. skyPatches: those of the pack.
PictureSky pictureSky(std::span<const gpu::SkyPatchRecord> skyPatches, const LightState& light);

/// Of linear r, g, b (Rec. 709).
double luminance(const glm::dvec3& colour);
/// Scales a colour to luminance 1, so that a tint changes no brightness.
glm::dvec3 tintOf(const glm::dvec3& colour);

} // namespace helio
