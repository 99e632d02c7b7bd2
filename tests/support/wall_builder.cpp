// SPDX-License-Identifier: Apache-2.0
#include "tests/support/wall_builder.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace helio {

namespace {

u32 packNormal(glm::vec3 n)
{
    const auto part = [](float x) { return u32(i32(std::lround(x * 511.0f))) & 1023u; };
    return part(n.x) | part(n.y) << 10 | part(n.z) << 20;
}

} // namespace

glm::vec3 WallPlane::normal() const
{
    return glm::normalize(glm::cross(across, up));
}

u32 WallBuilder::patch(const WallPlane& plane, u32 building)
{
    gpu::PatchRecord record{};
    record.normal = plane.normal();
    record.building = building;
    patches.push_back(record);
    planes_.push_back(plane);
    return u32(patches.size() - 1);
}

void WallBuilder::add(u32 patch, const WallPlane& plane, const std::array<glm::vec2, 3>& corners, u32 albedo)
{
    for (const glm::vec2 p : corners) {
        indices.push_back(u32(vertices.size()));
        vertices.push_back({plane.at(p), patch, packNormal(plane.normal()), albedo});
    }
}

void WallBuilder::triangle(u32 patch, glm::vec2 a, glm::vec2 b, glm::vec2 c, u32 albedo)
{
    add(patch, planes_[patch], {a, b, c}, albedo);
    patches[patch].area += 0.5f * std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}

void WallBuilder::rectangle(u32 patch, glm::vec2 lo, glm::vec2 hi, u32 albedo)
{
    triangle(patch, lo, {hi.x, lo.y}, hi, albedo);
    triangle(patch, lo, hi, {lo.x, hi.y}, albedo);
}

void WallBuilder::foreign(u32 patch, const WallPlane& plane, glm::vec2 a, glm::vec2 b, glm::vec2 c)
{
    add(patch, plane, {a, b, c}, 0);
}

void WallBuilder::guillotine(Random& random, const WallPlane& plane, glm::vec2 lo, glm::vec2 hi, u32 count,
                             u32 building)
{
    if (count == 1) {
        rectangle(patch(plane, building), lo, hi);
        return;
    }
    const u32 first = 1 + u32(random.uniform() * (count - 1));
    const int axis = hi.x - lo.x > hi.y - lo.y ? 0 : 1;
    glm::vec2 middleHi = hi, middleLo = lo;
    middleHi[axis] = middleLo[axis] = lo[axis] + float(0.2 + 0.6 * random.uniform()) * (hi[axis] - lo[axis]);
    guillotine(random, plane, lo, middleHi, first, building);
    guillotine(random, plane, middleLo, hi, count - first, building);
}

void WallBuilder::everything(Random& random, u32 count)
{
    // Turned by some angle, so that no coordinate is a whole number.
    const WallPlane plane{{3, 4, 5}, {0.6f, 0.8f, 0}, {0, 0, 1}};
    guillotine(random, plane, {0, 0}, {20, 8}, count);
    const u32 ell = patch(plane); // its centroid lies outside
    rectangle(ell, {0, 8}, {8, 9});
    rectangle(ell, {0, 9}, {1, 14});
    const u32 frame = patch(plane); // around a window, whose reveal it has
    rectangle(frame, {1, 9}, {8, 10});
    rectangle(frame, {1, 10}, {2, 14});
    rectangle(frame, {7, 10}, {8, 14});
    const WallPlane reveal{plane.at({2, 10}), -plane.normal(), plane.up};
    foreign(frame, reveal, {0, 0}, {0.3f, 0}, {0.3f, 4});
    const u32 twoColours = patch(plane);
    rectangle(twoColours, {8, 8}, {11, 14}, 1);
    rectangle(twoColours, {11, 8}, {13, 14}, 2);
    guillotine(random, plane, {13, 8}, {20, 14}, count / 2);
    guillotine(random, plane, {20, 0}, {30, 14}, count, 1);
    const WallPlane side{plane.origin, -plane.normal(), plane.up};
    guillotine(random, side, {0, 0}, {9, 14}, count / 2);
}

TileView WallBuilder::view()
{
    instances_ = {{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}, 0, 0, 0, 0}};
    draws_ = {{u32(indices.size()), 1, 0, 0, 0}};
    TileView tile;
    tile.patches = patches;
    tile.vertices = vertices;
    tile.indices = indices;
    tile.instances = instances_;
    tile.draws = draws_;
    return tile;
}

} // namespace helio
