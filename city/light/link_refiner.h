// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "city/light/link_kernel.h"
#include "city/light/link_rays.h"
#include "city/light/links.h"

namespace helio {

/// What a refiner needs to know of a scene; shared by all threads.
struct RefinerScene
{
    const NodeTree& tree;
    const Training& training;
    const Transfer& transfer;
    const LinkRays& rays;
    std::span<const NodeParts> parts; ///< nodeParts()
    std::span<const double> weight;   ///< per node, 1/m2: what a squared error of irradiance on a square metre counts
    double tolerance = 0.0;           ///< largest weighted squared error of a link (radiosity: area mean 1)
    u32 raysPerPart = 2;              ///< of a pair of parts, where a link is seen in part
    bool leafReceivers = false;       ///< LinkOptions::leafReceivers
};

/// Refines pairs of nodes until each is accurate enough to be one link. One object serves one thread.
class LinkRefiner
{
public:
    static constexpr u32 kToA = 1, kToB = 2; ///< which of two nodes receives

    explicit LinkRefiner(const RefinerScene& scene) : s_(scene) {}

    /// Appends the links between two planar nodes, neither an ancestor of the other, and all that is below them, in
    /// both directions.
    void refine(u32 a, u32 b) { refine(a, b, kToA | kToB, Sight{}); }

    std::vector<NodeLink> takeLinks() { return std::move(links_); }
    u64 evaluated() const { return evaluated_; }

private:
    /// What the pairs above a pair say of it: rays that were all open, or all blocked; none if they were mixed.
    struct Sight
    {
        u32 open = 0, blocked = 0;
    };

    /// A pair of nodes at hand.
    struct Pair
    {
        u32 a = 0, b = 0;
        const NodeParts* partsA = nullptr;
        const NodeParts* partsB = nullptr;
        float distance = 0.0f; // m, of the centroids
        float total = 0.0f;    // m2, of `exchange`
        PartMatrix exchange;   // m2, without occlusion, [part of a][part of b]
        PartMatrix seen{};     // rays that met nothing
        PartMatrix asked{};    // rays
        PartMatrix open;       // visible share that they tell
        double mean = 1.0;     // of `open`, weighted with the exchange
        /// Parts are so near that a patch below them may see the other node quite differently from what the rays of the
        /// whole tell: no link ends at a node that is not a patch.
        bool touches = false;
        u32 rays = 0;
        u32 knownRays = 0; // with those of the pairs above that agree
    };

    /// Whether one direction of a pair may be one link.
    struct Verdict
    {
        LinkError error;
        double visibilityError = 0.0; // weighted squared error for the number of rays
        bool good = false;
    };

    const NodeParts& partsOf(u32 node, NodeParts& leaf) const;
    void refine(u32 a, u32 b, u32 directions, Sight sight);
    /// Puts the exact exchange where parts are so near that points do not tell it.
    void weighNearParts(Pair& pair) const;
    /// `rays` more rays, spread over the parts by what they exchange; 0: one more for each pair of parts.
    void look(Pair& pair, u32 rays) const;
    static void weighRays(Pair& pair);
    Verdict judge(const Pair& pair, bool toA) const;
    bool splitsReceiver(const Verdict& verdict, bool touches, u32 receiver, u32 sender) const;
    /// Weighted squared irradiance of the receiver: the error if nothing were known of the sender.
    double strength(u32 receiver, u32 sender, double exchange) const;
    u32 faintDirections(const Pair& pair) const;
    bool isSurelyTooCoarse(const Pair& pair, u32 directions, Sight sight) const;
    void link(u32 receiver, u32 sender, double exchange, double momentX, double momentY);
    void linkWhole(u32 a, u32 b, double transfer, u32 directions, Sight sight);
    /// Goes on with the children of a in the directions `openA`, with those of b in the directions `openB`.
    void split(u32 a, u32 b, u32 openA, u32 openB, Sight sight);

    const RefinerScene& s_;
    std::vector<NodeLink> links_;
    u64 evaluated_ = 0;
};

} // namespace helio
