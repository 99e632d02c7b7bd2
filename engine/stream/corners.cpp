// SPDX-License-Identifier: Apache-2.0
#include "engine/stream/corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>
#include <utility>

#include "city/base/check.h"
#include "city/base/hash.h"

namespace helio {

namespace {

constexpr float kCell = 1.0f;       // m, of the grid that finds corners on edges
constexpr float kJoin = 1e-3f;      // m, within which positions are one
constexpr float kEdgeInset = 0.01f; // m, that a corner must keep from the ends of an edge to count as inside it

struct Key
{
    std::array<i32, 3> position;
    u32 normal;
    auto operator<=>(const Key&) const = default;
};

Key keyOf(const gpu::VertexRecord& v)
{
    const glm::vec3 p = v.position / kJoin;
    return {{i32(std::lround(p.x)), i32(std::lround(p.y)), i32(std::lround(p.z))}, v.normal};
}

u64 cellOf(glm::vec3 p, u32 normal)
{
    const std::array<i32, 4> cell{i32(std::floor(p.x / kCell)), i32(std::floor(p.y / kCell)),
                                  i32(std::floor(p.z / kCell)), i32(normal)};
    return hashBytes(std::as_bytes(std::span(cell)));
}

struct Member
{
    u32 corner, patch;
    auto operator<=>(const Member&) const = default;
};

} // namespace

Corners buildCorners(std::span<const gpu::VertexRecord> vertices, std::span<const u32> indices)
{
    Corners corners;
    std::vector<std::pair<Key, u32>> sorted;
    sorted.reserve(vertices.size());
    for (u32 i = 0; i < vertices.size(); ++i) sorted.push_back({keyOf(vertices[i]), i});
    std::sort(sorted.begin(), sorted.end());

    corners.ofVertex.resize(vertices.size());
    std::vector<u32> representative;
    std::vector<Member> members;
    members.reserve(vertices.size());
    for (u32 k = 0; k < sorted.size(); ++k) {
        if (k == 0 || sorted[k].first != sorted[k - 1].first) representative.push_back(sorted[k].second);
        const u32 corner = u32(representative.size() - 1);
        corners.ofVertex[sorted[k].second] = corner;
        members.push_back({corner, vertices[sorted[k].second].patchId});
    }

    std::unordered_map<u64, std::vector<u32>> grid; // looked up only, never walked
    for (u32 c = 0; c < representative.size(); ++c) {
        const gpu::VertexRecord& v = vertices[representative[c]];
        grid[cellOf(v.position, v.normal)].push_back(c);
    }
    for (u32 i = 0; i < indices.size(); ++i) {
        const gpu::VertexRecord& a = vertices[indices[i]];
        const gpu::VertexRecord& b = vertices[indices[i % 3 == 2 ? i - 2 : i + 1]];
        const glm::vec3 edge = b.position - a.position;
        const float length = glm::length(edge);
        if (length <= 2.0f * kEdgeInset) continue;
        const glm::vec3 along = edge / length;
        const u32 steps = u32(std::ceil(2.0f * length / kCell));
        u64 lastCell = 0;
        for (u32 s = 0; s <= steps; ++s) {
            const u64 cell = cellOf(a.position + edge * (float(s) / float(steps)), a.normal);
            if (s > 0 && cell == lastCell) continue;
            lastCell = cell;
            const auto found = grid.find(cell);
            if (found == grid.end()) continue;
            for (const u32 c : found->second) {
                const gpu::VertexRecord& v = vertices[representative[c]];
                const glm::vec3 offset = v.position - a.position;
                const float t = glm::dot(offset, along);
                if (v.normal != a.normal || t < kEdgeInset || t > length - kEdgeInset) continue;
                if (glm::length(offset - along * t) < kJoin) members.push_back({c, a.patchId});
            }
        }
    }

    std::sort(members.begin(), members.end());
    members.erase(std::unique(members.begin(), members.end()), members.end());
    corners.rows.assign(representative.size() + 1, 0);
    for (const Member& m : members) {
        ++corners.rows[m.corner + 1];
        corners.patches.push_back(m.patch);
    }
    for (u32 c = 0; c < representative.size(); ++c) corners.rows[c + 1] += corners.rows[c];
    return corners;
}

} // namespace helio
