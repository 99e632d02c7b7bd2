// SPDX-License-Identifier: Apache-2.0
#include "city/light/precise_contour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <numbers>

namespace helio {
namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;
constexpr Real kEpsilon = std::numeric_limits<Real>::epsilon();

struct Edge
{
    PreciseVec from, direction; ///< direction: unit
    Real length;
};

/// Edges in units of `scale`: ln r is then small and little cancels. Closed contours do not see the unit.
std::vector<Edge> edgesOf(const PrecisePolygon& polygon, Real scale)
{
    std::vector<Edge> edges;
    const size_t n = polygon.corners.size();
    for (size_t k = 0; k < n; ++k) {
        const PreciseVec a = polygon.corners[k], b = polygon.corners[(k + 1) % n];
        const Real length = glm::length(b - a);
        if (length > 0) edges.push_back({a / scale, (b - a) / length, length / scale});
    }
    return edges;
}

Real logSafe(Real x)
{
    return x > 0 ? std::log(x) : Real(0);
}

/// d atan(s / d), continuous at d = 0.
Real scaledAtan(Real s, Real d)
{
    return d > 0 ? d * std::atan2(s, d) : Real(0);
}

/// A sum that knows how much it may have lost by rounding.
struct Sum
{
    Real value = 0, magnitude = 0;
    void add(Real term, Real size)
    {
        value += term;
        magnitude += std::abs(size);
    }
};

/// First antiderivative in s of ln sqrt(s^2 + d^2).
Real logOnce(Real s, Real d)
{
    return s / 2 * logSafe(s * s + d * d) - s + scaledAtan(s, d);
}

/// Second antiderivative in s of ln sqrt(s^2 + d^2).
Real logTwice(Real s, Real d)
{
    const Real s2 = s * s, d2 = d * d;
    return (s2 - d2) / 4 * logSafe(s2 + d2) - 3 * s2 / 4 + s * scaledAtan(s, d);
}

/// Double integral of ln r along two parallel edges, times `cosine` = +-1.
void addParallel(const Edge& p, const Edge& q, Real cosine, Sum& sum)
{
    const PreciseVec r = q.from - p.from;
    const Real q0 = glm::dot(r, p.direction), q1 = q0 + (cosine > 0 ? q.length : -q.length);
    const Real d = glm::length(glm::cross(r, p.direction));
    const std::array<Real, 4> s{p.length - q0, -q0, p.length - q1, -q1};
    for (u32 k = 0; k < 4; ++k) {
        const Real term = logTwice(s[k], d);
        sum.add(k == 0 || k == 3 ? term : -term, term);
    }
}

/// Integral of ln r from a point along an edge.
void addAlong(const PreciseVec& point, const Edge& edge, Real weight, Sum& sum)
{
    const PreciseVec r = point - edge.from;
    const Real foot = glm::dot(r, edge.direction);
    const Real d = glm::length(glm::cross(r, edge.direction));
    const Real far = logOnce(edge.length - foot, d), near = logOnce(-foot, d);
    sum.add(weight * (far - near), weight * (std::abs(far) + std::abs(near)));
}

/// Points and weights of the tanh-sinh rule on [0, 1] that a halving of the step adds: `y` is the distance from the
/// nearer end, so that points crowd at an end without rounding.
struct Node
{
    Real y, weight;
    bool fromFarEnd;
};
constexpr u32 kFirstLevel = 2, kLastLevel = 7;

std::vector<Node> makeLevel(u32 level)
{
    std::vector<Node> nodes;
    const Real step = std::ldexp(Real(1), -int(level));
    const u32 stride = level == kFirstLevel ? 1 : 2;
    for (u32 k = level == kFirstLevel ? 0 : 1;; k += stride) {
        const Real u = Real(k) * step;
        const Real y = 1 / (1 + std::exp(kPi * std::sinh(u)));
        const Real weight = step * kPi * std::cosh(u) * y * (1 - y);
        if (y < 1e-24L) break;
        nodes.push_back({y, weight, false});
        if (k > 0) nodes.push_back({y, weight, true});
    }
    return nodes;
}

const std::vector<Node>& levelNodes(u32 level)
{
    static const std::array<std::vector<Node>, kLastLevel + 1> kLevels = [] {
        std::array<std::vector<Node>, kLastLevel + 1> levels;
        for (u32 l = kFirstLevel; l <= kLastLevel; ++l) levels[l] = makeLevel(l);
        return levels;
    }();
    return kLevels[level];
}

/// A stretch of an outer edge without a singular place inside, against an inner edge.
struct Stretch
{
    PreciseVec from, along; ///< along: to the other end
    Real length, cosine;
    const Edge* inner;
};

/// Cuts the shorter of two edges where it comes nearest to the other's line and ends: the integrand is analytic between
/// these places, and the tanh-sinh rule does not mind what happens at an end.
void addStretches(const Edge& p, const Edge& q, Real cosine, std::vector<Stretch>& out)
{
    const Edge &outer = p.length < q.length ? p : q, &inner = p.length < q.length ? q : p;
    const PreciseVec r = outer.from - inner.from;
    const PreciseVec normal = glm::cross(outer.direction, inner.direction);
    const Real sine2 = glm::dot(normal, normal);
    // A place beyond an end matters only when it is near, and the rule crowds at the end anyway.
    const auto within = [&](Real t) { return std::clamp(t, Real(0), outer.length); };
    std::array<Real, 5> cuts{0, within(glm::dot(glm::cross(inner.direction, r), normal) / sine2),
                             within(-glm::dot(r, outer.direction)),
                             within(-glm::dot(r - inner.length * inner.direction, outer.direction)), outer.length};
    std::sort(cuts.begin(), cuts.end());
    for (u32 k = 0; k + 1 < cuts.size(); ++k) {
        const Real length = cuts[k + 1] - cuts[k];
        if (length > 0)
            out.push_back({outer.from + cuts[k] * outer.direction, length * outer.direction, length, cosine, &inner});
    }
}

} // namespace

