// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/vec2.hpp>
#include <vector>

#include "city/base/hash.h"
#include "city/format/pack.h"

namespace helio {

/// A plane: a place on it and two unit vectors in it, at right angles.
struct WallPlane
{
    glm::vec3 origin{0.0f}, across{1, 0, 0}, up{0, 0, 1};
    glm::vec3 normal() const;
    glm::vec3 at(glm::vec2 p) const { return origin + p.x * across + p.y * up; }
};

/// Makes a static mesh by hand: patches of any shape, in any planes.
class WallBuilder
{
public:
    /// An empty patch; returns its id. Its area is that of what is added to it.
    u32 patch(const WallPlane& plane, u32 building = 0);
    void triangle(u32 patch, glm::vec2 a, glm::vec2 b, glm::vec2 c, u32 albedo = 0);
    /// Two triangles.
    void rectangle(u32 patch, glm::vec2 lo, glm::vec2 hi, u32 albedo = 0);
    /// A triangle of the patch in another plane.
    void foreign(u32 patch, const WallPlane& plane, glm::vec2 a, glm::vec2 b, glm::vec2 c);
    /// A rectangle cut at random places, across or along, until `count` patches are made.
    void guillotine(Random& random, const WallPlane& plane, glm::vec2 lo, glm::vec2 hi, u32 count, u32 building = 0);
    /// A wall with all there is: a guillotine's cuts (T-junctions), an L, a frame, two colours, a reveal, and another
    /// building beside it. About `count` patches.
    void everything(Random& random, u32 count);

    /// Valid until the builder changes.
    TileView view();

    std::vector<gpu::PatchRecord> patches;
    std::vector<gpu::VertexRecord> vertices;
    std::vector<u32> indices;

private:
    void add(u32 patch, const WallPlane& plane, const std::array<glm::vec2, 3>& corners, u32 albedo);

    std::vector<WallPlane> planes_; // a patch
    std::vector<gpu::InstanceRecord> instances_;
    std::vector<gpu::DrawRecord> draws_;
};

} // namespace helio
