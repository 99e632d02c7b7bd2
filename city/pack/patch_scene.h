// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/format/pack.h"
#include "city/model/node_tree.h"

namespace helio {

/// The node tree that a pack was made from, as far as a pack keeps it: patches (ids, reflectance, emission, surfaces),
/// hierarchy, outlines exact in double (points and rests), names. Not kept: stable keys (0) and which patches a
/// neighbour covers (none is marked; the neighbour's wall stands before them all the same). Areas and normals have the
/// precision of a float.
NodeTree patchTree(const Pack& pack);

/// The outline of a node as a pack keeps it: outer rings counter-clockwise seen from the lit side, holes clockwise.
std::vector<Ring3> outlineRings(const TileView& tile, u32 node);

} // namespace helio
