// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "city/model/shape_tree.h"

namespace helio {

/// What becomes one patch in a bay of a facade.
enum class PatchMode : u8
{
    Piece, ///< an opening (an asset that fills its tile) is a patch of its own, beside the wall around it
    Bay    ///< wall and opening of a bay are one patch with their mean reflectance
};

/// What the planar levels of the node tree follow. The patches are the same in all.
enum class TreeShape : u8
{
    Grammar, ///< the derivation, with balanced binary nodes inside long sequences
    Free,    ///< the plane alone: every planar root is one balanced guillotine tree over its patches
    Faces    ///< nothing: every patch is a planar root, as the input polygons of Hanrahan, Salzman and Aupperle (1991)
};

/// How the leaves of a derivation become patches, and these the tree. Leaves of given hierarchies (ShapeOp::Group, OBJ
/// faces) and faces of solids are never merged; OBJ faces and tiles with assets are never cut.
struct NodeOptions
{
    PatchMode patch = PatchMode::Piece;
    /// Size of a bay, m: no merge makes a patch's width or height grow beyond it. 0: nothing is merged but slivers.
    double mergeSize = 4.5;
    /// Steep leaves (more than 60 degrees, at least 1 m wide) higher than `mergeSize` are cut into horizontal strips of
    /// equal height, at most this, m: a floor (one value a facade is wrong in deep streets). 0: not cut.
    double stripHeight = 3.5;
    /// Other shapes than the grammar's are there to measure it against.
    TreeShape tree = TreeShape::Grammar;
};

/// Polygons of one leaf in one plane: what is drawn with one albedo.
struct PatchPiece
{
    u32 shape = 0;
    u32 polygonBegin = 0, polygonCount = 0; ///< into PatchCells::polygonRefs
    u32 next = kNoIndex;                    ///< next piece of its cell
    double area = 0.0;                      ///< m2
};

/// Pieces of one plane that exchange light as one: a patch in the making.
struct PatchCell
{
    glm::dvec3 normal{0.0}, point{0.0};
    double area = 0.0; ///< m2
    u32 firstPiece = 0, lastPiece = 0;
    u32 owner = 0;        ///< shape under which all its pieces lie
    u32 openings = 0;     ///< pieces that an asset fills
    u32 ordinal = 0;      ///< among the cells that its first piece's leaf was made into
    bool covered = false; ///< exchanges no light
    bool alive = true;    ///< false: merged into another
    bool sliver = false;
};

/// All pieces and cells of a derivation, in its order.
struct PatchCells
{
    std::vector<PatchPiece> pieces;
    std::vector<PatchCell> cells;
    std::vector<u32> pieceRow;    ///< per shape, and one more: its first piece; the pieces of a leaf are neighbours
    std::vector<u32> polygonRefs; ///< below the number of the derivation's polygons: one of these, else `cut`
    std::vector<Polygon3> cut;    ///< parts of polygons that were cut
    std::vector<u8> isSolid;      ///< per shape: a leaf whose polygons lie in several planes
    u32 degenerateCount = 0;      ///< polygons dropped because their area is below 1e-8 m2
    u32 stripCount = 0;           ///< pieces that came from cutting
    u32 mergedCount = 0;          ///< cells that went into another
    u32 sliverCount = 0;          ///< of these: slivers, merged whatever their material

    const Polygon3& polygon(const ShapeTree& shapes, u32 ref) const
    {
        return ref < shapes.polygons.size() ? shapes.polygons[ref] : cut[ref - shapes.polygons.size()];
    }
};

/// Groups the leaves of a derivation into cells. From the leaves upwards, under each shape up to the face of a solid,
/// coplanar cells that touch become one: walls of one surface, and with PatchMode::Bay one opening with the walls
/// around it, within `mergeSize`; slivers (narrower than 5 cm or less than 0.01 m2) go to a neighbour of any material,
/// that with the longest common side, unless its own side would grow by more than `mergeSize` (or 20 cm, if that is
/// more). A cell is compared with the ten before it in the order of derivation, four times over. Cells touch if their
/// bounding rectangles do, which for cells that are no rectangles may be across a gap. Covered and free cells never
/// mix; what hiddenCells finds is covered too. A cell that takes others keeps its place in the order.
PatchCells makeCells(const ShapeTree& shapes, const NodeOptions& options);

} // namespace helio
