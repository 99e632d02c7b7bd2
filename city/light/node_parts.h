// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <vector>

#include "city/base/lanes.h"
#include "city/light/linear_senders.h"
#include "city/light/training.h"
#include "city/light/transfer.h"

namespace helio {

/// The few descendants that a planar node is judged by, side by side for vector code, and what a link from the node
/// would get wrong about them. Unused places have area 0.
struct NodeParts
{
    static constexpr u32 kMost = kLanes;
    using Row = Row8;

    u32 count = 0;
    std::array<u32, kMost> node{}; ///< they make up the node; the node itself if it is a leaf or has too many children
    Row x{}, y{}, z{};             ///< m: their centroids, relative to the node's
    Row area{}, radius{};          ///< m2, m
    Row slopeX{}, slopeY{};        ///< of their centroids, in the node's slope coordinates; 0 for constant senders
    Row inside{};                  ///< mean over the training lights of the variance of radiosity inside the part
    Row errorWeight{};             ///< 1/m4: what the square of an exchanged power that is wrong there counts
    std::array<Row, kMost> deviation{}; ///< mean over the lights of d_i d_j, d_i = radiosity of part i - what the
                                        ///< node's mean and slope say of it
};

/// The parts of every planar node with children, by node number less the number of patches. Parts are found by opening
/// the largest one again and again while they stay at most NodeParts::kMost. `frames` = slopeFrames() of the tree,
/// empty for constant senders; `weight` = what a squared error of irradiance on a square metre of each node counts,
/// 1/m2.
std::vector<NodeParts> nodeParts(const NodeTree& tree, const Training& training, const Transfer& transfer,
                                 std::span<const SlopeFrame> frames, std::span<const double> weight, u32 jobs);

/// Puts a leaf, as its only part, into parts that are empty or hold another leaf.
void putLeaf(const NodeTree& tree, const Transfer& transfer, std::span<const double> weight, u32 leaf,
             NodeParts& parts);

} // namespace helio
