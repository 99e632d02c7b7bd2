// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/base/types.h"
#include "city/model/polygon.h"

namespace helio {

/// The exchange of light between two polygons.
struct PairFactor
{
    double ab = 0.0;         ///< fraction of what a sends that meets b, without occluders, 0..1
    double ba = 0.0;         ///< the same from b to a: area(a) ab = area(b) ba
    double visibility = 1.0; ///< fraction of that exchange which the occluders let through, 0..1
    double error = 0.0;  ///< estimated error of ab and of ab x visibility as a fraction of ab, for the corners given
    u64 evaluations = 0; ///< of a closed form: along an edge, or to a polygon
};

/// How exact a PairFactor shall be: relative errors that the estimates are to fall below, and the work (edges of
/// occluders against pieces of the sender, over all points) after which the visibility is not refined further. Its
/// error then says so; a view so intricate that ten times the work does not see it through gets error 1.
struct PairAccuracy
{
    double factor = 1e-6;
    double visibility = 3e-5;
    u64 visibilityWork = 20'000'000;
};
constexpr PairAccuracy kProductionAccuracy{};
constexpr PairAccuracy kReferenceAccuracy{1e-12, 3e-8, 200'000'000};

/// Form factors of two planar polygons, convex or not, and how much of their exchange `occluders` (planar polygons that
/// block from both sides, convex or not, overlapping or not) leave. Rings without crossings, at least three corners, in
/// metres, counter-clockwise seen from the lit side; a and b are one-sided. Each counts only with what lies before the
/// other's plane; polygons without area, in one plane or behind each other exchange nothing (0, visibility 1).
/// Occluders that lie in the plane of a or b do not block. All arithmetic is relative to the pair: world coordinates
/// cost no accuracy beyond their own rounding. Symmetric: (b, a) gives the same with ab and ba changed.
///
/// The factor is computed in extended precision: far pairs by Gauss points over the smaller polygon, near ones by the
/// double contour integral, a far larger polygon in a near and four far parts, whichever reaches the accuracy; the
/// visibility by occludedExchange().
PairFactor pairFactor(const Ring3& a, const Ring3& b, std::span<const Ring3> occluders,
                      const PairAccuracy& accuracy = kProductionAccuracy);

} // namespace helio
