// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "city/light/visibility.h"

namespace helio {

/// What may stand between two planar nodes: only what reaches into their shaft, the convex hull of both (Haines and
/// Wallace 1991, "Shaft culling for efficient ray-cast radiosity"). Where nothing does, no ray is needed; where a few
/// filled polygons do, rays need no other. Safe to use from several threads.
class Occluders
{
public:
    /// `visibility` of the same tree: its lift is the tolerance (what reaches into a shaft, or lies before a plane, by
    /// less does not block), its filled nodes are those that block as one polygon.
    Occluders(const NodeTree& tree, const Visibility& visibility);

    /// Appends to `found` at most `most` planar nodes that may stand between two planar nodes, the highest that are
    /// filled and else leaves. False if there are more.
    bool find(u32 a, u32 b, size_t most, std::vector<u32>& found) const;
    /// The same from the nodes at places [begin, end) of `found`, which stand between nodes that a and b are parts of.
    void narrow(u32 a, u32 b, size_t begin, size_t end, std::vector<u32>& found) const;

    /// Whether each segment from[k] to to[k], in the tree's frame, m, meets one of the nodes that were found.
    void block(std::span<const u32> nodes, std::span<const glm::dvec3> from, std::span<const glm::dvec3> to,
               std::span<bool> blocked) const;

private:
    struct Shaft;

    /// A half space: what is below its plane.
    struct Bound
    {
        glm::vec3 normal{0.0f};
        float offset = 0.0f; // m, relative to the origin
    };

    /// A planar node, and the convex polygon around its outline.
    struct Polygon
    {
        Bound plane;
        float slack = 0.0f;               ///< m, distanceOffPlane()
        u32 begin = 0, end = 0;           ///< into corners_
        u32 edgeBegin = 0;                ///< into edges_: of as many edges
        u32 pieceBegin = 0, pieceEnd = 0; ///< into pieces_: convex ones that make up the node; of inner ones that are
                                          ///< not filled, none
    };

    struct Piece
    {
        u32 begin = 0, end = 0; ///< into edges_
    };

    struct Branch
    {
        glm::vec3 low{0.0f}, high{0.0f};
        u32 next = 0;        ///< the branch after this one and all below it
        u32 node = kNoIndex; ///< planar root, where nothing is below
    };

    void addPolygon(u32 node, const Visibility& visibility);
    void addEdges(std::span<const glm::dvec3> corners, const glm::dvec3& normal);
    void build(std::span<u32> roots);
    std::span<const glm::vec3> cornersOf(u32 node) const
    {
        return std::span(corners_).subspan(polygons_[node].begin, polygons_[node].end - polygons_[node].begin);
    }
    Shaft shaftOf(u32 a, u32 b) const;
    void addSides(Shaft& shaft, u32 node, std::span<const glm::vec3> others) const;
    bool reachesInto(u32 node, const Shaft& shaft) const;
    void sift(u32 node, const Shaft& shaft, std::vector<u32>& found) const;

    const NodeTree& tree_;
    float tolerance_;
    glm::dvec3 origin_{0.0};         ///< the scene's middle: floats are relative to it
    std::vector<Polygon> polygons_;  ///< per node, empty for clusters
    std::vector<u32> root_;          ///< planarRoots()
    std::vector<glm::vec3> corners_; ///< of the polygons
    std::vector<Bound> edges_;       ///< inner sides: of polygons, and of pieces that are not the polygon
    std::vector<Piece> pieces_;
    std::vector<Branch> branches_; ///< boxes around the planar roots, parents first
};

} // namespace helio
