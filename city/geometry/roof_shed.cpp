// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "city/geometry/roof_solid.h"

namespace helio {

namespace {

/// Corners lower than this (for a slope of 45 degrees) lie on the base, m: no sliver of a wall under them.
constexpr double kOnBase = 1e-3;
constexpr double kLeastEdge = 0.01; ///< m; shorter edges give no direction

/// Unit direction in plan in which the roof rises: from the edge, or the first one after it of at least 1 cm.
glm::dvec2 riseFrom(const Ring2& ring, u32 edge)
{
    glm::dvec2 along(1.0, 0.0);
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2& from = ring[(edge % ring.size() + i) % ring.size()];
        const glm::dvec2& to = ring[(edge % ring.size() + i + 1) % ring.size()];
        if (glm::distance(from, to) < kLeastEdge) continue;
        along = glm::normalize(to - from);
        break;
    }
    // Clockwise input has its interior on the other side.
    return signedArea(ring) < 0.0 ? glm::dvec2(along.y, -along.x) : glm::dvec2(-along.y, along.x);
}

void appendShed(Roof& roof, const RoofBase& piece, const RoofPitch& pitch, const glm::dvec2& up)
{
    const auto edges = edgesOf(piece.polygon);
    const u32 n = u32(edges.size());
    double lowest = 1e300;
    for (const auto& [a, b] : edges) lowest = std::min(lowest, glm::dot(a, up));
    RoofMesh mesh;
    for (const auto& [a, b] : edges) mesh.nodes.push_back({a.x, a.y, 0.0});
    std::vector<u32> top(n);
    for (u32 i = 0; i < n; ++i) {
        const double height = glm::dot(edges[i].first, up) - lowest;
        top[i] = height < kOnBase ? i : u32(mesh.nodes.size());
        if (top[i] != i) mesh.nodes.push_back({edges[i].first.x, edges[i].first.y, height});
    }
    RoofMesh::Face slope, bottom;
    bottom.part = RoofPart::Bottom;
    u32 first = 0;
    const auto addRing = [&](const Ring2& ring, std::vector<u32>& above, std::vector<u32>& below) {
        const u32 count = u32(ring.size());
        for (u32 i = 0; i < count; ++i) {
            const u32 a = first + i, b = first + (i + 1) % count;
            above.push_back(top[a]);
            below.push_back(first + count - 1 - i);
            std::vector<u32> side{a, b};
            if (top[b] != b) side.push_back(top[b]);
            if (top[a] != a) side.push_back(top[a]);
            if (side.size() > 2) mesh.faces.push_back({side, {}, RoofPart::Gable, piece.edge[a]});
        }
        first += count;
    };
    addRing(piece.polygon.outer, slope.ring, bottom.ring);
    for (const Ring2& hole : piece.polygon.holes) {
        slope.holes.emplace_back();
        bottom.holes.emplace_back();
        addRing(hole, slope.holes.back(), bottom.holes.back());
    }
    mesh.faces.push_back(std::move(slope));
    mesh.faces.push_back(std::move(bottom));
    append(roof, mesh, slopeFactor(mesh, pitch));
}

} // namespace

Roof shedRoof(const Polygon2& base, const RoofPitch& pitch, u32 edge)
{
    Roof roof;
    for (const RoofBase& piece : cleanBase(base)) {
        const glm::dvec2 up = riseFrom(base.outer, edge);
        if (soundPitch(pitch))
            appendShed(roof, piece, pitch, up);
        else
            appendFlat(roof, piece, "the pitch is out of range");
    }
    return roof;
}

} // namespace helio
