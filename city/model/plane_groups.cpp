// SPDX-License-Identifier: Apache-2.0
#include "city/model/plane_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>

namespace helio {
namespace {

constexpr double kSameNormal = 1e-5;   // 1 - cos of the largest angle between coplanar normals (0.26 deg)
constexpr double kSamePlane = 2e-3;    // m: largest distance between coplanar planes
constexpr double kNormalCell = 4.5e-3; // at least sqrt(2 kSameNormal), the distance of two such unit normals

using Cell = std::array<int, 3>;

/// An item by the cell of its normal and its plane's distance from the origin.
struct Entry
{
    Cell cell;
    double offset;
    u32 item;
};

Cell cellOf(const glm::dvec3& normal)
{
    return {int(std::floor(normal.x / kNormalCell)), int(std::floor(normal.y / kNormalCell)),
            int(std::floor(normal.z / kNormalCell))};
}

/// True if an item that is not alone lies in the plane of another.
bool liesIn(const PlaneItem& item, const PlaneItem& plane)
{
    if (&item == &plane) return true;
    return !item.alone && !plane.alone && item.kind == plane.kind &&
           glm::dot(plane.normal, item.normal) > 1.0 - kSameNormal &&
           std::abs(glm::dot(plane.normal, item.point - plane.point)) < kSamePlane;
}

/// The items that still wait for a group, sorted for a quick look around a plane.
class PlaneIndex
{
public:
    explicit PlaneIndex(std::span<const PlaneItem> items) : items_(items), taken_(items.size(), 0)
    {
        double farthest = 0.0;
        for (u32 i = 0; i < items.size(); ++i) {
            if (items[i].alone) continue;
            if (entries_.empty()) origin_ = items[i].point;
            const glm::dvec3 arm = items[i].point - origin_;
            farthest = std::max(farthest, glm::length(arm));
            entries_.push_back({cellOf(items[i].normal), glm::dot(items[i].normal, arm), i});
        }
        // Distances are compared along the first item's normal, the index has them along each item's own.
        reach_ = kSamePlane + kNormalCell * farthest;
        std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
            return std::tie(a.cell, a.offset, a.item) < std::tie(b.cell, b.offset, b.item);
        });
    }

    bool isTaken(u32 item) const { return taken_[item] != 0; }

    /// The item and all that wait in its plane.
    std::vector<u32> take(u32 first)
    {
        std::vector<u32> group;
        const PlaneItem& plane = items_[first];
        const double offset = glm::dot(plane.normal, plane.point - origin_);
        const Cell middle = cellOf(plane.normal);
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z)
                    takeFrom({middle[0] + x, middle[1] + y, middle[2] + z}, plane, offset, group);
        std::sort(group.begin(), group.end());
        return group;
    }

private:
    void takeFrom(const Cell& cell, const PlaneItem& plane, double offset, std::vector<u32>& group)
    {
        const auto begin =
            std::lower_bound(entries_.begin(), entries_.end(), offset - reach_, [&](const Entry& e, double low) {
                return std::tie(e.cell, e.offset) < std::tie(cell, low);
            });
        for (auto entry = begin; entry != entries_.end() && entry->cell == cell; ++entry) {
            if (entry->offset > offset + reach_) break;
            const PlaneItem& other = items_[entry->item];
            if (taken_[entry->item] != 0 || !liesIn(other, plane)) continue;
            taken_[entry->item] = 1;
            group.push_back(entry->item);
        }
    }

    std::span<const PlaneItem> items_;
    std::vector<char> taken_;
    std::vector<Entry> entries_;
    glm::dvec3 origin_{0.0};
    double reach_ = 0.0;
};

} // namespace

std::vector<std::vector<u32>> groupByPlane(std::span<const PlaneItem> items)
{
    std::vector<std::vector<u32>> groups;
    // Nearly all sets lie in one plane: no index for those.
    if (std::all_of(items.begin(), items.end(), [&](const PlaneItem& item) { return liesIn(item, items[0]); })) {
        if (items.empty()) return groups;
        groups.emplace_back(items.size());
        std::iota(groups[0].begin(), groups[0].end(), 0u);
        return groups;
    }
    PlaneIndex index(items);
    for (u32 i = 0; i < items.size(); ++i) {
        if (items[i].alone)
            groups.push_back({i});
        else if (!index.isTaken(i))
            groups.push_back(index.take(i));
    }
    return groups;
}

} // namespace helio
