// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <limits>

#include "city/light/link_kernel.h"
#include "city/light/link_rays.h"
#include "city/light/links.h"
#include "city/light/occluders.h"

namespace helio {

/// What a refiner needs to know of a scene; shared by all threads.
struct RefinerScene
{
    const NodeTree& tree;
    const Training& training;
    const Transfer& transfer;
    const LinkRays& rays;
    const Occluders& occluders;
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
    static constexpr double kCoarser = 4.0;  ///< epsilon of the coarse links / that of the links

    explicit LinkRefiner(const RefinerScene& scene) : s_(scene) {}

    /// Appends the links between two planar nodes, neither an ancestor of the other, and all that is below them, in
    /// both directions.
    void refine(u32 a, u32 b);

    std::vector<NodeLink> takeLinks() { return std::move(links_); }
    /// About the links that a larger epsilon would have left, which the refinement passes on its way (pairs too faint
    /// to be looked at are linked in both sets alike): what the two sets differ by tells the error of the finer one.
    std::vector<NodeLink> takeCoarseLinks() { return std::move(coarseLinks_); }
    u64 evaluated() const { return evaluated_; } ///< pairs looked at, those that do not face each other included

private:
    /// What the pairs above a pair say of it.
    struct Sight
    {
        KnownRays rays;      ///< none if they were mixed
        bool listed = false; ///< what may stand between is known: places [begin, end) of between_
        size_t begin = 0, end = 0;
        double size = std::numeric_limits<double>::infinity(); ///< m, of the pair that was last asked for it

        bool isClear() const { return listed && begin == end; }
        u32 known() const { return std::max(rays.open, rays.blocked); }
    };

    /// In which directions a pair still has no link; where it has no coarse one it has no fine one either.
    struct Directions
    {
        u32 fine = 0, coarse = 0;

        Directions only(u32 these) const { return {fine & these, coarse & these}; }
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
        PartMatrix seen;       // rays that met nothing
        PartMatrix asked;      // rays that joined points which face each other
        PartMatrix open;       // visible share that they tell
        double mean = 1.0;     // of `open`, weighted with the exchange
        bool clear = false;    // for sure
        /// Parts are so near that a patch below them may see the other node quite differently from what the rays of the
        /// whole tell: no link ends at a node that is not a patch.
        bool touches = false;
        u32 shot = 0;  // rays
        u32 rays = 0;  // of these, those that joined points which face each other
        u32 known = 0; // `rays`, with those of the pairs above that agree
    };

    /// Whether one direction of a pair may be one link.
    struct Verdict
    {
        LinkError error;
        double visibilityError = 0.0; // weighted squared error for the number of rays
        bool good = false;
        bool goodCoarse = false; // under the coarse links' tolerance
    };

    const NodeParts& partsOf(u32 node);
    void refine(u32 a, u32 b, Directions directions, Sight sight);
    /// The same for a pair that faces each other, with what stands between it.
    void refineSeen(u32 a, u32 b, Directions directions, Sight sight);
    /// Puts the exact exchange where parts are so near that points do not tell it.
    void weighNearParts(Pair& pair) const;
    /// `rays` more rays, spread over the parts by what they exchange; 0: one more for each pair of parts.
    void look(Pair& pair, u32 rays, const Sight& sight) const;
    /// What the pair's rays say of its parts; where all of them missed, what those above say.
    static void weighRays(Pair& pair, const KnownRays& above);
    /// What the pair's rays and those of the pairs above say together.
    static Sight sightOf(Pair& pair, const Sight& above);
    Verdict judge(const Pair& pair, bool toA) const;
    bool splitsReceiver(const Verdict& verdict, bool touches, u32 receiver, u32 sender) const;
    /// Weighted squared irradiance of the receiver: the error if nothing were known of the sender.
    double strength(u32 receiver, u32 sender, double exchange) const;
    /// Whether a link of this exchange is accurate enough whatever happens inside its nodes.
    bool isFaint(u32 receiver, u32 sender, double exchange) const;
    u32 faintDirections(u32 a, u32 b, double distance, double exchange) const;
    bool isSurelyTooCoarse(const Pair& pair, u32 directions, Sight sight) const;
    LinkRays::Between betweenOf(const Sight& sight) const;
    /// A link of one direction, into the sets that `directions` leaves open.
    void link(u32 direction, Directions directions, const NodeLink& link);
    void linkWhole(u32 a, u32 b, double transfer, Directions directions, Sight sight);
    /// A pair that cannot be judged from its parts: one link if that is small enough, else the larger node is opened.
    void linkOrOpen(u32 a, u32 b, Directions directions, Sight sight);
    /// The links that the verdicts allow; what stays open comes back.
    Directions linkGood(const Pair& pair, const Verdict& toA, const Verdict& toB, Directions directions);
    /// Goes on with the children of a in the directions `openA`, with those of b in the directions `openB`.
    void split(u32 a, u32 b, Directions openA, Directions openB, Sight sight);

    const RefinerScene& s_;
    std::vector<NodeLink> links_, coarseLinks_;
    NodeParts leaf_;           ///< of the pair at hand: two leaves are not judged by parts
    std::vector<u32> between_; ///< a stack: what may stand between the pairs at hand
    u64 evaluated_ = 0;
};

} // namespace helio
