// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/model/node_tree.h"
#include "city/model/patch_cells.h"
#include "city/model/shape_tree.h"

namespace helio {

/// Finds the patches that assets without a tile of their own stand before.
class OverlaySearch
{
public:
    /// `patchOfPiece`: one entry a piece of `cells`. Everything must outlive the search.
    OverlaySearch(const ShapeTree& shapes, const PatchCells& cells, const NodeTree& tree,
                  std::span<const u32> patchOfPiece);

    /// The patch behind a point (m) in the smallest subtree around a shape that has one near it; kNoIndex if the
    /// shape's building has no patch.
    u32 patchBehind(u32 shape, const glm::dvec3& centre) const;
    std::span<const u32> childrenOf(u32 shape) const
    {
        return {childShapes_.data() + childBegin_[shape], childBegin_[shape + 1] - childBegin_[shape]};
    }

private:
    struct Best
    {
        u32 patch = kNoIndex;
        double score = 1e300;
    };
    void searchBelow(u32 shape, const glm::dvec3& centre, Best& best) const;

    const ShapeTree& shapes_;
    const PatchCells& cells_;
    const NodeTree& tree_;
    std::span<const u32> patchOfPiece_;
    std::vector<u32> childBegin_, childShapes_;
};

} // namespace helio
