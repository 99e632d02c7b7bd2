// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "city/base/types.h"

namespace helio {

/// An axis-parallel box, m.
struct Box2
{
    glm::dvec2 low, high;
    bool touches(const Box2& other) const
    {
        return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y && other.low.y <= high.y;
    }
    Box2 grown(double by) const { return {low - by, high + by}; }
};

/// The box around points; at least one.
Box2 boxOf(std::span<const glm::dvec2> points);

/// The box of a segment.
Box2 boxOf(const glm::dvec2& a, const glm::dvec2& b);
/// The point of the segment a-b that is nearest to `point`.
glm::dvec2 nearestOnSegment(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& point);

/// Finds the boxes near a box: items are kept by the square cells that they touch.
class BoxGrid
{
public:
    /// Cells of `cellSize` metres, about the size of an item.
    explicit BoxGrid(double cellSize) : cellSize_(cellSize) {}
    void insert(const Box2& box, u32 item);
    /// Every item whose box touches `box`, ascending and each once.
    std::vector<u32> touching(const Box2& box) const;

private:
    struct CellRange
    {
        i64 x0, x1, y0, y1;
        bool isLarge() const { return double(x1 - x0 + 1) * double(y1 - y0 + 1) > 4096.0; }
    };
    struct Entry
    {
        Box2 box;
        u32 item;
    };
    CellRange cellsOf(const Box2& box) const;

    double cellSize_;
    std::vector<Entry> entries_;
    std::unordered_map<u64, std::vector<u32>> cells_;
    std::vector<u32> large_; ///< entries over too many cells: compared with every query
};

} // namespace helio