Estimate preciseContour(const PrecisePolygon& a, const PrecisePolygon& b, double tolerance)
{
    PreciseVec low = a.corners[0], high = low;
    for (const PrecisePolygon* polygon : {&a, &b}) {
        for (const PreciseVec& p : polygon->corners) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    }
    const Real scale = glm::distance(low, high);
    const std::vector<Edge> aEdges = edgesOf(a, scale), bEdges = edgesOf(b, scale);

    Sum closed;
    std::vector<Stretch> stretches;
    Estimate result;
    for (const Edge& p : aEdges) {
        for (const Edge& q : bEdges) {
            const Real cosine = glm::dot(p.direction, q.direction);
            if (cosine == 0) continue;
            if (glm::length(glm::cross(p.direction, q.direction)) < 4 * kEpsilon) {
                addParallel(p, q, cosine, closed);
                ++result.evaluations;
            } else {
                addStretches(p, q, cosine, stretches);
            }
        }
    }
    const Real factor = scale * scale / (2 * kPi);
    Sum outer;
    Real before = 0;
    for (u32 level = kFirstLevel; level <= kLastLevel; ++level) {
        // Halving the step keeps the old points at half their weight.
        outer.value /= 2;
        outer.magnitude /= 2;
        for (const Stretch& stretch : stretches) {
            for (const Node& node : levelNodes(level)) {
                const PreciseVec point = node.fromFarEnd ? stretch.from + stretch.along - node.y * stretch.along
                                                         : stretch.from + node.y * stretch.along;
                addAlong(point, *stretch.inner, stretch.cosine * stretch.length * node.weight, outer);
            }
            result.evaluations += levelNodes(level).size();
        }
        result.value = (closed.value + outer.value) * factor;
        const Real rounding = 8 * kEpsilon * (closed.magnitude + outer.magnitude) * factor;
        const Real difference = level > kFirstLevel ? std::abs(result.value - before) : std::abs(result.value);
        result.error = stretches.empty() ? rounding : difference + rounding;
        before = result.value;
        if (stretches.empty() || (level > kFirstLevel && result.error <= tolerance * std::abs(result.value)) ||
            (level > kFirstLevel && difference < rounding))
            break;
    }
    return result;
}

} // namespace helio
