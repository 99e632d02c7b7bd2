// SPDX-License-Identifier: Apache-2.0
#include "engine/stream/corners.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <utility>

#include "city/base/hash.h"

namespace helio {

namespace {

/// About the size of a triangle, m.
float cellFor(std::span<const gpu::VertexRecord> vertices, std::span<const u32> indices)
{
    double area = 0.0;
    for (size_t k = 0; k + 2 < indices.size(); k += 3) {
        const glm::vec3 a = vertices[indices[k]].position;
        const glm::vec3 side = vertices[indices[k + 1]].position - a, other = vertices[indices[k + 2]].position - a;
        area += double(glm::length(glm::cross(side, other)));
    }
    return std::max(float(std::sqrt(area / double(std::max<size_t>(indices.size() / 3, 1)))), 8.0f * kCornerJoin);
}

} // namespace

Corners::Corners(std::span<const gpu::VertexRecord> vertices, std::span<const u32> indices,
                 std::span<const gpu::PatchRecord> patches)
    : cell_(cellFor(vertices, indices)), ofVertex_(vertices.size(), gpu::kNone),
      heads_(std::bit_ceil(std::max<size_t>(vertices.size(), 1)), gpu::kNone)
{
    for (const u32 index : indices) {
        u32& corner = ofVertex_[index];
        if (corner != gpu::kNone) continue;
        const gpu::VertexRecord& v = vertices[index];
        const Corner here{v.position, v.normal, patches[v.patchId].building};
        float nearest = kCornerJoin;
        near(here.position, kCornerJoin, here.normal, here.building, [&](u32 c) {
            const Corner& other = corners_[c];
            const float distance = glm::length(other.position - here.position);
            if (other.normal != here.normal || other.building != here.building || distance >= nearest) return;
            nearest = distance;
            corner = c;
        });
        if (corner != gpu::kNone) continue;
        corner = u32(corners_.size());
        add(here);
    }
}

u64 Corners::bucketOf(const glm::ivec3& cell, u32 normal, u32 building) const
{
    const std::array<u32, 5> key{u32(cell.x), u32(cell.y), u32(cell.z), normal, building};
    return hashBytes(std::as_bytes(std::span(key))) & (heads_.size() - 1);
}

void Corners::add(const Corner& corner)
{
    const u64 bucket = bucketOf(glm::ivec3(glm::floor(corner.position / cell_)), corner.normal, corner.building);
    next_.push_back(std::exchange(heads_[bucket], u32(corners_.size())));
    corners_.push_back(corner);
}

template <class Visit>
void Corners::near(glm::vec3 point, float reach, u32 normal, u32 building, const Visit& visit) const
{
    const glm::ivec3 lo(glm::floor((point - reach) / cell_)), hi(glm::floor((point + reach) / cell_));
    for (i32 z = lo.z; z <= hi.z; ++z)
        for (i32 y = lo.y; y <= hi.y; ++y)
            for (i32 x = lo.x; x <= hi.x; ++x)
                for (u32 c = heads_[bucketOf({x, y, z}, normal, building)]; c != gpu::kNone; c = next_[c]) visit(c);
}

std::vector<u32> Corners::inside(u32 a, u32 b) const
{
    const Corner& from = corners_[a];
    const glm::vec3 edge = corners_[b].position - from.position;
    const float length = glm::length(edge);
    std::vector<std::pair<float, u32>> found;
    const u32 steps = u32(std::ceil(length / cell_));
    for (u32 s = 0; s < steps; ++s) {
        // No point of the edge is further from one of the places than half a step.
        const glm::vec3 place = from.position + edge * ((float(s) + 0.5f) / float(steps));
        near(place, 0.5f * length / float(steps) + 2.0f * kCornerJoin, from.normal, from.building, [&](u32 c) {
            const Corner& other = corners_[c];
            if (other.normal != from.normal || other.building != from.building) return;
            const glm::vec3 offset = other.position - from.position;
            const float t = glm::dot(offset, edge) / length;
            if (t <= 0.0f || t >= length) return;
            if (glm::length(offset - edge * (t / length)) <= kCornerJoin) found.push_back({t, c});
        });
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    std::vector<u32> ordered;
    for (const auto& [t, c] : found) ordered.push_back(c);
    return ordered;
}

} // namespace helio
