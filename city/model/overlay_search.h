// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/model/node_tree.h"
#include "city/model/patch_cells.h"
#include "city/model/shape_tree.h"

namespace helio {

/// Finds the patches that assets without a tile of their own stand before. Holds an index of one building at a time:
/// ask for the shapes of a building one after the other.
class OverlaySearch
{
public:
    /// `patchOfPiece`: one entry a piece of `cells`. Everything must outlive the search.
    OverlaySearch(const ShapeTree& shapes, const PatchCells& cells, const NodeTree& tree,
                  std::span<const u32> patchOfPiece);

    /// The patch behind a point (m) in the smallest subtree around a shape that has one near it; kNoIndex if the
    /// shape's building has no patch. Looks at each piece of the building at most once, and only at those that may be
    /// nearer than the best so far: O(log n + depth) for overlays that stand near their wall, O(n) at worst.
    u32 patchBehind(u32 shape, const glm::dvec3& centre);

private:
    struct Best
    {
        u32 patch = kNoIndex;
        double score = 1e300;
    };
    /// Bounds of patches: of their rectangles, their centroids and their normals.
    struct Bounds
    {
        glm::dvec3 low{1e300}, high{-1e300}, normalLow{1e300}, normalHigh{-1e300};
        void add(const Bounds& other);
    };
    std::span<const u32> childrenOf(u32 shape) const
    {
        return {childShapes_.data() + childBegin_[shape], childBegin_[shape + 1] - childBegin_[shape]};
    }
    void indexBuilding(u32 root);
    Bounds boundsOf(u32 patch) const;
    double score(u32 patch, const glm::dvec3& centre) const;
    /// Searches positions [begin, end) below a node of the index, which holds [first, first + span).
    void search(size_t node, u32 first, u32 span, u32 begin, u32 end, const glm::dvec3& centre, Best& best) const;

    const ShapeTree& shapes_;
    const PatchCells& cells_;
    const NodeTree& tree_;
    std::span<const u32> patchOfPiece_;
    std::vector<u32> childBegin_, childShapes_;
    std::vector<u32> begin_, end_; // per shape: positions of its subtree's pieces in its building's order
    u32 root_ = kNoIndex;          // of the building that the index holds
    std::vector<u32> order_;       // its patches, one a piece, parents before children
    std::vector<Bounds> bounds_;   // a binary tree over the order: node k has children 2k and 2k + 1
};

} // namespace helio
