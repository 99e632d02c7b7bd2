// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "engine/graph/frame_graph.h"

namespace helio {

struct HistogramOptions
{
    bool aggregate = true; ///< sum equal runs over a subgroup before the atomic; false: the plain twin, same counts
};

/// Stage 2: adds to counts[id] the number of texels of each id < patchCount in a width x height picture. Exact.
[[nodiscard]] Ref<Buffer> addHistogram(FrameGraph& graph, Ref<Image> ids, Ref<Buffer> counts, u32 width, u32 height,
                                       u32 patchCount, const HistogramOptions& options = {});

} // namespace helio
