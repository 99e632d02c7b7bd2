// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/street_sides.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace helio::cga {

std::optional<StreetSides> streetSides(const Footprint& footprint)
{
    const Ring2& ring = footprint.outline.outer;
    StreetSides sides;
    sides.onStreet = footprint.onStreet;
    sides.onStreet.resize(ring.size(), false);
    glm::dvec3 sum(0.0);
    for (size_t k = 0; k < ring.size(); ++k) {
        const glm::dvec2 by = ring[(k + 1) % ring.size()] - ring[k];
        if (!sides.onStreet[k] || glm::length(by) < 1e-6) continue;
        // Outward of a counter-clockwise ring is to its right: (y, -x), and north is -z.
        const glm::dvec3 outward(by.y, 0.0, by.x);
        sum += outward;
        sides.normals.push_back(glm::normalize(outward));
    }
    if (sides.normals.empty()) return {};
    // Streets all around have no mean: then the first one is the front.
    sides.front = glm::length(sum) > 1e-3 ? glm::normalize(sum) : sides.normals[0];
    return sides;
}

bool selectsStreet(Selector selector, const StreetSides& sides, const glm::dvec3& normal, u32 edge)
{
    constexpr double kHalf = M_SQRT1_2, kTie = 1e-9;
    if (std::abs(normal.y) > std::sin(78.75 * M_PI / 180.0)) return false;
    const glm::dvec3 level = glm::normalize(glm::dvec3(normal.x, 0.0, normal.z));
    bool front = false;
    if (edge != kNoIndex)
        front = edge < sides.onStreet.size() && sides.onStreet[edge];
    else
        front = std::any_of(sides.normals.begin(), sides.normals.end(), [&](const glm::dvec3& street) {
            return glm::dot(street, level) > std::cos(30.0 * M_PI / 180.0);
        });
    const bool back = !front && std::any_of(sides.normals.begin(), sides.normals.end(), [&](const glm::dvec3& street) {
        return glm::dot(street, level) <= -kHalf + kTie;
    });
    // Seen from the street, looking at the building, right is where x of a scope with z = front points.
    const glm::dvec3 rightward = glm::cross(glm::dvec3(0, 1, 0), sides.front);
    const bool right = !front && !back && glm::dot(level, rightward) > 0.0;
    switch (selector) {
    case Selector::StreetFront:
        return front;
    case Selector::StreetBack:
        return back;
    case Selector::StreetRight:
        return right;
    case Selector::StreetLeft:
        return !front && !back && !right;
    case Selector::StreetSide:
        return !front && !back;
    default:
        return false;
    }
}

} // namespace helio::cga
