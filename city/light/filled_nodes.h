// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "city/model/node_tree.h"

namespace helio {

/// Largest number of corners of the outline of a filled node, straight ones left out.
constexpr u32 kFilledCorners = 8;

/// A ring without the corners that lie within a micrometre of the line through their neighbours: what roundings leave
/// of corners of which the next level makes one edge.
Ring3 withoutStraightCorners(const Ring3& ring);

/// Per planar node: how far corners of the patches below it lie off its plane at most, m; 0 for clusters.
std::vector<double> distanceOffPlane(const NodeTree& tree);

/// Per node, 1 if its outline can stand for its patches where something is to block: it is planar, its outline is one
/// convex ring of at most kFilledCorners corners that the patches below fill, all their corners lie within `tolerance`
/// (m) of its plane, and all of them are covered or none is.
std::vector<u8> filledNodes(const NodeTree& tree, double tolerance);

} // namespace helio
