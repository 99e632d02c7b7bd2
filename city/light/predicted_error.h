// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "city/light/light_tables.h"
#include "city/light/visibility.h"

namespace helio {

/// What splitting left of the patches' insides.
struct SplitRecord
{
    std::vector<u32> wholeOf;     ///< per patch: the number of the patch that it is a part of
    double unresolved = 0.0;      ///< SplitPlan::unresolved
    double unresolvedWhole = 0.0; ///< SplitPlan::unresolvedWhole
};

/// The error of E_indirect that a bake expects of itself: area-weighted rms over the patches before splitting, as a
/// share of the mean.
struct PredictedError
{
    double total = 0.0;   ///< under suns of 16, 35 and 60 degrees, rms over them
    double sky = 0.0;     ///< the same under a uniform sky
    double links = 0.0;   ///< of `total`: what fewer links would change
    double patches = 0.0; ///< and what light inside patches changes
    /// The expected error of each patch alone, rms over the suns, as a share of the mean E_indirect of all patches
    /// (covered ones have none, and no error). Parts of one patch share its error: what it errs by before it is cut.
    /// The area mean of the square is total^2. Half of the square is the patch's own, half what all patches err by, in
    /// proportion to the patch's light: two solutions that agree on one patch by chance do not make it exact.
    std::vector<float> ofPatch;
};

/// A two-level estimate that needs no reference. Links: the difference to the solution over `coarse`, the links of a
/// fourfold epsilon (LinkRefiner::kCoarser), which errs about 2.2 times as much. Patches: the difference to a solution
/// in which the parts of a patch send alike, scaled by what the plan says of the light that is still inside the patches
/// against that which the cuts resolved; where the cuts resolved less than is left, half of SplitRecord::unresolved.
/// `direct`: four lights a patch, first-hand irradiance in any unit; channels 0 to 2 the suns, 3 the sky.
PredictedError predictError(const NodeTree& tree, const LinkTable& links, const LinkTable& coarse,
                            std::span<const glm::dvec4> direct, const SplitRecord& split, u32 jobs);

/// First-hand irradiance of three training suns of 16, 35 and 60 degrees, and the sky view of each patch.
std::vector<glm::dvec4> predictionLights(const NodeTree& tree, const Visibility& visibility, std::span<const float> sky,
                                         u32 jobs);

} // namespace helio
