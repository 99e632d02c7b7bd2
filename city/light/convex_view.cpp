// SPDX-License-Identifier: Apache-2.0
#include "city/light/convex_view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace helio {

Convex clipConvex(const Convex& polygon, const HalfSpace& half, double tolerance)
{
    const auto heightOf = [&](const glm::dvec3& p) {
        const double h = glm::dot(half.normal, p) - half.offset;
        return std::abs(h) <= tolerance ? 0.0 : h;
    };
    Convex kept;
    bool above = false;
    glm::dvec3 a = polygon.back();
    double ha = heightOf(a);
    for (const glm::dvec3& b : polygon) {
        const double hb = heightOf(b);
        if (ha * hb < 0.0) kept.push_back(a + ha / (ha - hb) * (b - a));
        if (hb >= 0.0) kept.push_back(b);
        above = above || hb > 0.0;
        a = b;
        ha = hb;
    }
    if (!above || kept.size() < 3) kept.clear();
    return kept;
}

double convexFactor(const glm::dvec3& point, const glm::dvec3& normal, const Convex& polygon)
{
    double sum = 0.0;
    glm::dvec3 a = polygon.back() - point;
    for (const glm::dvec3& corner : polygon) {
        const glm::dvec3 b = corner - point;
        const glm::dvec3 c = glm::cross(b, a);
        const double sine = glm::length(c);
        if (sine > 0.0) sum += glm::dot(normal, c) * (std::atan2(sine, glm::dot(a, b)) / sine);
        a = b;
    }
    return std::min(std::abs(sum) / (2.0 * std::numbers::pi), 1.0);
}

void hideBehind(const glm::dvec3& point, const Convex& occluder, std::vector<Convex>& visible,
                std::vector<Convex>& hidden)
{
    // The pyramid from the point through the occluder's edges, its planes facing inwards.
    glm::dvec3 middle(0.0);
    for (const glm::dvec3& corner : occluder) middle += corner - point;
    std::vector<HalfSpace> sides;
    sides.reserve(occluder.size());
    double inwards = 0.0;
    for (size_t k = 0; k < occluder.size(); ++k) {
        const glm::dvec3 p = occluder[k] - point, q = occluder[k + 1 < occluder.size() ? k + 1 : 0] - point;
        const glm::dvec3 n = glm::cross(p, q);
        const double length = glm::length(n);
        if (length <= 1e-14 * glm::length(p) * glm::length(q)) continue; // in line with the point: no side
        sides.push_back({n / length, 0.0});
        inwards += glm::dot(n, middle) / length;
    }
    const double size = glm::length(middle);
    if (sides.size() < 3 || std::abs(inwards) <= 1e-13 * size) return;
    for (HalfSpace& side : sides) {
        if (inwards < 0.0) side.normal = -side.normal;
        side.offset = glm::dot(side.normal, point);
    }

    std::vector<Convex> next, outside;
    for (Convex& piece : visible) {
        Convex rest = piece;
        outside.clear();
        for (const HalfSpace& side : sides) {
            Convex beyond = clipConvex(rest, {-side.normal, -side.offset}, 0.0);
            if (!beyond.empty()) outside.push_back(std::move(beyond));
            rest = clipConvex(rest, side, 0.0);
            if (rest.empty()) break;
        }
        if (rest.empty()) { // not met: it stays in one piece
            next.push_back(std::move(piece));
            continue;
        }
        hidden.push_back(std::move(rest));
        for (Convex& part : outside) next.push_back(std::move(part));
    }
    visible = std::move(next);
}

} // namespace helio
