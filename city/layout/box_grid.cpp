// SPDX-License-Identifier: Apache-2.0
#include "city/layout/box_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "city/base/check.h"

namespace helio {

namespace {

u64 keyOf(i64 x, i64 y)
{
    return (u64(u32(i32(x))) << 32) | u32(i32(y));
}

} // namespace

Box2 boxOf(std::span<const glm::dvec2> points)
{
    HELIO_CHECK(!points.empty());
    Box2 box{points[0], points[0]};
    for (const glm::dvec2& point : points) box = {glm::min(box.low, point), glm::max(box.high, point)};
    return box;
}

Box2 boxOf(const glm::dvec2& a, const glm::dvec2& b)
{
    return {glm::min(a, b), glm::max(a, b)};
}

glm::dvec2 nearestOnSegment(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& point)
{
    const glm::dvec2 along = b - a;
    const double squared = glm::dot(along, along);
    return squared > 0.0 ? a + std::clamp(glm::dot(point - a, along) / squared, 0.0, 1.0) * along : a;
}

BoxGrid::CellRange BoxGrid::cellsOf(const Box2& box) const
{
    const auto cell = [&](double value) { return i64(std::floor(value / cellSize_)); };
    return {cell(box.low.x), cell(box.high.x), cell(box.low.y), cell(box.high.y)};
}

void BoxGrid::insert(const Box2& box, u32 item)
{
    const u32 entry = u32(entries_.size());
    entries_.push_back({box, item});
    const CellRange range = cellsOf(box);
    if (range.isLarge()) {
        large_.push_back(entry);
        return;
    }
    for (i64 y = range.y0; y <= range.y1; ++y)
        for (i64 x = range.x0; x <= range.x1; ++x) cells_[keyOf(x, y)].push_back(entry);
}

std::vector<u32> BoxGrid::touching(const Box2& box) const
{
    std::vector<u32> found;
    const auto collect = [&](u32 entry) {
        if (entries_[entry].box.touches(box)) found.push_back(entries_[entry].item);
    };
    const CellRange range = cellsOf(box);
    if (range.isLarge()) {
        for (u32 entry = 0; entry < entries_.size(); ++entry) collect(entry);
    } else {
        for (const u32 entry : large_) collect(entry);
        for (i64 y = range.y0; y <= range.y1; ++y) {
            for (i64 x = range.x0; x <= range.x1; ++x) {
                const auto cell = cells_.find(keyOf(x, y));
                if (cell != cells_.end()) std::for_each(cell->second.begin(), cell->second.end(), collect);
            }
        }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

} // namespace helio
