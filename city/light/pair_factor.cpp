// SPDX-License-Identifier: Apache-2.0
#include "city/light/pair_factor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "city/light/pair_visibility.h"
#include "city/light/precise_area.h"
#include "city/light/precise_contour.h"

namespace helio {
namespace {

/// Largest coordinate of a ring: it bounds what rounding to double has done to the corners.
double largestCoordinate(const Ring3& ring)
{
    double largest = 0.0;
    for (const glm::dvec3& p : ring) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return largest;
}

bool isGood(const Estimate& estimate, double tolerance)
{
    return estimate.error <= tolerance * std::abs(estimate.value);
}

Estimate exchangeOf(const PrecisePolygon& small, const PrecisePolygon& large, double tolerance, bool mayDivide);

/// The same with the large polygon cut by a square around what is near the small one: in one piece the terms of far
/// edges are so large that rounding would swallow the small exchange.
Estimate exchangeOfParts(const PrecisePolygon& small, const PrecisePolygon& large, double tolerance)
{
    const PreciseVec n = large.normal;
    const PreciseVec axis = std::abs(n.x) < 0.6L ? PreciseVec(1, 0, 0) : PreciseVec(0, 1, 0);
    const PreciseVec u = glm::normalize(glm::cross(n, axis)), v = glm::cross(n, u);
    PrecisePolygon rest = large;
    Estimate sum;
    for (const PreciseVec& direction : {u, -u, v, -v}) {
        if (rest.corners.empty()) break;
        const Real border = glm::dot(direction, small.centroid) + 8 * small.radius;
        const PrecisePolygon part = keepAbove(rest, direction, border, 0);
        if (!part.corners.empty()) sum += exchangeOf(small, part, tolerance, false);
        rest = keepAbove(rest, -direction, -border, 0);
    }
    if (!rest.corners.empty()) sum += exchangeOf(small, rest, tolerance, false);
    return sum;
}

/// A_s F_sl, m2, by the cheapest way that reaches the relative tolerance, else by the best one.
Estimate exchangeOf(const PrecisePolygon& small, const PrecisePolygon& large, double tolerance, bool mayDivide)
{
    Estimate best;
    best.error = std::numeric_limits<Real>::infinity();
    u64 spent = 0;
    const auto tryOne = [&](const Estimate& next) {
        spent += next.evaluations;
        if (next.error < best.error) best = next;
        return isGood(best, tolerance);
    };
    const bool found =
        (boxDistance(small, large) > 0.7L * small.radius && tryOne(preciseArea(small, large, tolerance))) ||
        tryOne(preciseContour(small, large, tolerance)) ||
        (mayDivide && large.radius > 24 * small.radius && tryOne(exchangeOfParts(small, large, tolerance)));
    // Rounding is the last thing that can go wrong; points over the smaller one suffer least from it.
    if (!found) tryOne(preciseArea(small, large, tolerance));
    best.evaluations = spent;
    return best;
}

} // namespace

PairFactor pairFactor(const Ring3& a, const Ring3& b, std::span<const Ring3> occluders, const PairAccuracy& accuracy)
{
    PairFactor result;
    if (a.size() < 3 || b.size() < 3) return result;
    const PrecisePolygon wholeA = precisePolygon(a, a[0]), wholeB = precisePolygon(b, b[0]);
    if (!(wholeA.area > 0) || !(wholeB.area > 0)) return result;

    // The smaller one goes first and gives the origin whatever the order of the arguments: symmetric to the last bit.
    const auto less = [](const glm::dvec3& p, const glm::dvec3& q) {
        return std::lexicographical_compare(&p.x, &p.x + 3, &q.x, &q.x + 3);
    };
    const bool swapped =
        wholeB.area < wholeA.area ||
        (wholeB.area == wholeA.area && std::lexicographical_compare(b.begin(), b.end(), a.begin(), a.end(), less));
    const Ring3 &smallRing = swapped ? b : a, &largeRing = swapped ? a : b;
    const glm::dvec3 origin = smallRing[0];
    PrecisePolygon small = precisePolygon(smallRing, origin), large = precisePolygon(largeRing, origin);

    // Corners that should lie in the other's plane miss it by the rounding of the coordinates.
    const Real reach = small.radius + large.radius + glm::distance(small.centroid, large.centroid);
    const Real tolerance = 1e-14L * reach + 2 * std::numeric_limits<double>::epsilon() *
                                                std::max(largestCoordinate(a), largestCoordinate(b));
    const Real smallArea = small.area, largeArea = large.area;
    const PreciseVec smallPlane = small.corners[0], largePlane = large.corners[0];
    small = keepAbove(small, large.normal, glm::dot(large.normal, largePlane), tolerance);
    large = keepAbove(large, small.normal, glm::dot(small.normal, smallPlane), tolerance);
    if (small.corners.empty() || large.corners.empty()) return result;

    // What is left of the smaller one may be the wider one: points go over the other.
    const bool wider = small.radius > large.radius;
    const Estimate exchange = exchangeOf(wider ? large : small, wider ? small : large, accuracy.factor, true);
    const Real value = std::clamp(exchange.value, Real(0), std::min(smallArea, largeArea));
    result.evaluations = exchange.evaluations;
    if (!(value > 0)) return result;
    result.ab = double(value / (swapped ? largeArea : smallArea));
    result.ba = double(value / (swapped ? smallArea : largeArea));
    result.error = double(exchange.error / value) + std::numeric_limits<double>::epsilon();
    if (occluders.empty()) return result;

    const OccludedExchange seen =
        occludedExchange({smallRing, largeRing, occluders, double(tolerance)}, double(value), accuracy);
    result.visibility = seen.visibility;
    result.error += seen.error;
    result.evaluations += seen.points;
    return result;
}

} // namespace helio
