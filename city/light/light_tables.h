// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <vector>

#include "city/base/types.h"
#include "shaders/shared/records.h"

namespace helio {

/// Links in rows by receiver (CSR over all nodes, patches and inner nodes alike): irradiance_i += factor *
/// radiosity_column, plus moment . slope_column where senders are linear (linear_senders.h).
struct LinkTable
{
    std::vector<u32> rowBegin;     ///< nodeCount + 1
    std::vector<u32> column;       ///< sender node, ascending inside a row
    std::vector<float> factor;     ///< F(receiver to sender) x visibility, 0..1
    std::vector<glm::vec2> moment; ///< integral of factor x the sender's slope coordinates; empty: constant senders
    std::vector<gpu::ChildSlopeRecord> childSlopes; ///< parallel to NodeTree::children where there are moments
};

/// Sky links in rows by patch: E_sky_i = pi * sum factor * (radiance + slope . offset)(column). The sky patches are the
/// cells of a SkyDome, and after them the ground beyond the scene where there is one.
struct SkyTable
{
    std::vector<gpu::SkyPatchRecord> skyPatches;
    std::vector<u32> rowBegin; ///< patchCount + 1
    std::vector<u32> column;
    std::vector<float> factor;
    /// Mean of SkyDome::placeIn over what the patch sees of the cell, times 2, as two snorm16 (x in the low half);
    /// empty with a dome of one cell.
    std::vector<u32> offset;
};

} // namespace helio
