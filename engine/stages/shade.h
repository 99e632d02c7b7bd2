// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "engine/graph/frame_graph.h"
#include "engine/stages/draw_list.h"
#include "shaders/shared/view.h"

namespace helio {

inline constexpr VkFormat kRadianceFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
inline constexpr VkFormat kDisplayFormat = VK_FORMAT_R8G8B8A8_UNORM;

/// Corners of the static mesh on the device (see Corners).
struct CornerTables
{
    u32 count = 0;
    Buffer ofVertex, rows, patches;
};

/// E_sky and E_indirect at the corners: two vec4 a corner, W/m2. sky: vec4 a patch; indirect: vec4 a node.
[[nodiscard]] Ref<Buffer> addSmoothLight(FrameGraph& graph, const CornerTables& corners, Ref<Buffer> sky,
                                         Ref<Buffer> indirect, Ref<Buffer> values, Reads reads);

/// What the forward pass reads. All W/m2; vec4 a patch (radiosity and indirect: a node, patches first).
struct ShadeInputs
{
    gpu::ForwardParams params{};
    Ref<Buffer> view;  ///< ViewRecord
    Ref<Image> shadow; ///< depth array of the sun raster
    Ref<Buffer> sun, sky, indirect, radiosity;
    Ref<Buffer> cornerOfVertex; ///< u32 a static vertex; any buffer when light is not interpolated
    Ref<Buffer> smooth;         ///< values of addSmoothLight, likewise
    u32 mode = gpu::kModeFinal;
    bool interpolate = false; ///< light of the static mesh by `smooth`
    bool emitters = false;    ///< some patch emits
};

struct ShadeTargets
{
    Ref<Image> radiance; ///< RGBA32F
    Ref<Image> depth;    ///< D32, reversed
};

/// Stage 4: the city and the sky behind it. final: radiance in W/m2/sr; other modes: the quantity itself (ids: a
/// colour, the id in alpha; depth: distance from the eye in m); background 0, or -1 in alpha for ids and depth.
ShadeTargets addForward(FrameGraph& graph, const TileTables& tile, const DrawList& list, const ShadeInputs& in,
                        ShadeTargets targets);

/// Radiance to display: params.samples^2 texels of `radiance` a pixel of `display` (RGBA8, sRGB).
[[nodiscard]] Ref<Image> addTone(FrameGraph& graph, Ref<Image> radiance, Ref<Image> display,
                                 const gpu::ToneParams& params);

} // namespace helio
