// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/light/pair_factor.h"

// What occluders leave of the exchange of two polygons. Internal to city/light.
namespace helio {

/// Rings as pairFactor() takes them, in metres.
struct OccludedPair
{
    const Ring3& receiver; ///< where the points are: the smaller one
    const Ring3& sender;
    std::span<const Ring3> occluders;
    double tolerance; ///< m; what is nearer to a plane lies in it
};

struct OccludedExchange
{
    double visibility = 1.0; ///< 0..1
    double error = 0.0;      ///< of the visibility, estimated, absolute
    u64 points = 0;
};

/// The fraction of `exchange` (A F without occluders, m2, positive) that passes the occluders. From every point of the
/// receiver the sender is cut by the planes through the point and the edges of each occluder, so its visible and its
/// blocked part are exact polygons with exact factors. The receiver is first cut where the view changes in kind (planes
/// of an edge of one and a corner of the other of sender and occluder, and of the occluders themselves: discontinuity
/// meshing, Heckbert 1992) as long as these are few, then where a 7-point rule (Radon 1948) and its four children
/// differ most. The smaller one of visible and blocked part is what is refined: near contact its integrand is tame.
OccludedExchange occludedExchange(const OccludedPair& pair, double exchange, const PairAccuracy& accuracy);

} // namespace helio
