// SPDX-License-Identifier: Apache-2.0
#include "city/model/overlay_search.h"

#include <algorithm>
#include <bit>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

namespace helio {
namespace {

constexpr double kBehind = -0.01;      // m: below this height a point is behind the patch
constexpr double kBehindScore = 100.0; // what that costs
constexpr double kHeightWeight = 0.1;
// m: a point just behind a patch gains up to kHeightWeight * |kBehind|, which the bounds by distance do not know.
constexpr double kSlack = 3e-3;

/// Bounding rectangle of a patch in its plane, m from `origin`.
struct Rectangle
{
    PlaneFrame frame;
    glm::dvec2 low{1e300}, high{-1e300};
};

Rectangle rectangleOf(const NodeTree& tree, u32 patch, const glm::dvec3& origin)
{
    Rectangle r;
    r.frame = planeFrame(tree.nodes[patch].normal);
    for (const Ring3& ring : tree.outlineOf(patch))
        for (const glm::dvec3& q : ring) {
            const glm::dvec2 p(glm::dot(q - origin, r.frame.u), glm::dot(q - origin, r.frame.v));
            r.low = glm::min(r.low, p);
            r.high = glm::max(r.high, p);
        }
    return r;
}

} // namespace

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
    begin_.resize(count);
    end_.resize(count);
    std::vector<u32> next(childBegin_.begin(), childBegin_.end() - 1);
    for (u32 i = 0; i < count; ++i)
        if (const u32 parent = shapes.shapes[i].parent; parent != kNoIndex) childShapes_[next[parent]++] = i;
}

void OverlaySearch::Bounds::add(const Bounds& other)
{
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
    normalLow = glm::min(normalLow, other.normalLow);
    normalHigh = glm::max(normalHigh, other.normalHigh);
}

u32 OverlaySearch::patchBehind(u32 shape, const glm::dvec3& centre)
{
    constexpr double kNear = 0.5; // m: a patch this near, or as near by its score, is the one
    u32 root = shape;
    while (shapes_.shapes[root].parent != kNoIndex) root = shapes_.shapes[root].parent;
    if (root != root_) indexBuilding(root);
    Best best;
    const u32 span = u32(bounds_.size() / 2);
    u32 from = begin_[shape], to = from; // searched already
    for (u32 ancestor = shapes_.shapes[shape].parent; ancestor != kNoIndex && best.score > kNear;
         ancestor = shapes_.shapes[ancestor].parent) {
        search(1, 0, span, begin_[ancestor], from, centre, best);
        search(1, 0, span, to, end_[ancestor], centre, best);
        from = begin_[ancestor];
        to = end_[ancestor];
    }
    return best.patch;
}

void OverlaySearch::indexBuilding(u32 root)
{
    root_ = root;
    order_.clear();
    std::vector<std::pair<u32, bool>> stack{{root, false}}; // shape, and whether it has been entered
    while (!stack.empty()) {
        const auto [shape, entered] = stack.back();
        if (entered) {
            end_[shape] = u32(order_.size());
            stack.pop_back();
            continue;
        }
        stack.back().second = true;
        begin_[shape] = u32(order_.size());
        for (u32 piece = cells_.pieceRow[shape]; piece < cells_.pieceRow[shape + 1]; ++piece)
            order_.push_back(patchOfPiece_[piece]);
        const std::span<const u32> children = childrenOf(shape);
        for (size_t i = children.size(); i-- > 0;) stack.emplace_back(children[i], false);
    }
    const size_t span = std::bit_ceil(std::max<size_t>(order_.size(), 1));
    bounds_.assign(2 * span, {});
    for (size_t i = 0; i < order_.size(); ++i) bounds_[span + i] = boundsOf(order_[i]);
    for (size_t k = span; k-- > 1;) {
        bounds_[k] = bounds_[2 * k];
        bounds_[k].add(bounds_[2 * k + 1]);
    }
}

OverlaySearch::Bounds OverlaySearch::boundsOf(u32 patch) const
{
    const Node& node = tree_.nodes[patch];
    const Rectangle r = rectangleOf(tree_, patch, node.centroid);
    Bounds bounds{node.centroid, node.centroid, node.normal, node.normal};
    for (const double u : {r.low.x, r.high.x})
        for (const double v : {r.low.y, r.high.y}) {
            const glm::dvec3 corner = node.centroid + u * r.frame.u + v * r.frame.v;
            bounds.low = glm::min(bounds.low, corner);
            bounds.high = glm::max(bounds.high, corner);
        }
    return bounds;
}

double OverlaySearch::score(u32 patch, const glm::dvec3& centre) const
{
    const Node& node = tree_.nodes[patch];
    const double height = glm::dot(centre - node.centroid, node.normal);
    // In-plane distance from the patch's bounding rectangle counts most, then the distance along the normal.
    const Rectangle r = rectangleOf(tree_, patch, centre);
    const glm::dvec2 outside = glm::max(glm::max(r.low, -r.high), glm::dvec2(0.0));
    return glm::length(outside) + (height < kBehind ? kBehindScore - height : kHeightWeight * height);
}

void OverlaySearch::search(size_t node, u32 first, u32 span, u32 begin, u32 end, const glm::dvec3& centre,
                           Best& best) const
{
    if (begin >= first + span || end <= first || begin >= end || first >= order_.size()) return;
    const Bounds& b = bounds_[node];
    // No score is below the weighted distance from the box, nor, where all patches face away, below that penalty.
    const double distance = glm::length(glm::max(glm::max(b.low - centre, centre - b.high), glm::dvec3(0.0)));
    const glm::dvec3 near = centre - b.high, far = centre - b.low;
    const glm::dvec3 highest =
        glm::max(glm::max(near * b.normalLow, near * b.normalHigh), glm::max(far * b.normalLow, far * b.normalHigh));
    const bool behind = highest.x + highest.y + highest.z < kBehind - kSlack;
    if ((behind ? kBehindScore + distance : kHeightWeight * distance) - kSlack >= best.score) return;
    if (span == 1) {
        const u32 patch = order_[first];
        if (const double s = score(patch, centre); s < best.score) best = {patch, s};
        return;
    }
    search(2 * node, first, span / 2, begin, end, centre, best);
    search(2 * node + 1, first + span / 2, span / 2, begin, end, centre, best);
}

} // namespace helio
