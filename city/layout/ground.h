// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/model/footprint.h"
#include "city/model/shape_tree.h"

namespace helio {

/// What the ground is beyond everything that a layout says of it.
inline constexpr const char* kOuterGround = "street";

struct GroundOptions
{
    double cellSize = 4.0; ///< m, > 0: largest side of a piece; doubled (with a note) until there are at most maxCells
    double margin = 30.0;  ///< m, >= 0: ground around the bounding box of the footprints
    double pavementWidth = 3.0; ///< m, >= 0: strip along facades outside of courts
    u32 maxCells = 1000000;
};

/// Fills Layout::ground with everything that no footprint covers: the bounding box with its margin, cut along a grid,
/// each piece of one kind at z = 0 facing up. Kinds: those of the areas that the layout already holds (lawns, say; they
/// are cut up too), "court" where buildings enclose it, "pavement" along the other facades, kOuterGround for the rest.
/// Pieces tile the ground on a grid of 0.1 mm; pieces below 0.001 m2 are dropped. GroundArea::block numbers squares of
/// 16 x 16 cells. A layout without footprints gets no ground.
void addGround(Layout& layout, const GroundOptions& options = {});

/// Appends the ground to a derivation, building kNoIndex: Root "Ground" > Group "Block" > one leaf a piece, named by
/// its kind, with groundSurface(kind). buildNodes makes the balanced planar tree of each block from it.
void appendGround(ShapeTree& tree, const Layout& layout);

/// Reflectance of a kind, which is the name of a material (findMaterial). No emission.
Surface groundSurface(const std::string& kind);

} // namespace helio
