// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "engine/graph/frame_graph.h"
#include "engine/stages/draw_list.h"
#include "engine/stream/smooth_tables.h"
#include "shaders/shared/view.h"

namespace helio {

inline constexpr VkFormat kRadianceFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
inline constexpr VkFormat kDisplayFormat = VK_FORMAT_R8G8B8A8_UNORM;

/// Soft light of every patch, W/m2: skyTint E_sky + E_indirect. sky, light: vec4 a patch; indirect: vec4 a node,
/// patches first.
[[nodiscard]] Ref<Buffer> addSoftLight(FrameGraph& graph, const TileTables& tile, Ref<Buffer> sky, Ref<Buffer> indirect,
                                       const glm::vec4& skyTint, Ref<Buffer> light);

/// Soft light at the corners and in the middles of the smooth mesh, W/m2: see SmoothTables::values. The mean over a
/// patch is its own value, of `means`; 0 where that is negative.
[[nodiscard]] Ref<Buffer> addSmoothLight(FrameGraph& graph, const SmoothTables& mesh, Ref<Buffer> means);

/// What the forward pass reads. All W/m2, vec4 a patch.
struct ShadeInputs
{
    gpu::ForwardParams params{};
    Ref<Buffer> view;   ///< ViewRecord
    Ref<Image> shadow;  ///< depth array of the sun raster
    Ref<Buffer> shown;  ///< what a debug view shows
    Ref<Buffer> light;  ///< final: of addSoftLight; else any of its kind
    Ref<Buffer> smooth; ///< of addSmoothLight where the smooth mesh is drawn; else any of its kind
    u32 mode = gpu::kModeFinal;
    bool emitters = false; ///< some patch emits
};

struct ShadeTargets
{
    Ref<Image> radiance; ///< RGBA32F
    Ref<Image> depth;    ///< D32, reversed
};

/// Stage 4: the city (`lists`, and of the smooth mesh `smoothLists`) and the sky behind it. final: radiance in W/m2/sr;
/// other modes: the quantity itself (ids: a colour, the id in alpha; depth: distance from the eye in m); background 0,
/// or -1 in alpha for ids and depth.
ShadeTargets addForward(FrameGraph& graph, const TileTables& tile, const FacingLists& lists,
                        const SmoothTables& smoothMesh, const FacingLists& smoothLists, const ShadeInputs& in,
                        ShadeTargets targets);

/// Radiance to display: samples^2 texels of `radiance` a pixel of `display` (RGBA8, sRGB). mode: gpu::kMode...
[[nodiscard]] Ref<Image> addTone(FrameGraph& graph, Ref<Image> radiance, Ref<Image> display, u32 mode, u32 samples,
                                 const gpu::ToneParams& params);

} // namespace helio
