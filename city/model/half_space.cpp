// SPDX-License-Identifier: Apache-2.0
#include "city/model/half_space.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>

namespace helio {
namespace {

constexpr double kMinArea = 1e-10; ///< m2: smaller loops are rounding

/// A run of a ring on the kept side: from where it enters across the plane to where it leaves.
using Chain = Ring3;

/// The point where an edge crosses the plane. The edge is taken in one fixed order, so that both sides of a cut, and
/// both faces at an edge of a solid, get the same bits.
glm::dvec3 crossing(const HalfSpace& plane, glm::dvec3 a, glm::dvec3 b)
{
    if (plane.distance(a) == 0.0) std::swap(a, b);
    if (plane.distance(b) == 0.0) return plane.snapped(b);
    if (std::tie(a.x, a.y, a.z) > std::tie(b.x, b.y, b.z)) std::swap(a, b);
    const double from = plane.exactDistance(a), to = plane.exactDistance(b);
    return plane.snapped(a + (b - a) * (from / (from - to)));
}

void appendChains(const HalfSpace& plane, const Ring3& ring, const std::vector<double>& distances,
                  std::vector<Chain>& chains)
{
    const size_t n = ring.size();
    for (size_t first = 0; first < n; ++first) {
        const size_t before = (first + n - 1) % n;
        if (distances[first] <= 0.0 || distances[before] > 0.0) continue;
        Chain chain{crossing(plane, ring[before], ring[first])};
        size_t k = first;
        for (; distances[k] > 0.0; k = (k + 1) % n) chain.push_back(ring[k]);
        chain.push_back(crossing(plane, ring[(k + n - 1) % n], ring[k]));
        chains.push_back(std::move(chain));
    }
}

} // namespace

double HalfSpace::exactDistance(const glm::dvec3& p) const
{
    return glm::dot(normal, p) - offset;
}

double HalfSpace::distance(const glm::dvec3& p) const
{
    const double d = exactDistance(p);
    return std::abs(d) < kSnap ? 0.0 : d;
}

std::vector<Polygon3> clipPolygon(const HalfSpace& plane, const Polygon3& polygon)
{
    std::vector<Ring3> loops;
    std::vector<Chain> chains;
    std::vector<double> distances;
    const auto addRing = [&](const Ring3& ring) {
        distances.clear();
        for (const glm::dvec3& p : ring) distances.push_back(plane.distance(p));
        const auto kept = std::count_if(distances.begin(), distances.end(), [](double d) { return d > 0.0; });
        if (size_t(kept) == ring.size())
            loops.push_back(ring);
        else if (kept > 0)
            appendChains(plane, ring, distances, chains);
    };
    addRing(polygon.outer);
    for (const Ring3& hole : polygon.holes) addRing(hole);
    if (chains.empty() && loops.empty()) return {};
    if (chains.empty() && loops.size() == 1 + polygon.holes.size()) return {polygon};

    // Walking on from a chain's end, the cut runs along `along` (kept part to the left) to the next chain's start. Ends
    // and starts alternate on it, so that the k-th end joins the k-th start, whatever their order at equal places.
    const glm::dvec3 normal = unitNormal(polygon), along = glm::cross(plane.normal, normal);
    std::vector<size_t> byEnd(chains.size()), byStart(chains.size()), nextOf(chains.size());
    std::iota(byEnd.begin(), byEnd.end(), size_t(0));
    byStart = byEnd;
    std::sort(byEnd.begin(), byEnd.end(), [&](size_t a, size_t b) {
        return std::pair(glm::dot(chains[a].back(), along), a) < std::pair(glm::dot(chains[b].back(), along), b);
    });
    std::sort(byStart.begin(), byStart.end(), [&](size_t a, size_t b) {
        return std::pair(glm::dot(chains[a].front(), along), a) < std::pair(glm::dot(chains[b].front(), along), b);
    });
    for (size_t k = 0; k < chains.size(); ++k) nextOf[byEnd[k]] = byStart[k];
    std::vector<bool> used(chains.size(), false);
    for (size_t first = 0; first < chains.size(); ++first) {
        Ring3 loop;
        for (size_t k = first; !used[k]; k = nextOf[k]) {
            used[k] = true;
            loop.insert(loop.end(), chains[k].begin(), chains[k].end());
        }
        loop = withoutRepeats(loop);
        if (loop.size() >= 3) loops.push_back(std::move(loop));
    }
    return assembleLoops(std::move(loops), normal);
}

Ring3 withoutRepeats(const Ring3& ring)
{
    Ring3 result;
    for (const glm::dvec3& p : ring)
        if (result.empty() || glm::distance(result.back(), p) > 1e-9) result.push_back(p);
    while (result.size() > 1 && glm::distance(result.front(), result.back()) <= 1e-9) result.pop_back();
    return result;
}

std::vector<Polygon3> assembleLoops(std::vector<Ring3> loops, const glm::dvec3& normal)
{
    std::vector<Polygon3> polygons;
    std::vector<Ring3> holes;
    for (Ring3& loop : loops) {
        const double signedArea = glm::dot(vectorArea(loop), normal);
        if (std::abs(signedArea) < kMinArea) continue;
        if (signedArea < 0.0)
            holes.push_back(std::move(loop));
        else
            polygons.push_back({std::move(loop), {}});
    }
    for (Ring3& hole : holes)
        for (Polygon3& polygon : polygons) {
            // A corner of the hole may touch the outline, so the majority of its corners decides.
            const auto inside = std::count_if(hole.begin(), hole.end(), [&](const glm::dvec3& p) {
                return isInside(p, {&polygon.outer, 1}, normal);
            });
            if (polygons.size() > 1 && size_t(inside) * 2 <= hole.size()) continue;
            polygon.holes.push_back(std::move(hole));
            break;
        }
    return polygons;
}

} // namespace helio
