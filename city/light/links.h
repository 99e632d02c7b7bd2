// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <span>
#include <utility>

#include "city/light/light_tables.h"
#include "city/light/training.h"
#include "city/light/visibility.h"

namespace helio {

/// One exchange between two nodes; it makes a link each way: F_ab = exchange / A_a, F_ba = exchange / A_b.
struct NodePair
{
    u32 a = 0, b = 0;
    float exchange = 0.0f; ///< A_a F_ab V, m2
};

/// Two links whose factors are estimated on their own, so that they need not agree in what they exchange.
struct FactorPair
{
    u32 a = 0, b = 0;
    float fab = 0.0f, fba = 0.0f; ///< share of what leaves a that reaches b, and the other way; 0..1
};

struct LinkOptions
{
    double epsilon = 0.0; ///< see LightOptions::formFactorEpsilon; > 0
    u32 raysPerLink = 4;  ///< visibility rays of a pair of parts, > 0
    u32 jobs = 0;
    u64 seed = 1;
    std::function<void(double)> progress{};
};

struct LinkBuild
{
    std::vector<NodePair> pairs; ///< in the order of the root pairs
    u64 evaluated = 0;           ///< node pairs looked at
};

/// The hierarchical links of this project (city/README.md, "Decisions"), over candidate pairs of planar roots. A pair
/// is linked when the squared error that a constant link would leave, estimated from the exchanges of its parts under
/// the training lights and summed over both directions, is at most epsilon^2 x the mean patch area; else the node with
/// the larger share in that error, weighed with its size, is refined, or the other one if it is a leaf; two leaves are
/// always linked.
LinkBuild buildLinks(const NodeTree& tree, const Visibility& visibility, const Training& training,
                     std::span<const std::pair<u32, u32>> rootPairs, const LinkOptions& options);

/// Rows by receiver over all nodes, both directions of every pair. Aborts above 2^31 - 2 pairs (rows are counted in 32
/// bits).
LinkTable linkTable(const NodeTree& tree, std::span<const NodePair> pairs, u32 jobs);
LinkTable linkTable(const NodeTree& tree, std::span<const FactorPair> pairs, u32 jobs);

} // namespace helio
