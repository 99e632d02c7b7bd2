// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <map>

#include "city/grammar/geometry.h"

namespace helio::cga {

/// A face in the plane y = 0 that looks up; the ring is given as x, -z, counter-clockwise from above.
inline Geometry flatShape(const std::vector<glm::dvec2>& outer, const std::vector<std::vector<glm::dvec2>>& holes = {})
{
    Geometry geometry;
    Face& face = geometry.faces.emplace_back();
    for (const glm::dvec2& p : outer) face.polygon.outer.emplace_back(p.x, 0, -p.y);
    for (const auto& hole : holes) {
        Ring3& ring = face.polygon.holes.emplace_back();
        for (const glm::dvec2& p : hole) ring.emplace_back(p.x, 0, -p.y);
    }
    return geometry;
}

/// Directed edges that do not have exactly one opposite, with corners compared on a grid of 1e-5 m: none for a closed
/// solid.
inline size_t openEdges(const Geometry& geometry)
{
    using Key = std::array<i64, 6>;
    const auto keyOf = [](const glm::dvec3& a, const glm::dvec3& b) {
        Key key;
        for (int k = 0; k < 3; ++k) {
            key[size_t(k)] = std::llround(a[k] * 1e5);
            key[size_t(k) + 3] = std::llround(b[k] * 1e5);
        }
        return key;
    };
    std::map<Key, int> count;
    const auto addRing = [&](const Ring3& ring) {
        for (size_t k = 0; k < ring.size(); ++k) ++count[keyOf(ring[k], ring[(k + 1) % ring.size()])];
    };
    for (const Face& face : geometry.faces) {
        addRing(face.polygon.outer);
        for (const Ring3& hole : face.polygon.holes) addRing(hole);
    }
    size_t open = 0;
    for (const auto& [key, n] : count) {
        const Key opposite = {key[3], key[4], key[5], key[0], key[1], key[2]};
        const auto found = count.find(opposite);
        if (n != 1 || found == count.end() || found->second != 1) ++open;
    }
    return open;
}

/// A gabled prism over [0, x] x [0, z], ridge along x at height h above y = 0; closed, with its bottom.
inline Geometry gabledPrism(double x, double z, double h)
{
    Geometry solid;
    solid.closed = true;
    const glm::dvec3 a(0, 0, z), b(x, 0, z), c(x, 0, 0), d(0, 0, 0), r(0, h, z / 2), s(x, h, z / 2);
    for (const Ring3& ring :
         {Ring3{a, b, s, r}, Ring3{c, d, r, s}, Ring3{b, c, s}, Ring3{d, a, r}, Ring3{d, c, b, a}}) {
        Face& face = solid.faces.emplace_back();
        face.polygon.outer = ring;
        face.xAxis =
            (ring[1] - ring[0]) / std::sqrt(std::pow(ring[1].x - ring[0].x, 2) + std::pow(ring[1].z - ring[0].z, 2));
    }
    return solid;
}

} // namespace helio::cga
