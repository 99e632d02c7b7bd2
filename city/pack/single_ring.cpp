// SPDX-License-Identifier: Apache-2.0
#include "city/pack/single_ring.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace helio {
namespace {

/// True if the open segments cross in one inner point.
bool crosses(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d)
{
    return cross(a, b, c) * cross(a, b, d) < 0.0 && cross(c, d, a) * cross(c, d, b) < 0.0;
}

struct Corner
{
    glm::dvec3 world;
    glm::dvec2 plane;
};
using Loop = std::vector<Corner>;

bool cutIsFree(const glm::dvec2& a, const glm::dvec2& b, std::span<const Loop> loops)
{
    for (const Loop& loop : loops)
        for (size_t i = 0; i < loop.size(); ++i)
            if (crosses(a, b, loop[i].plane, loop[(i + 1) % loop.size()].plane)) return false;
    return true;
}

/// Where to cut from the loop `to` to the first corner of a hanging ring: the nearest corner that sees it, else the
/// nearest.
size_t findCut(const glm::dvec2& from, const Loop& to, std::span<const Loop> loops)
{
    std::vector<size_t> order(to.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto distance = [&](size_t i) { return glm::dot(to[i].plane - from, to[i].plane - from); };
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return distance(a) < distance(b); });
    for (const size_t i : order)
        if (cutIsFree(from, to[i].plane, loops)) return i;
    return order[0];
}

} // namespace

Ring3 joinRings(std::span<const Ring3> rings, const glm::dvec3& normal)
{
    if (rings.size() == 1) return rings[0];
    const PlaneFrame frame = planeFrame(normal);
    const glm::dvec3 origin = rings[0][0];
    std::vector<Loop> loops;
    for (const Ring3& ring : rings) {
        Loop& loop = loops.emplace_back();
        for (const glm::dvec3& q : ring)
            loop.push_back({q, {glm::dot(q - origin, frame.u), glm::dot(q - origin, frame.v)}});
    }
    // From right to left, each by its rightmost corner: nothing that still hangs lies between it and the joined loop.
    const auto byX = [](const Corner& a, const Corner& b) { return a.plane.x < b.plane.x; };
    for (Loop& loop : loops) std::rotate(loop.begin(), std::max_element(loop.begin(), loop.end(), byX), loop.end());
    std::stable_sort(loops.begin() + 1, loops.end(), [&](const Loop& a, const Loop& b) { return byX(b[0], a[0]); });
    while (loops.size() > 1) {
        const size_t cut = findCut(loops[1][0].plane, loops[0], loops);
        Loop joined(loops[0].begin(), loops[0].begin() + std::ptrdiff_t(cut) + 1);
        joined.insert(joined.end(), loops[1].begin(), loops[1].end());
        joined.push_back(loops[1][0]);
        joined.insert(joined.end(), loops[0].begin() + std::ptrdiff_t(cut), loops[0].end());
        loops[0] = std::move(joined);
        loops.erase(loops.begin() + 1);
    }
    Ring3 out;
    for (const Corner& corner : loops[0]) out.push_back(corner.world);
    return out;
}

} // namespace helio
