// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "city/model/node_tree.h"

namespace helio {

/// The patch that a ray meets first.
struct RayHit
{
    u32 patch = kNoIndex;  ///< kNoIndex: nothing, the ray leaves the scene
    bool front = false;    ///< the lit side
    glm::dvec3 point{0.0}; ///< where, in the tree's frame; only with a patch
};

/// The planar node that a ray meets first.
struct RayEnd
{
    u32 node = kNoIndex;   ///< a patch, or a node whose patches fill it; kNoIndex: nothing
    bool front = false;    ///< the lit side
    float distance = 0.0f; ///< m; only with a node
};

/// Rays against the polygons of all patches. Patches block from both sides; assets do not block, the patch in whose
/// place they are drawn does. All positions are in the tree's frame, in double; inside, everything is float relative to
/// the centre of the scene. Safe to use from several threads.
class Visibility
{
public:
    /// Triangulates every patch and builds the ray structure over the highest filledNodes(), and the patches that none
    /// stands for. Memory: about 200 bytes a triangle of these.
    explicit Visibility(const NodeTree& tree);
    ~Visibility();
    Visibility(const Visibility&) = delete;
    Visibility& operator=(const Visibility&) = delete;

    /// A point of the patch, uniform over its area for u, v uniform in [0, 1); neighbouring u stay near each other.
    glm::dvec3 pointOnPatch(u32 patch, double u, double v) const;
    /// True if something lies between two surface points. Each end is lifted off its surface along its unit normal.
    bool isBlocked(const glm::dvec3& from, const glm::dvec3& fromNormal, const glm::dvec3& to,
                   const glm::dvec3& toNormal) const;
    /// True if something lies in a unit direction from a surface point.
    bool isBlocked(const glm::dvec3& from, const glm::dvec3& normal, const glm::dvec3& direction) const;
    /// The same for many points of one surface and several directions: faster, since rays side by side go through the
    /// structure together. `blocked` has one entry a point and direction, those of a direction side by side.
    void areBlocked(std::span<const glm::dvec3> from, const glm::dvec3& normal, std::span<const glm::dvec3> directions,
                    std::span<bool> blocked) const;
    /// True where something lies between two surface points: from[k] on a surface of normal `fromNormal`, to[k] on one
    /// of `toNormal`.
    void areBlocked(std::span<const glm::dvec3> from, const glm::dvec3& fromNormal, std::span<const glm::dvec3> to,
                    const glm::dvec3& toNormal, std::span<bool> blocked) const;
    /// The first patch in a unit direction from a surface point. The first call builds a structure over all patches.
    RayHit trace(const glm::dvec3& from, const glm::dvec3& normal, const glm::dvec3& direction) const;
    /// The first node for many rays off one surface: ray k from from[k] along direction[k]. Faster where every eight of
    /// them go in much the same direction.
    void trace(std::span<const glm::dvec3> from, const glm::dvec3& normal, std::span<const glm::dvec3> direction,
               std::span<RayEnd> end) const;

    /// Where the middle of the scene is, in the tree's frame.
    glm::dvec3 origin() const;
    /// The triangles of a patch, three corners each, m, relative to origin().
    std::span<const glm::vec3> trianglesOf(u32 patch) const;
    /// Whether a node blocks as one polygon: filledNodes() with a quarter of the lift.
    bool isFilled(u32 node) const;
    /// How far rays start off a surface, m: what is nearer to it does not block them.
    double lift() const;
    u32 triangleCount() const; ///< of what blocks

private:
    struct Scene;
    std::unique_ptr<Scene> scene_;
};

} // namespace helio
