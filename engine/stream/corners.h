// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "city/base/types.h"
#include "shaders/shared/records.h"

namespace helio {

inline constexpr float kCornerJoin = 1e-3f; ///< m, within which positions are one

/// A place where coplanar patches of one building (or of the ground) meet.
struct Corner
{
    glm::vec3 position; ///< m, that of its first vertex
    u32 normal;         ///< packed, of its vertices
    u32 building;       ///< of its patches
};

/// Joins vertices into corners and finds those that lie inside an edge (T-junctions): a grid whose cells are about as
/// large as a triangle.
class Corners
{
public:
    /// Joins vertices of one building that have the same normal and the same position to kCornerJoin. indices:
    /// triangles, of which alone the vertices are joined.
    Corners(std::span<const gpu::VertexRecord> vertices, std::span<const u32> indices,
            std::span<const gpu::PatchRecord> patches);

    const std::vector<Corner>& all() const { return corners_; }
    u32 ofVertex(u32 vertex) const { return ofVertex_[vertex]; } ///< kNone: no triangle uses the vertex
    /// Corners inside the edge from corner a to corner b, of their plane and building, in order from a to b: no further
    /// than kCornerJoin from the edge.
    std::vector<u32> inside(u32 a, u32 b) const;

private:
    /// Calls visit(corner) for the corners that may lie within `reach` of a point; for some more than once, and for
    /// others.
    template <class Visit> void near(glm::vec3 point, float reach, u32 normal, u32 building, const Visit& visit) const;
    u64 bucketOf(const glm::ivec3& cell, u32 normal, u32 building) const;
    void add(const Corner& corner);

    float cell_ = 1.0f; ///< m
    std::vector<Corner> corners_;
    std::vector<u32> ofVertex_;
    std::vector<u32> heads_; ///< first corner of a bucket of cells
    std::vector<u32> next_;  ///< corner after a corner in its bucket
};

} // namespace helio
