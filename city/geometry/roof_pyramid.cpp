// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <glm/geometric.hpp>
#include <optional>

#include "city/geometry/roof_solid.h"

namespace helio {

namespace {

/// Distance of a point from the line of the edge a-b, positive on its left.
double leftOf(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p)
{
    return cross(glm::normalize(b - a), p - a);
}

/// True if all of the ring sees the point, with at least 1 cm between it and the line of every edge.
bool starShaped(const Ring2& ring, const glm::dvec2& point)
{
    for (std::size_t i = 0; i < ring.size(); ++i)
        if (leftOf(ring[i], ring[(i + 1) % ring.size()], point) < 0.01) return false;
    return true;
}

std::optional<glm::dvec2> apexOf(const Ring2& ring)
{
    glm::dvec2 mean(0.0);
    for (const glm::dvec2& p : ring) mean += p / double(ring.size());
    if (starShaped(ring, mean)) return mean;
    glm::dvec2 sum(0.0);
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
        sum += (a + b) * cross(a, b) / 6.0;
    }
    const glm::dvec2 centre = ring[0] + sum / signedArea(ring);
    if (starShaped(ring, centre)) return centre;
    return std::nullopt;
}

} // namespace

Roof pyramidRoof(const Polygon2& base, const RoofPitch& pitch)
{
    Roof roof;
    for (const RoofBase& piece : cleanBase(base)) {
        if (!soundPitch(pitch)) {
            appendFlat(roof, piece, "the pitch is out of range");
            continue;
        }
        const Ring2& ring = piece.polygon.outer;
        const std::optional<glm::dvec2> apex = piece.polygon.holes.empty() ? apexOf(ring) : std::nullopt;
        if (!apex) {
            appendHip(roof, piece, pitch, 0.0);
            continue;
        }
        RoofMesh mesh;
        RoofMesh::Face bottom;
        bottom.part = RoofPart::Bottom;
        const u32 n = u32(ring.size());
        for (u32 i = 0; i < n; ++i) {
            mesh.nodes.push_back({ring[i].x, ring[i].y, 0.0});
            mesh.faces.push_back({{i, (i + 1) % n, n}, {}, RoofPart::Slope, piece.edge[i]});
            bottom.ring.push_back(n - 1 - i);
        }
        mesh.nodes.push_back({apex->x, apex->y, leftOf(ring[0], ring[1], *apex)});
        mesh.faces.push_back(std::move(bottom));
        append(roof, mesh, slopeFactor(mesh, pitch));
    }
    return roof;
}

} // namespace helio
