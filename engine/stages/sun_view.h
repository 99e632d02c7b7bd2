// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "city/base/types.h"
#include "engine/stream/draw_chunks.h"

namespace helio {

/// How fine the sun looks.
struct SunViewOptions
{
    double texel = 0.04;        ///< m; smaller: slower; larger: noisy counts of small patches, coarse shadow edges
    u64 maxTexels = 4ull << 24; ///< over all views (4 x 4096^2): the texel grows when the scene needs more
    u32 maxViewSize = 4096;     ///< texels of one view, along each side
    u32 maxViews = 256;         ///< layers that the device offers
};

/// The sun's orthographic picture of the scene: a rectangle in light space, cut into a grid of views of the same size.
struct SunView
{
    glm::vec3 towardsSun{0.0f, 0.0f, 1.0f}; ///< unit
    glm::mat4 gridFromWorld{1.0f};          ///< x in [0, gridX], y in [0, gridY] (y up), z in [0, 1] away from the sun
    float shear = 0.0f; ///< added to y a unit of x from the left edge of each view, see clipFromWorld
    u32 gridX = 1, gridY = 1;
    u32 width = 1, height = 1; ///< texels of one view
    double texel = 1.0;        ///< m, side of a texel
    double depthRange = 1.0;   ///< m

    double texelArea() const { return texel * texel; }
    u32 viewCount() const { return gridX * gridY; }
    /// Clip space of view (x, y) of the grid: view index = y * gridX + x.
    glm::mat4 clipFromWorld(u32 view) const;
};

/// The same picture with its texels moved by less than one: sample `sample` of the R2 sequence (Roberts, "The
/// unreasonable effectiveness of quasirandom sequences", 2018), of which sample 0 moves nothing. Counts of several
/// samples add up to a finer picture.
SunView shiftedView(const SunView& view, u32 sample);

/// Fits the picture to the boxes: the rectangle of smallest area (over all rolls about the direction) that holds them,
/// with a margin of one to two texels. Texels lie fast on the centre of the boxes, and their size is the one asked for
/// times a power of 1.02, so that a sun that moves a little moves them little. A long canyon gets pixels shaped to it.
/// towardsSun: unit vector. boxes: at least one.
SunView fitSunView(std::span<const Box> boxes, glm::dvec3 towardsSun, const SunViewOptions& options);

} // namespace helio
