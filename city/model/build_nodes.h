// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <span>

#include "city/model/node_tree.h"
#include "city/model/shape_tree.h"

namespace helio {

/// What the node tree needs to know of an asset.
struct AssetSummary
{
    glm::dvec4 rho{0.5};       ///< effective reflectance, r, g, b, solar
    glm::dvec3 boxCentre{0.0}; ///< of its bounding box, asset units
};

/// An asset instance to draw, with the patch whose light it takes.
struct AssetInstance
{
    u32 asset = 0; ///< into ShapeTree::assets
    u32 patch = 0;
    glm::dmat4x3 worldFromAsset{1.0};
};

/// The light hierarchy of a derivation, and what is drawn beside the patches' own polygons.
struct NodeTreeBuild
{
    NodeTree tree;
    std::vector<AssetInstance> instances; ///< sorted by asset, then in order of derivation
    u32 degenerateCount = 0;              ///< polygons dropped because their area is below 1e-8 m2
    u32 orphanOverlayCount = 0;           ///< overlays without any patch of their building to stand on: not drawn
    u32 overlapCount = 0;                 ///< planar nodes whose children overlap: more area than their outline's hull
    /// Area ledger: largest |coverage - 1| over tiling nodes and largest coverage - 1 over the other planar nodes with
    /// children. Above 1e-5 only where children overlap; an overlap smaller than the gaps beside it does not show.
    double areaDefect = 0.0;
};

/// Builds the node tree from a derivation (city/README.md): coplanar leaves under one shape form planar nodes, long
/// sequences get balanced binary nodes, everything else is a cluster. `assets` holds one entry an asset of the
/// derivation; its reflectance replaces that of a patch which the asset fills. An overlay takes the id of the patch
/// behind it.
NodeTreeBuild buildNodes(const ShapeTree& shapes, std::span<const AssetSummary> assets);

} // namespace helio
