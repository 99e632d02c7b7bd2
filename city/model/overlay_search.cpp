// SPDX-License-Identifier: Apache-2.0
#include "city/model/overlay_search.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

namespace helio {

OverlaySearch::OverlaySearch(const ShapeTree& shapes, const PatchCells& cells, const NodeTree& tree,
                             std::span<const u32> patchOfPiece)
    : shapes_(shapes), cells_(cells), tree_(tree), patchOfPiece_(patchOfPiece)
{
    const size_t count = shapes.shapes.size();
    childBegin_.assign(count + 1, 0);
    for (const Shape& shape : shapes.shapes)
        if (shape.parent != kNoIndex) ++childBegin_[shape.parent + 1];
    std::partial_sum(childBegin_.begin(), childBegin_.end(), childBegin_.begin());
    childShapes_.resize(childBegin_[count]);
    std::vector<u32> next(childBegin_.begin(), childBegin_.end() - 1);
    for (u32 i = 0; i < count; ++i)
        if (const u32 parent = shapes.shapes[i].parent; parent != kNoIndex) childShapes_[next[parent]++] = i;
}

u32 OverlaySearch::patchBehind(u32 shape, const glm::dvec3& centre) const
{
    constexpr double kNear = 0.5; // m: a patch this near, or as near by its score, is the one
    Best best;
    for (u32 ancestor = shapes_.shapes[shape].parent; ancestor != kNoIndex && best.score > kNear;
         ancestor = shapes_.shapes[ancestor].parent)
        searchBelow(ancestor, centre, best);
    return best.patch;
}

void OverlaySearch::searchBelow(u32 shape, const glm::dvec3& centre, Best& best) const
{
    for (u32 piece = cells_.pieceRow[shape]; piece < cells_.pieceRow[shape + 1]; ++piece) {
        const u32 patch = patchOfPiece_[piece];
        const Node& node = tree_.nodes[patch];
        const double height = glm::dot(centre - node.centroid, node.normal);
        // In-plane distance from the patch's bounding rectangle counts most, then the distance along the normal.
        const PlaneFrame frame = planeFrame(node.normal);
        glm::dvec2 lower(1e300), upper(-1e300);
        for (const Ring3& ring : tree_.outlineOf(patch))
            for (const glm::dvec3& q : ring) {
                const glm::dvec2 p(glm::dot(q - centre, frame.u), glm::dot(q - centre, frame.v));
                lower = glm::min(lower, p);
                upper = glm::max(upper, p);
            }
        const glm::dvec2 outside = glm::max(glm::max(lower, -upper), glm::dvec2(0.0));
        const double score = glm::length(outside) + (height < -0.01 ? 100.0 - height : 0.1 * height);
        if (score < best.score) best = {patch, score};
    }
    for (const u32 child : childrenOf(shape)) searchBelow(child, centre, best);
}

} // namespace helio
