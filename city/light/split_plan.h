// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "city/light/visibility.h"

namespace helio {

/// A rectangle in the plane of a patch, cut in two or whole.
struct SplitCell
{
    u32 low = kNoIndex, high = kNoIndex; ///< parts on both sides of the cut, into SplitPlan::cells; kNoIndex: whole
    glm::dvec3 normal{0.0};              ///< of the cut, unit, in the patch's plane; towards `high`
    double offset = 0.0;                 ///< m: the cut lies at dot(normal, p) = offset
};

/// Which patches are cut, and how.
struct SplitPlan
{
    std::vector<u32> root; ///< per patch: its cell, kNoIndex if it stays whole
    std::vector<SplitCell> cells;
    u32 partCount = 0; ///< patches afterwards, if no cut misses its patch
    /// Estimated share of E_indirect (rms over the mean, roughly) that stays unresolved: root of the mean over area and
    /// training suns of the variance of rho E_sun inside the parts, each light over its mean, times the square of size
    /// over distance (at most 1).
    double unresolved = 0.0;
    double unresolvedWhole = 0.0; ///< the same without any cut
};

/// How far to split.
struct SplitOptions
{
    /// Until SplitPlan::unresolved, light inside cells left out, is at most this; 0 = as far as `growth` allows.
    double unresolved = 0.0;
    double growth = 5.0; ///< largest number of patches afterwards / before; 1 = none is split
    u32 jobs = 0;
};

/// Finds where direct light varies inside patches that others see from near: variance of the light of `suns` x (size /
/// distance)^2, the distance too as it is in each place, by four points a cell in 16 cells a patch, two in each of the
/// 64 to 4096 cells of large ones. Where much
/// is left inside the cells of a large patch it gets smaller ones. Patches are halved along a side of their bounding
/// rectangle, the largest gain per added patch first, down to a cell; cuts lie where cells border. `mayCut` has a byte
/// a patch: 0 = it stays whole.
SplitPlan planSplits(const NodeTree& tree, const Visibility& visibility, std::span<const glm::dvec3> suns,
                     std::span<const u8> mayCut, const SplitOptions& options);

} // namespace helio
