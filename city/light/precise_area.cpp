// SPDX-License-Identifier: Apache-2.0
#include "city/light/precise_area.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace helio {
namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;
constexpr Real kEpsilon = std::numeric_limits<Real>::epsilon();
constexpr std::array<u32, 4> kOrders{4, 8, 16, 32};

struct GaussPoint
{
    Real x, weight;
};

/// Gauss-Legendre points on [0, 1]: Newton's method on the Legendre polynomial.
std::vector<GaussPoint> gaussPoints(u32 order)
{
    std::vector<GaussPoint> points;
    for (u32 k = 0; k < order; ++k) {
        Real z = std::cos(kPi * (Real(k) + 0.75L) / (Real(order) + 0.5L)), slope = 0;
        for (u32 round = 0; round < 8; ++round) {
            Real previous = 1, value = z;
            for (u32 n = 2; n <= order; ++n) {
                const Real next = (Real(2 * n - 1) * z * value - Real(n - 1) * previous) / Real(n);
                previous = value;
                value = next;
            }
            slope = Real(order) * (z * value - previous) / (z * z - 1);
            z -= value / slope;
        }
        points.push_back({(1 - z) / 2, 1 / ((1 - z * z) * slope * slope)});
    }
    return points;
}

const std::vector<GaussPoint>& pointsOf(u32 index)
{
    static const std::array<std::vector<GaussPoint>, kOrders.size()> kRules = [] {
        std::array<std::vector<GaussPoint>, kOrders.size()> rules;
        for (u32 k = 0; k < kOrders.size(); ++k) rules[k] = gaussPoints(kOrders[k]);
        return rules;
    }();
    return kRules[index];
}

/// 2 pi times the factor from an element to a polygon above its horizon; adds the size of its terms to `magnitude`.
Real pointTerm(const PreciseVec& point, const PreciseVec& normal, const PrecisePolygon& polygon, Real& magnitude)
{
    Real sum = 0;
    magnitude = 0;
    PreciseVec a = polygon.corners.back() - point;
    for (const PreciseVec& corner : polygon.corners) {
        const PreciseVec b = corner - point;
        const PreciseVec c = glm::cross(b, a);
        const Real sine = glm::length(c);
        if (sine > 0) {
            const Real term = glm::dot(normal, c) * (std::atan2(sine, glm::dot(a, b)) / sine);
            sum += term;
            // The products inside the cross product cancel too: what they lose grows with the distance.
            magnitude +=
                std::abs(term) + glm::length(a) * glm::length(b) * std::atan2(sine, glm::dot(a, b)) / sine * kEpsilon;
        }
        a = b;
    }
    return sum;
}

} // namespace

Estimate preciseArea(const PrecisePolygon& small, const PrecisePolygon& large, double tolerance)
{
    Estimate result;
    Real before = 0;
    const std::vector<PreciseVec>& p = small.corners;
    for (u32 index = 0; index < kOrders.size(); ++index) {
        const std::vector<GaussPoint>& rule = pointsOf(index);
        Real sum = 0, magnitude = 0;
        // A fan of signed triangles: concave corners need no cutting, for the factor is smooth all over the hull.
        for (size_t k = 1; k + 1 < p.size(); ++k) {
            const PreciseVec du = p[k] - p[0], dv = p[k + 1] - p[k];
            const Real twice = glm::dot(small.normal, glm::cross(du, dv));
            for (const GaussPoint& u : rule) {
                for (const GaussPoint& v : rule) {
                    Real terms = 0;
                    const Real weight = u.weight * v.weight * u.x * twice;
                    sum += weight * pointTerm(p[0] + u.x * (du + v.x * dv), small.normal, large, terms);
                    magnitude += std::abs(weight) * terms;
                }
            }
            result.evaluations += rule.size() * rule.size();
        }
        result.value = sum / (2 * kPi);
        const Real rounding = 8 * kEpsilon * magnitude / (2 * kPi);
        const Real difference = std::abs(result.value - before);
        result.error = difference + rounding;
        before = result.value;
        if (index > 0 && (result.error <= tolerance * std::abs(result.value) || difference < rounding)) break;
    }
    return result;
}

} // namespace helio
