// SPDX-License-Identifier: Apache-2.0
#include "engine/stream/contraction.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <limits>

namespace helio {

namespace {

/// Adds up `ofLink(k)` over the links of each patch and of its ancestors.
template <class OfLink> std::vector<double> sumsAlong(const TileView& tile, OfLink&& ofLink)
{
    std::vector<double> sums(tile.nodes.size(), 0.0);
    for (size_t i = sums.size(); i-- > 0;) { // parents come after their children
        for (u32 k = tile.linkRows[i]; k < tile.linkRows[i + 1]; ++k) sums[i] += ofLink(k);
        if (const u32 parent = tile.nodes[i].parent; parent != kNoIndex) sums[i] += sums[parent];
    }
    sums.resize(tile.patches.size());
    return sums;
}

/// Where the patches below a node lie, in its slope coordinates.
struct SlopeBox
{
    glm::dvec2 lo{0.0}, hi{0.0};
};

/// Smallest and largest a x over the box.
glm::dvec2 rangeOf(const glm::dvec2& a, const SlopeBox& box)
{
    const glm::dvec2 low = a * box.lo, high = a * box.hi, least = glm::min(low, high), most = glm::max(low, high);
    return {least.x + least.y, most.x + most.y};
}

std::vector<SlopeBox> slopeBoxes(const TileView& tile)
{
    std::vector<SlopeBox> boxes(tile.nodes.size());
    for (size_t i = tile.patches.size(); i < boxes.size(); ++i) {
        const gpu::NodeRecord& node = tile.nodes[i];
        SlopeBox box{glm::dvec2(std::numeric_limits<double>::infinity()),
                     glm::dvec2(-std::numeric_limits<double>::infinity())};
        for (u32 k = node.childBegin; k < node.childBegin + node.childCount; ++k) {
            const gpu::ChildSlopeRecord& s = tile.childSlopes[k];
            const SlopeBox& child = boxes[tile.children[k]];
            const glm::dvec2 x = double(s.offsetX) + rangeOf({double(s.xx), double(s.xy)}, child),
                             y = double(s.offsetY) + rangeOf({double(s.yx), double(s.yy)}, child);
            box.lo = glm::min(box.lo, glm::dvec2(x.x, y.x));
            box.hi = glm::max(box.hi, glm::dvec2(x.y, y.y));
        }
        if (node.childCount > 0) boxes[i] = box;
    }
    return boxes;
}

} // namespace

std::vector<double> linkSums(const TileView& tile)
{
    return sumsAlong(tile, [&](u32 k) { return double(tile.linkFactors[k]); });
}

std::vector<double> absoluteLinkSums(const TileView& tile)
{
    if (tile.linkMoments.empty()) return sumsAlong(tile, [&](u32 k) { return std::abs(double(tile.linkFactors[k])); });
    const std::vector<SlopeBox> boxes = slopeBoxes(tile);
    return sumsAlong(tile, [&](u32 k) {
        const u32 sender = tile.linkColumns[k];
        const double factor = double(tile.linkFactors[k]);
        if (sender < tile.patches.size()) return std::abs(factor);
        const glm::dvec2 moment(tile.linkMoments[2 * k], tile.linkMoments[2 * k + 1]);
        if (factor + rangeOf(moment, boxes[sender]).x >= 0.0) return factor;
        return std::hypot(factor, std::hypot(moment.x, moment.y));
    });
}

Contraction contractionOf(const TileView& tile)
{
    Contraction result;
    const std::vector<double> sums = absoluteLinkSums(tile);
    for (u32 i = 0; i < sums.size(); ++i) {
        const glm::dvec4 rho(tile.patches[i].rho);
        result.number = glm::max(result.number, sums[i] * rho);
        const double brightest = std::max(std::max(rho.r, rho.g), std::max(rho.b, rho.a));
        if (brightest * sums[i] > result.largest()) {
            result.patch = i;
            result.reflectance = brightest;
            result.linkSum = sums[i];
        }
    }
    return result;
}

} // namespace helio
