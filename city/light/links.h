// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <span>
#include <utility>

#include "city/light/light_tables.h"
#include "city/light/linear_senders.h"
#include "city/light/training.h"
#include "city/light/visibility.h"

namespace helio {

/// A link in one direction.
struct NodeLink
{
    u32 receiver = 0, sender = 0;
    float factor = 0.0f;    ///< F(receiver to sender) x visibility, 0..1
    glm::vec2 moment{0.0f}; ///< of the factor, in the sender's slope coordinates; 0 for constant senders
};

struct LinkOptions
{
    double epsilon = 0.0;       ///< see LightOptions::formFactorEpsilon; > 0
    u32 raysPerLink = 2;        ///< visibility rays of a pair of parts where a link is seen in part, > 0
    bool leafReceivers = false; ///< links end at patches alone: rows without push-down
    u32 jobs = 0;
    u64 seed = 1;
    std::function<void(double)> progress{};
};

struct LinkBuild
{
    std::vector<NodeLink> links; ///< in the order of the root pairs
    /// Those that LinkRefiner::kCoarser times the epsilon would have left, for predictError.
    std::vector<NodeLink> coarse;
    u64 evaluated = 0;           ///< node pairs looked at
};

/// The hierarchical links of this project (city/README.md, "Decisions"), over candidate pairs of planar roots. A
/// receiver is linked to a sender when the squared error that the link would leave, estimated from the exchanges of
/// their parts under the training lights, is at most epsilon^2 x the mean patch area; else the node with the larger
/// share in that error, weighed with its size, is refined, or the other one if it is a leaf; two leaves are always
/// linked. Both directions of a pair share its rays, but each is refined on its own: linear senders may stay large
/// where receivers, which get one value, may not. `frames` = slopeFrames() of the tree, empty for constant senders.
LinkBuild buildLinks(const NodeTree& tree, const Visibility& visibility, const Training& training,
                     std::span<const SlopeFrame> frames, std::span<const std::pair<u32, u32>> rootPairs,
                     const LinkOptions& options);

/// Rows by receiver over all nodes; `slopes` = childSlopes() of the tree for linear senders, else empty: the moments
/// are then left out. Aborts above 2^32 - 2 links (rows are counted in 32 bits).
LinkTable linkTable(const NodeTree& tree, std::span<const NodeLink> links, u32 jobs,
                    std::vector<gpu::ChildSlopeRecord> slopes = {});

} // namespace helio
