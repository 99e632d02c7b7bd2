// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <vector>

#include "city/model/polygon.h"

namespace helio {

/// city/README.md: which invariants a node's area obeys.
enum class NodeKind : u8
{
    Tiling,        ///< planar; its outline's area equals the sum of its children's to 1e-5
    PlanarPartial, ///< planar with openings or gaps: area = children's sum, F = outline's F x coverage
    Cluster        ///< a 3-D group: no link ends there
};

/// An element of the light hierarchy. Node i < patch count is the leaf of patch i; inner nodes follow by rising height
/// (leaf 0, else 1 + the highest child), so a parent always has a larger index and a larger height than its children.
struct Node
{
    u32 parent = kNoIndex;
    u32 childBegin = 0, childCount = 0; ///< into NodeTree::children
    u32 height = 0;
    NodeKind kind = NodeKind::Tiling;
    u32 building = kNoIndex;
    u32 name = 0;             ///< into NodeTree::names
    bool covered = false;     ///< planar, and all its patches are covered: no link and no sky ends there
    double area = 0.0;        ///< m2: a patch's own, else the sum over the children
    double coverage = 1.0;    ///< area / outline area
    glm::dvec3 centroid{0.0}; ///< area weighted
    glm::dvec3 normal{0.0};   ///< unit normal of the lit side; zero for a cluster
    u32 ringBegin = 0,
        ringCount = 0; ///< outline, into NodeTree::rings: a leaf's own rings, or those of the patch that was cut
                       ///< into what is below; of other inner planar nodes their convex hull
};

/// A leaf: coplanar polygons with one normal, one reflectance and one id. It may stand for several pieces of a facade
/// (NodeTreeBuild::pieces): reflectance and emission are then their means, weighted by area.
struct Patch
{
    u32 building = kNoIndex;
    u32 sourceFace = kNoIndex; ///< face of the OBJ it was made from
    u32 surface = kNoIndex;    ///< into NodeTree::surfaceNames: that of its largest part
    /// Stable name: hash of building id, path of child numbers of the first piece's shape, and part of that shape. Two
    /// derivations that differ elsewhere give it the same one.
    u64 key = 0;
    double area = 0.0;        ///< m2
    glm::dvec4 rho{0.0};      ///< reflectance
    glm::dvec4 emission{0.0}; ///< W/m2
    bool covered = false;     ///< a neighbour stands against it: it is drawn and blocks light, but exchanges none
};

/// The hierarchy that exchanges light. Everything is relative to the tile's origin; metres, z up.
struct NodeTree
{
    std::vector<Patch> patches;
    std::vector<Node> nodes;
    std::vector<u32> children;
    std::vector<Ring3> rings; ///< outer rings counter-clockwise seen from the lit side, holes clockwise
    std::vector<u8> ringIsHole;
    std::vector<std::string> names, surfaceNames, buildingIds;

    u32 patchCount() const { return u32(patches.size()); }
    u32 nodeCount() const { return u32(nodes.size()); }
    bool isLeaf(u32 node) const { return node < patches.size(); }
    std::span<const u32> childrenOf(u32 node) const
    {
        return {children.data() + nodes[node].childBegin, nodes[node].childCount};
    }
    std::span<const Ring3> outlineOf(u32 node) const
    {
        return {rings.data() + nodes[node].ringBegin, nodes[node].ringCount};
    }
    /// True for a planar node whose parent is none or a cluster: the top of a planar subtree.
    bool isPlanarRoot(u32 node) const
    {
        return nodes[node].kind != NodeKind::Cluster &&
               (nodes[node].parent == kNoIndex || nodes[nodes[node].parent].kind == NodeKind::Cluster);
    }
};

} // namespace helio
