// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "city/light/occluders.h"

namespace helio {

/// What became of a ray between two nodes.
enum class RayFate : u8
{
    Missed, ///< its ends do not face each other: it says nothing
    Open,
    Blocked
};

/// Rays between larger nodes that say something of a pair: all of them were open, or all blocked.
struct KnownRays
{
    u32 open = 0, blocked = 0; ///< one of them is 0
};

/// The visible share of an exchange, and the rays that tell it.
struct OpenShare
{
    double open = 0.0; ///< 0..1
    u32 rays = 0;      ///< that joined points which face each other; 0: nothing is known
};

/// How much of one node another one sees, by rays between random points of both. Safe to use from several threads.
class LinkRays
{
public:
    LinkRays(const NodeTree& tree, const Visibility& visibility, const Occluders& occluders, u64 seed);

    static constexpr u32 kMostRays = 64; ///< of one call of shoot

    /// What may stand in the way of rays: these nodes, or the whole scene.
    struct Between
    {
        std::span<const u32> nodes;
        bool known = false;
    };

    /// Rays between pairs of nodes of two planes: ray k joins a random point of from[k] and one of to[k]. `first`
    /// numbers the rays of this pair.
    void shoot(std::span<const u32> from, std::span<const u32> to, u32 first, Between between,
               std::span<RayFate> fate) const;

    /// Visible share of the exchange of two whole nodes, `transfer` m2 without occlusion. Far ones: points of both,
    /// weighted with cos cos / r^2; near ones (form factor above 0.1): directions by the cosine from the smaller node.
    /// Begins with `rays` rays and takes more, up to 512, until one has landed and strength x (variance of the mean) is
    /// at most 1. Earlier rays of `known` count with them where all of both agree.
    OpenShare openShare(u32 a, u32 b, double transfer, u32 rays, double strength, const KnownRays& known,
                        Between between) const;

private:
    struct Tally
    {
        double open = 0.0, weight = 0.0;
        u32 rays = 0, next = 0;
    };

    /// A node that its outline's parallelogram fills: points need no way down to the patches.
    struct Plate
    {
        glm::dvec3 corner{0.0}, side{0.0}, up{0.0}; ///< m; no sides: not such a node
    };

    glm::dvec3 pointIn(u32 node, double u, double v) const;
    void shootFar(Tally& tally, u32 a, u32 b, const std::array<u32, 4>& shift, u32 rays, Between between) const;
    void shootNear(Tally& tally, u32 small, u32 large, const std::array<u32, 4>& shift, u32 rays,
                   Between between) const;
    void block(std::span<const glm::dvec3> from, const glm::dvec3& fromNormal, std::span<const glm::dvec3> to,
               const glm::dvec3& toNormal, Between between, std::span<bool> blocked) const;

    const NodeTree& tree_;
    const Visibility& visibility_;
    const Occluders& occluders_;
    u64 seed_;
    std::vector<Plate> plates_; ///< per node
};

} // namespace helio
