// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/clip.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>

#include "city/grammar/cap.h"

namespace helio::cga {

namespace {

/// What is kept of a cut: the points with dot(normal, p) >= offset.
struct HalfSpace
{
    glm::dvec3 normal; ///< unit
    double offset;
    int axis = -1; ///< of the coordinate that is constant on the plane; -1: none

    static HalfSpace alongAxis(int axis, double at, double side)
    {
        glm::dvec3 normal(0.0);
        normal[axis] = side;
        return {normal, side * at, axis};
    }

    double exactDistance(const glm::dvec3& p) const { return glm::dot(normal, p) - offset; }
    /// Distance on the kept side, m; corners within kSnap are on the plane.
    double distance(const glm::dvec3& p) const
    {
        const double d = exactDistance(p);
        return std::abs(d) < kSnap ? 0.0 : d;
    }
    /// Puts a point that is close to the plane onto it, to the last bit where the plane lies along the axes.
    glm::dvec3 snapped(glm::dvec3 p) const
    {
        if (axis >= 0) p[axis] = normal[axis] * offset;
        return p;
    }
};

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

Geometry clipHalf(const Geometry& geometry, const HalfSpace& plane)
{
    Geometry result;
    result.closed = geometry.closed;
    for (const Face& face : geometry.faces)
        for (Polygon3& polygon : clipPolygon(plane, face.polygon)) {
            Face piece = face;
            piece.polygon = std::move(polygon);
            if (!face.edges.empty()) inheritEdges(face, piece);
            result.faces.push_back(std::move(piece));
        }
    if (!geometry.closed || result.faces.empty()) return result;
    const glm::dvec3 outward = -plane.normal, up(0, 1, 0);
    const glm::dvec3 level = glm::cross(up, outward);
    closeCut(
        result, [&](const glm::dvec3& p) { return plane.distance(p) == 0.0; }, outward,
        glm::length(level) > 1e-6 ? glm::normalize(level) : glm::dvec3(1, 0, 0));
    return result;
}

} // namespace

Geometry clipSlab(const Geometry& geometry, int axis, double low, double high)
{
    const auto [least, most] = bounds(geometry);
    if (least[axis] > high - kSnap && most[axis] > high + kSnap) return {};
    Geometry result = least[axis] < low - kSnap ? clipHalf(geometry, HalfSpace::alongAxis(axis, low, 1.0)) : geometry;
    return most[axis] > high + kSnap ? clipHalf(result, HalfSpace::alongAxis(axis, high, -1.0)) : result;
}

Geometry clipPlane(const Geometry& geometry, const glm::dvec3& normal, double offset)
{
    const HalfSpace plane{normal, offset};
    bool outside = false;
    for (const Face& face : geometry.faces)
        for (const glm::dvec3& p : face.polygon.outer) outside = outside || plane.distance(p) < 0.0;
    return outside ? clipHalf(geometry, plane) : geometry;
}

} // namespace helio::cga
