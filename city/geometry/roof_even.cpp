// SPDX-License-Identifier: Apache-2.0
#include "city/geometry/roof_even.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

namespace helio {

namespace {

constexpr double kPlaneTolerance = 1e-6; ///< m
constexpr double kLeastTriangle = 1e-5;  ///< m2 in plan
constexpr std::size_t kMostCorners = 48;

/// Triangles of a ring of corners, those whose smallest one is largest in plan (dynamic programming over the ring's
/// chords, O(n^3)); none if it would be too small. Where all triangles turn left they tile the ring.
std::vector<std::array<u32, 3>> bestTriangles(const std::vector<u32>& ring, const std::vector<glm::dvec3>& nodes)
{
    const std::size_t n = ring.size();
    if (n > kMostCorners) return {};
    const auto planArea = [&](std::size_t i, std::size_t j, std::size_t k) {
        const auto plan = [&](std::size_t c) { return glm::dvec2(nodes[ring[c]].x, nodes[ring[c]].y); };
        return 0.5 * cross(plan(i), plan(j), plan(k));
    };
    std::vector<double> smallest(n * n, 1e300); // over the best triangles of the corners i..k
    std::vector<std::size_t> apex(n * n, 0);
    for (std::size_t span = 2; span < n; ++span) {
        for (std::size_t i = 0; i + span < n; ++i) {
            const std::size_t k = i + span;
            double best = -1e300;
            for (std::size_t j = i + 1; j < k; ++j) {
                const double value = std::min({planArea(i, j, k), smallest[i * n + j], smallest[j * n + k]});
                if (value <= best) continue;
                best = value;
                apex[i * n + k] = j;
            }
            smallest[i * n + k] = best;
        }
    }
    if (smallest[n - 1] < kLeastTriangle) return {};
    std::vector<std::array<u32, 3>> triangles;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, n - 1}};
    while (!open.empty()) {
        const auto [i, k] = open.back();
        open.pop_back();
        if (k - i < 2) continue;
        const std::size_t j = apex[i * n + k];
        triangles.push_back({ring[i], ring[j], ring[k]});
        open.push_back({i, j});
        open.push_back({j, k});
    }
    return triangles;
}

/// Heights with level ridges.
std::vector<glm::dvec3> levelNodes(const RoofMesh& mesh)
{
    std::map<std::pair<u32, u32>, RoofPart> owner;
    std::vector<bool> onGable(mesh.nodes.size(), false);
    for (const RoofMesh::Face& face : mesh.faces) {
        for (std::size_t i = 0; i < face.ring.size(); ++i) {
            owner[{face.ring[i], face.ring[(i + 1) % face.ring.size()]}] = face.part;
            if (face.part == RoofPart::Gable) onGable[face.ring[i]] = true;
        }
    }
    // A ridge's end on a gable has one arc between two slopes.
    std::map<u32, u32> otherEnd;
    for (const auto& [arc, part] : owner) {
        const auto twin = owner.find({arc.second, arc.first});
        if (part != RoofPart::Slope || twin == owner.end() || twin->second != RoofPart::Slope) continue;
        otherEnd[arc.first] = otherEnd.contains(arc.first) ? kNoIndex : arc.second;
    }
    std::vector<glm::dvec3> level = mesh.nodes;
    const double eaves = mesh.nodes[0].z;
    for (const auto& [end, other] : otherEnd) {
        if (!onGable[end] || other == kNoIndex || mesh.nodes[end].z <= eaves) continue;
        const double z = mesh.nodes[other].z;
        if (z <= eaves) continue; // a ridge that falls to a corner of the base has no other height
        level[end].z = onGable[other] ? 0.5 * (mesh.nodes[end].z + z) : z;
    }
    return level;
}

bool isPlane(const std::vector<u32>& ring, const std::vector<glm::dvec3>& nodes)
{
    Ring3 corners;
    for (const u32 n : ring) corners.push_back(nodes[n]);
    const glm::dvec3 normal = glm::normalize(vectorArea(corners));
    return std::all_of(corners.begin(), corners.end(), [&](const glm::dvec3& p) {
        return std::abs(glm::dot(p - corners[0], normal)) < kPlaneTolerance;
    });
}

} // namespace

void levelRidges(RoofMesh& mesh)
{
    RoofMesh level{levelNodes(mesh), {}};
    for (const RoofMesh::Face& face : mesh.faces) {
        if (face.part != RoofPart::Slope || isPlane(face.ring, level.nodes)) {
            level.faces.push_back(face);
            continue;
        }
        const auto triangles = bestTriangles(face.ring, level.nodes);
        if (triangles.empty()) return;
        for (const auto& t : triangles) level.faces.push_back({{t[0], t[1], t[2]}, {}, face.part, face.edge});
    }
    mesh = std::move(level);
}

} // namespace helio
