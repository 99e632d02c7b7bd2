// SPDX-License-Identifier: Apache-2.0
#include "city/model/guillotine.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <vector>

#include "city/base/check.h"

namespace helio {
namespace {

constexpr double kStraddle = 1e-6;       // m: boxes may overlap a cut by this much
constexpr double kAxisPreference = 0.25; // imbalance that the longer side may have and still win

struct Cut
{
    u32 count = 0;          // boxes on the lower side
    double imbalance = 2.0; // |lower - upper| / total area; 2 = no cut
};

void sortAlong(std::span<PlaneBox> boxes, int axis)
{
    std::stable_sort(boxes.begin(), boxes.end(), [axis](const PlaneBox& a, const PlaneBox& b) {
        return a.lower[axis] + a.upper[axis] < b.lower[axis] + b.upper[axis];
    });
}

/// The most balanced cut across `axis` that no box straddles; boxes are sorted by their centres on it.
Cut cleanCut(std::span<const PlaneBox> boxes, int axis, double total)
{
    std::vector<double> lowestAfter(boxes.size() + 1, 1e300);
    for (size_t i = boxes.size(); i-- > 0;) lowestAfter[i] = std::min(lowestAfter[i + 1], boxes[i].lower[axis]);
    Cut best;
    double reach = -1e300, below = 0.0;
    for (size_t i = 0; i + 1 < boxes.size(); ++i) {
        reach = std::max(reach, boxes[i].upper[axis]);
        below += boxes[i].area;
        if (reach > lowestAfter[i + 1] + kStraddle) continue;
        const double imbalance = std::abs(2.0 * below - total) / total;
        if (imbalance < best.imbalance) best = {u32(i + 1), imbalance};
    }
    return best;
}

} // namespace

u32 guillotineCut(std::span<PlaneBox> boxes)
{
    HELIO_CHECK(boxes.size() >= 2, "boxes = ", boxes.size());
    glm::dvec2 lower(1e300), upper(-1e300);
    double total = 0.0;
    for (const PlaneBox& box : boxes) {
        lower = glm::min(lower, box.lower);
        upper = glm::max(upper, box.upper);
        total += box.area;
    }
    const int longer = upper.x - lower.x >= upper.y - lower.y ? 0 : 1;
    sortAlong(boxes, 1 - longer);
    const Cut across = cleanCut(boxes, 1 - longer, total);
    const std::vector<PlaneBox> byShorter(boxes.begin(), boxes.end());
    sortAlong(boxes, longer);
    const Cut along = cleanCut(boxes, longer, total);

    if (along.count > 0 && along.imbalance <= across.imbalance + kAxisPreference) return along.count;
    if (across.count > 0) {
        std::copy(byShorter.begin(), byShorter.end(), boxes.begin());
        return across.count;
    }
    double below = 0.0;
    for (u32 i = 0; i + 1 < boxes.size(); ++i) {
        below += boxes[i].area;
        if (2.0 * below >= total) return i + 1;
    }
    return u32(boxes.size()) - 1;
}

} // namespace helio
