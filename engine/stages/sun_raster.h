// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "engine/graph/frame_graph.h"
#include "engine/stages/draw_list.h"
#include "engine/stages/sun_view.h"

namespace helio {

inline constexpr VkFormat kIdFormat = VK_FORMAT_R32_UINT;
inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

/// What the sun sees: the patch of each texel of one view (background kNone), and the depth of all views (one layer
/// each).
struct SunPictures
{
    Ref<Image> ids;   ///< R32_UINT, of the view rastered last
    Ref<Image> depth; ///< D32 array
};

/// Stage 1, one view: the nearest surface wins. The first view may find anything in the images; each view replaces the
/// ids and its own layer of the depth.
SunPictures addSunRaster(FrameGraph& graph, const TileTables& tile, const FacingLists& lists, const SunView& sun,
                         u32 view, SunPictures pictures);

} // namespace helio
