// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "city/base/types.h"
#include "city/format/pack.h"
#include "shaders/shared/records.h"
#include "shaders/shared/solve.h"

namespace helio {

/// The static mesh cut finer, for a light that is linear in each triangle, keeps the mean of every patch and is
/// continuous over the coplanar patches of a building. A patch becomes a fan around its centroid, or one fan around
/// each of its triangles' where not all of its border is seen from there. The border runs through all corners on it, so
/// that neighbours share every edge.
///
/// With m the mean of a patch and v_k the values at its corners the middle of its fan has c = m + sum weight_k (m -
/// v_k), weight_k = area of the triangles at corner k / area of the patch: the mean over the patch is m. Where it has
/// several fans, the middle of one has c + turn x (b - a): b the mean over the border of the fan, a = sum weight_k v_k
/// / 2 that of all, which leaves the mean as it is; turn is 1, less where some middle would be negative.
struct SmoothMesh
{
    std::vector<gpu::VertexRecord> vertices;
    std::vector<u32> indices;
    u32 cornerCount = 0;
    /// Of what a vertex takes its value: corners, then patches (the middle of one fan), then fans of patches that have
    /// several. Triangles that are not in the plane of their patch (reveals, cut assets) have a fan without corners:
    /// its value is the mean.
    std::vector<u32> valueOfVertex;

    std::vector<u32> cornerRows;                       ///< corners + 1 offsets into cornerPatches
    std::vector<u32> cornerPatches;                    ///< those that have a weight for the corner, ascending
    std::vector<u32> patchRows;                        ///< patches + 1 offsets into patchWeights
    std::vector<gpu::CornerWeightRecord> patchWeights; ///< sum 2 a patch; none: nothing of it has corners
    std::vector<u32> fanRows;                          ///< patches + 1 offsets: fans with a value of their own
    std::vector<u32> fanWeightRows;                    ///< fans + 1 offsets into fanWeights
    std::vector<gpu::CornerWeightRecord> fanWeights;   ///< sum 1 a fan, or none
};

/// indices: triangles of the static mesh (staticTriangles). dark: patches that no light can reach (darkPatches), or
/// empty: they keep the value of the patch and their neighbours' corners do not know of them. Triangles thinner than
/// kCornerJoin are left out: the border of their neighbours runs through their corners. A patch that has no others of
/// its colour keeps them, with one value.
SmoothMesh buildSmoothMesh(std::span<const gpu::VertexRecord> vertices, std::span<const u32> indices,
                           std::span<const gpu::PatchRecord> patches, const std::vector<bool>& dark);

/// Patches that neither see the sky nor have a link, of their own or of an ancestor: others cover them.
/// Empty for a tile without rows of links.
std::vector<bool> darkPatches(const TileView& tile);

} // namespace helio
