// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "engine/stream/draw_chunks.h"

namespace helio {

namespace {

constexpr u32 kSectors = 16;         // of azimuth; with up and down the directions that ranges are sorted by
constexpr float kSteep = 0.7f;       // a normal's z from which on it faces up or down
constexpr size_t kMostNormals = 64;  // of a range: a curved one is not worth the while
constexpr float kSameNormal = 1e-4f; // two normals this close are one

/// Sets of corners that hang together.
class Parts
{
public:
    explicit Parts(u32 count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    u32 find(u32 x)
    {
        while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
        return x;
    }
    void join(u32 a, u32 b) { parent_[find(a)] = find(b); }

private:
    std::vector<u32> parent_;
};

u32 directionOf(const glm::vec3& normal)
{
    if (std::abs(normal.z) > kSteep) return kSectors + (normal.z < 0.0f);
    const float turn = std::atan2(normal.y, normal.x) / (2.0f * std::numbers::pi_v<float>);
    // Walls along the axes lie in the middle of a sector.
    return u32(std::floor((turn + 1.0f) * kSectors + 0.5f)) % kSectors;
}

/// Numbers of the places of corners: the same for corners at the same place.
std::vector<u32> numberPlaces(std::span<const glm::vec3> positions)
{
    const auto hash = [](const glm::vec3& p) {
        u64 h = 0;
        for (int c = 0; c < 3; ++c) h = (h ^ std::bit_cast<u32>(p[c] + 0.0f)) * 0x9E3779B97F4A7C15ull; // -0 is 0
        return size_t(h ^ (h >> 29));
    };
    std::unordered_map<glm::vec3, u32, decltype(hash)> known(positions.size() / 2 + 1, hash);
    std::vector<u32> places;
    places.reserve(positions.size());
    for (const glm::vec3& p : positions) places.push_back(known.emplace(p, u32(known.size())).first->second);
    return places;
}

} // namespace

std::vector<bool> closedTriangles(std::span<const glm::vec3> positions)
{
    HELIO_CHECK(positions.size() % 3 == 0, positions.size(), " corners");
    const std::vector<u32> places = numberPlaces(positions);
    const u32 placeCount = places.empty() ? 0 : *std::max_element(places.begin(), places.end()) + 1;
    Parts parts(placeCount);
    struct Side
    {
        u64 edge; ///< its lower place, its higher one
        int turn; ///< 1: from the lower to the higher
        bool operator<(const Side& other) const { return edge < other.edge; }
    };
    std::vector<Side> sides;
    sides.reserve(places.size());
    for (size_t t = 0; t < places.size(); t += 3)
        for (size_t k = 0; k < 3; ++k) {
            const u32 a = places[t + k], b = places[t + (k + 1) % 3];
            parts.join(a, b);
            sides.push_back({u64(std::min(a, b)) << 32 | std::max(a, b), a < b ? 1 : -1});
        }
    std::sort(sides.begin(), sides.end());
    std::vector<bool> open(placeCount, false);
    for (size_t first = 0; first < sides.size();) {
        size_t last = first;
        int turns = 0;
        for (; last < sides.size() && sides[last].edge == sides[first].edge; ++last) turns += sides[last].turn;
        if (turns != 0) open[parts.find(u32(sides[first].edge >> 32))] = true;
        first = last;
    }
    std::vector<double> volume(placeCount, 0.0);
    for (size_t t = 0; t < places.size(); t += 3) {
        const glm::dvec3 origin(positions[0]), a = glm::dvec3(positions[t]) - origin,
                                               b = glm::dvec3(positions[t + 1]) - origin,
                                               c = glm::dvec3(positions[t + 2]) - origin;
        volume[parts.find(places[t])] += glm::dot(a, glm::cross(b, c));
    }
    std::vector<bool> closed;
    for (size_t t = 0; t < places.size(); t += 3) {
        const u32 part = parts.find(places[t]);
        closed.push_back(!open[part] && volume[part] > 0.0);
    }
    return closed;
}

FacingMesh sortByFacing(std::span<const glm::vec3> positions, const std::vector<bool>& closed, size_t firstTriangle,
                        std::span<u32> indices, u32 firstIndex)
{
    const u32 count = u32(indices.size() / 3);
    HELIO_CHECK(positions.size() == indices.size() && firstTriangle + count <= closed.size(), positions.size(),
                " corners, ", indices.size(), " indices, triangles ", firstTriangle, " on of ", closed.size());
    constexpr u32 kOpen = ~0u;
    struct Key
    {
        u32 direction, triangle;
    };
    std::vector<Key> order;
    std::vector<glm::vec3> normals;
    for (u32 t = 0; t < count; ++t) {
        const glm::vec3 cross =
            glm::cross(positions[3 * t + 1] - positions[3 * t], positions[3 * t + 2] - positions[3 * t]);
        const float length = glm::length(cross);
        normals.push_back(length > 0.0f ? cross / length : glm::vec3(0.0f));
        order.push_back({closed[firstTriangle + t] && length > 0.0f ? directionOf(normals[t]) : kOpen, t});
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const Key& a, const Key& b) { return a.direction + 1 < b.direction + 1; });

    FacingMesh mesh;
    const std::vector<u32> before(indices.begin(), indices.end());
    u32 last = kOpen;
    for (u32 n = 0; n < order.size(); ++n) {
        const auto [direction, triangle] = order[n];
        std::copy_n(before.begin() + 3 * triangle, 3, indices.begin() + 3 * n);
        if (direction == kOpen) {
            mesh.openCount += 3;
            continue;
        }
        if (direction != last) mesh.ranges.push_back({firstIndex + 3 * n, 0, {}, false});
        last = direction;
        FacingRange& range = mesh.ranges.back();
        range.indexCount += 3;
        const glm::vec3& normal = normals[triangle];
        if (range.always) continue;
        const bool known = std::any_of(range.normals.begin(), range.normals.end(), [&](const glm::vec3& other) {
            return glm::distance(other, normal) < kSameNormal;
        });
        if (!known) range.normals.push_back(normal);
        if (range.normals.size() <= kMostNormals) continue;
        range.always = true;
        range.normals.clear();
    }
    return mesh;
}

} // namespace helio
