// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/box_city.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "city/base/hash.h"
#include "city/pack/vertex_pack.h"

namespace helio {

namespace {

constexpr float kBay = 4.0f, kStorey = 3.2f; // m
constexpr float kSpacing = 60.0f;            // m, of the buildings
constexpr u32 kColour = 0xFFB0B8C0u;

} // namespace

BoxCity::BoxCity(u32 triangles)
{
    instances_.push_back({{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}, 0, 0, 0, 0});
    Random random(11);
    // About how many buildings there will be: the one of 3 x 3 bays and 5 storeys has 900 triangles.
    const u32 across = u32(std::ceil(std::sqrt(double(triangles) / 2400.0)));
    for (u32 k = 0; indices_.size() / 3 < triangles; ++k) {
        const auto upTo = [&](u32 lo, u32 hi) { return lo + u32(random.uniform() * (hi - lo + 1)); };
        const u32 width = upTo(3, 8), depth = upTo(3, 5);
        building({kSpacing * float(k % across), kSpacing * float(k / across), 0.0f}, float(random.uniform() * 0.5),
                 width, depth, upTo(3, 9));
    }
    const float size = kSpacing * float(across + 1);
    const glm::vec3 ground[4] = {{-60, -60, -0.01f}, {size, -60, -0.01f}, {size, size, -0.01f}, {-60, size, -0.01f}};
    quad(ground, patch({0, 0, 1}, (size + 60.0f) * (size + 60.0f)));
    for (const gpu::PatchRecord& p : patches_) nodes_.push_back({kNoIndex, 0, 0, p.area});
    rows_.assign(nodes_.size() + 1, 0);
    skyRows_.assign(patches_.size() + 1, 0);
    draws_.push_back({u32(indices_.size()), 1, 0, 0, 0});
    sky_.push_back({{0, 0, 1}, 6.2831853f, {}});
}

u32 BoxCity::patch(glm::vec3 normal, float area)
{
    gpu::PatchRecord record{};
    record.normal = normal;
    record.area = area;
    record.rho = glm::vec4(0.4f);
    record.building = record.sourceFace = record.surface = kNoIndex;
    patches_.push_back(record);
    return u32(patches_.size() - 1);
}

void BoxCity::quad(const glm::vec3 (&c)[4], u32 patch)
{
    const u32 normal = packNormal(glm::normalize(glm::cross(c[1] - c[0], c[3] - c[0])));
    const u32 first = u32(vertices_.size());
    for (const glm::vec3& corner : c) vertices_.push_back({corner, patch, normal, kColour});
    for (const u32 k : {0u, 1u, 2u, 0u, 2u, 3u}) indices_.push_back(first + k);
}

void BoxCity::wall(glm::vec3 foot, glm::vec3 along, glm::vec3 outwards, u32 columns, u32 storeys)
{
    const auto corner = [&](u32 x, u32 z) {
        return foot + kBay * float(x) * along + glm::vec3(0, 0, kStorey * float(z));
    };
    for (u32 z = 0; z < storeys; ++z)
        for (u32 x = 0; x < columns; ++x) {
            const glm::vec3 tile[4] = {corner(x, z), corner(x + 1, z), corner(x + 1, z + 1), corner(x, z + 1)};
            const u32 id = patch(outwards, kBay * kStorey);
            quad(tile, id);
            // A window of 1.5 x 1.6 m and 0.2 m, closed, a finger's breadth before the wall.
            const glm::vec3 up(0, 0, 1.6f), side = 1.5f * along, out = 0.2f * outwards;
            const glm::vec3 a = corner(x, z) + 1.25f * along + glm::vec3(0, 0, 0.8f) + 0.02f * outwards;
            const glm::vec3 sides[6][4] = {{a + out, a + side + out, a + side + up + out, a + up + out},
                                           {a + side, a, a + up, a + side + up},
                                           {a, a + out, a + up + out, a + up},
                                           {a + side + out, a + side, a + side + up, a + side + up + out},
                                           {a, a + side, a + side + out, a + out},
                                           {a + up + out, a + side + up + out, a + side + up, a + up}};
            for (const auto& s : sides) quad(s, id);
        }
}

void BoxCity::building(glm::vec3 foot, float turn, u32 width, u32 depth, u32 storeys)
{
    const glm::vec3 x(std::cos(turn), std::sin(turn), 0), y(-x.y, x.x, 0);
    const glm::vec3 xEnd = kBay * float(width) * x, yEnd = kBay * float(depth) * y;
    wall(foot, x, -y, width, storeys);
    wall(foot + xEnd, y, x, depth, storeys);
    wall(foot + xEnd + yEnd, -x, y, width, storeys);
    wall(foot + yEnd, -y, -x, depth, storeys);
    // Roof and floor, cell by cell, so that their edges are those of the walls. A corner comes from the wall that has
    // it.
    for (const u32 level : {0u, storeys}) {
        const u32 id = patch({0, 0, level ? 1 : -1}, kBay * kBay * float(width * depth));
        const auto corner = [&](u32 i, u32 k) {
            const glm::vec3 up(0, 0, kStorey * float(level));
            if (k == 0) return foot + kBay * float(i) * x + up;
            if (i == width) return foot + xEnd + kBay * float(k) * y + up;
            if (k == depth) return foot + xEnd + yEnd + kBay * float(width - i) * -x + up;
            if (i == 0) return foot + yEnd + kBay * float(depth - k) * -y + up;
            return foot + kBay * float(i) * x + kBay * float(k) * y + up;
        };
        for (u32 k = 0; k < depth; ++k)
            for (u32 i = 0; i < width; ++i) {
                const glm::vec3 cell[4] = {corner(i, k), corner(i + 1, k), corner(i + 1, k + 1), corner(i, k + 1)};
                const glm::vec3 below[4] = {cell[0], cell[3], cell[2], cell[1]};
                level ? quad(cell, id) : quad(below, id);
            }
    }
}

TileView BoxCity::view() const
{
    TileView tile;
    tile.patches = patches_;
    tile.nodes = nodes_;
    tile.linkRows = rows_;
    tile.skyPatches = sky_;
    tile.skyRows = skyRows_;
    tile.vertices = vertices_;
    tile.indices = indices_;
    tile.instances = instances_;
    tile.draws = draws_;
    return tile;
}

} // namespace helio
