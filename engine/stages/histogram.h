// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "engine/graph/frame_graph.h"

namespace helio {

/// Two ways to the same counts; which is faster depends on what atomics cost on the device.
enum class HistogramVariant
{
    Columns,   ///< one atomic a run of a lane
    Subgroups, ///< equal runs that end side by side are summed over the subgroup first
};

/// Stage 2: adds to counts[id] the number of texels of each id < patchCount in a width x height picture. Exact.
[[nodiscard]] Ref<Buffer> addHistogram(FrameGraph& graph, Ref<Image> ids, Ref<Buffer> counts, u32 width, u32 height,
                                       u32 patchCount, HistogramVariant variant = HistogramVariant::Columns);

/// The faster variant on this device: both count a small picture of patches, three times each; once a context. Columns
/// where the device has no timestamps.
HistogramVariant fasterHistogram(Context& context);

} // namespace helio
