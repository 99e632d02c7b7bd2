// SPDX-License-Identifier: Apache-2.0
#include "city/layout/city_rows.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace helio {

namespace {

constexpr double kHouseWidth = 6.0, kPassage = 2.5, kSideGarden = 2.5; // m
constexpr u32 kLongestRow = 8;

double roundedTo(double value, double step)
{
    return std::round(value / step) * step;
}

// Part of the line at + t along on which a row of this depth keeps its distance from the block's other sides.
struct Extent
{
    double begin, end;
};

Extent freeExtent(const CityBlock& block, size_t edge, const glm::dvec2& at, const glm::dvec2& along, double depth)
{
    const size_t n = block.outline.size();
    const glm::dvec2 inward(-along.y, along.x);
    Extent extent{0.0, glm::distance(block.outline[edge], block.outline[(edge + 1) % n])};
    for (size_t i = 0; i < n; ++i) {
        if (block.side[i] == block.side[edge]) continue;
        const glm::dvec2 a = block.outline[i], normal = leftNormal(a, block.outline[(i + 1) % n]);
        const double slope = glm::dot(normal, along);
        if (std::abs(slope) < 0.3) continue; // the opposite side
        for (const double behind : {0.0, depth}) {
            const double t = (kSideGarden - glm::dot(normal, at + behind * inward - a)) / slope;
            if (slope > 0.0)
                extent.begin = std::max(extent.begin, t);
            else
                extent.end = std::min(extent.end, t);
        }
    }
    return extent;
}

void addRow(Random& random, std::vector<RowHouseLot>& lots, const glm::dvec2& start, const glm::dvec2& along, u32 count,
            double depth)
{
    const glm::dvec2 inward(-along.y, along.x);
    const u32 usual = chance(random, 0.3) ? 3 : 2;
    const auto front = [&](u32 k) { return onMillimetre(start + kHouseWidth * k * along); };
    const auto back = [&](u32 k) { return onMillimetre(start + kHouseWidth * k * along + depth * inward); };
    for (u32 k = 0; k < count; ++k) {
        // The ends of a row like to stand out.
        const bool isEnd = k == 0 || k + 1 == count;
        const u32 storeys = chance(random, isEnd ? 0.3 : 0.12) ? 5 - usual : usual;
        lots.push_back({{{front(k), front(k + 1), back(k + 1), back(k)}, {}}, storeys});
    }
}

} // namespace

std::vector<RowHouseLot> divideIntoRows(Random& random, const CityBlock& block)
{
    std::vector<RowHouseLot> lots;
    for (size_t edge = 0; edge < block.outline.size(); ++edge) {
        if (block.side[edge] != 0 && block.side[edge] != 2) continue;
        const glm::dvec2 a = block.outline[edge], b = block.outline[(edge + 1) % block.outline.size()];
        const glm::dvec2 along = glm::normalize(b - a), inward(-along.y, along.x);
        const double garden = roundedTo(range(random, 3.0, 3.8), 0.5);
        const Extent extent = freeExtent(block, edge, a + garden * inward, along, 10.5);
        const double length = extent.end - extent.begin;
        u32 rows = 1;
        while ((length - (rows - 1) * kPassage) / kHouseWidth >= rows * kLongestRow + 1) ++rows;
        const u32 houses = u32(std::max(0.0, (length - (rows - 1) * kPassage) / kHouseWidth));
        const double used = houses * kHouseWidth + (rows - 1) * kPassage;
        double at = extent.begin + 0.5 * (length - used);
        for (u32 row = 0; row < rows; ++row) {
            const u32 count = houses / rows + (row < houses % rows ? 1 : 0);
            const double step = 0.5 * below(random, 2), depth = 9.0 + 0.5 * below(random, 3);
            addRow(random, lots, a + at * along + (garden + step) * inward, along, count, depth);
            at += count * kHouseWidth + kPassage;
        }
    }
    return lots;
}

} // namespace helio
