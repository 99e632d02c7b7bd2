// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "city/light/links.h"
#include "city/light/transfer.h"

namespace helio {

/// Refines pairs of nodes until each is accurate enough to be one link. One object serves one thread.
class LinkRefiner
{
public:
    struct Limits
    {
        double tolerance; ///< largest weighted squared error of a link (radiosity scaled to an area mean of 1)
        u32 raysPerPart;
        u64 seed;
    };

    LinkRefiner(const NodeTree& tree, const Visibility& visibility, const Training& training, const Transfer& transfer,
                std::span<const double> weight, const Limits& limits)
        : tree_(tree), visibility_(visibility), training_(training), transfer_(transfer), weight_(weight),
          limits_(limits)
    {
    }

    /// Appends the links between two planar nodes, neither an ancestor of the other, and all that is below them.
    void refine(u32 a, u32 b);

    std::vector<NodePair> takePairs() { return std::move(pairs_); }
    u64 evaluated() const { return evaluated_; }

private:
    static constexpr u32 kMaxParts = 4;

    /// Descendants that make up a node, the node itself if it is a leaf.
    struct Parts
    {
        std::array<u32, kMaxParts> node;
        u32 count;
    };

    /// Exchange and visibility between one part of a and one of b.
    struct Cell
    {
        double transfer = 0.0;           // m2, without occlusion
        double open = 0.0, weight = 0.0; // rays so far, weighted with their kernel
        u32 rays = 0;                    // that had a weight
        u32 next = 0;                    // of the sample sequence
    };

    struct Estimate
    {
        double exchange = 0.0; // m2, with visibility
        double errorA = 0.0;   // weighted squared error that splitting a would remove
        double errorB = 0.0;
        double visibilityError = 0.0; // the same for the number of rays
    };

    Parts partsOf(u32 node) const;
    glm::dvec3 pointIn(u32 node, double u, double v) const;
    void shoot(Cell& cell, u32 a, u32 b, u32 rays) const;
    void shootNear(Cell& cell, u32 small, u32 large, const std::array<u32, 4>& shift, u32 rays) const;
    Estimate estimate(const Parts& a, const Parts& b, u32 nodeA, u32 nodeB) const;
    /// Squared error of the irradiance of one side for a constant sender: parts `mine` receive, `theirs` send.
    void addErrors(const Parts& mine, const Parts& theirs, u32 receiver, u32 sender, bool mineIsA, double meanOpen,
                   double& senderError, double& receiverError) const;
    double power(u32 a, u32 b, double exchange) const;
    /// True if a pair that is not blocked as a whole exchanges so much, so near, that its parts need not be looked at.
    bool isSurelyTooCoarse(u32 a, u32 b, double transfer) const;
    void link(u32 a, u32 b, double exchange);
    void split(u32 a, u32 b, bool splitA);

    const NodeTree& tree_;
    const Visibility& visibility_;
    const Training& training_;
    const Transfer& transfer_;
    std::span<const double> weight_; // per node, 1/m2: what a squared error there counts
    Limits limits_;
    std::vector<NodePair> pairs_;
    u64 evaluated_ = 0;
    std::array<Cell, kMaxParts * kMaxParts> cells_; // of the pair at hand, [part of a * kMaxParts + part of b]
};

} // namespace helio
