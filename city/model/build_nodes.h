// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/model/node_tree.h"
#include "city/model/patch_cells.h"
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
    u32 piece = kNoIndex;             ///< the piece that it fills; kNoIndex: an overlay
    u32 trimBegin = 0, trimCount = 0; ///< into NodeTreeBuild::trimPlanes
};

/// A part of a patch that is drawn with one albedo.
struct DrawnPiece
{
    u32 patch = 0;
    u32 ringBegin = 0, ringCount = 0; ///< into NodeTree::rings: outer rings, each followed by its holes
    u32 asset = kNoIndex;             ///< asset that is drawn in its place; kNoIndex: its polygons are drawn
    glm::dvec4 rho{0.0};              ///< its own reflectance
};

/// The light hierarchy of a derivation, and what is drawn.
struct NodeTreeBuild
{
    NodeTree tree;
    std::vector<DrawnPiece> pieces;       ///< by rising patch; every patch has at least one
    std::vector<AssetInstance> instances; ///< sorted by asset, then in order of derivation
    std::vector<glm::dvec4> trimPlanes;   ///< an instance shows only where n.p + d >= 0 for all of its own
    u32 degenerateCount = 0;              ///< polygons dropped because their area is below 1e-8 m2
    u32 orphanOverlayCount = 0;           ///< overlays without any patch of their building to stand on: not drawn
    u32 overlapCount = 0;                 ///< planar nodes whose children overlap: more area than their outline's hull
    u32 stripCount = 0;                   ///< parts of leaves that were cut (NodeOptions::stripHeight)
    u32 mergedCount = 0;                  ///< leaves, or parts of them, that went into another's patch
    u32 sliverCount = 0;                  ///< of these: slivers
    u32 coveredPatchCount = 0;            ///< patches that exchange no light
    double coveredArea = 0.0;             ///< m2 of these
    /// Area ledger: largest |coverage - 1| over tiling nodes and largest coverage - 1 over the other planar nodes with
    /// children. Above 1e-5 only where children overlap; an overlap smaller than the gaps beside it does not show.
    double areaDefect = 0.0;
};

/// "grammar", "free" or "faces".
const char* treeShapeName(TreeShape shape);

/// Builds the node tree from a derivation (city/README.md). Leaves become patches (NodeOptions); coplanar patches under
/// one shape form planar nodes, covered and free ones apart; long sequences get balanced binary nodes, and a face whose
/// rules recurse is rebuilt as one balanced tree, so that depth stays logarithmic; everything else, protruding solids
/// included, is a cluster (TreeShape::Grammar; see there for the others). `assets` holds one entry an asset of the
/// derivation; its reflectance replaces that of the tile which the asset fills. An overlay takes the id of the patch
/// behind it. The mean reflectance and emission of a patch are weighted by area, so that totals of area, rho x area and
/// emission x area do not depend on the options. O(n log n) in the number of leaves.
NodeTreeBuild buildNodes(const ShapeTree& shapes, std::span<const AssetSummary> assets,
                         const NodeOptions& options = {});

/// The same, for a derivation that is not needed any more: its polygons become the outlines, which saves a copy.
NodeTreeBuild buildNodes(ShapeTree&& shapes, std::span<const AssetSummary> assets, const NodeOptions& options = {});

} // namespace helio
