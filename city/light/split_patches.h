// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/light/split_plan.h"
#include "city/model/build_nodes.h"

namespace helio {

/// A byte a patch for planSplits: 1 where the patch can be cut. Patches that an asset fills and covered ones cannot.
std::vector<u8> cuttablePatches(const NodeTreeBuild& build);

/// Cuts patches along a plan: each cut patch becomes a planar node over its parts, which keep surface, building and
/// source face, and take their shares of its drawn pieces. Overlays go to the part that their centre is nearest to.
/// Parts get the numbers that follow those of the part before, so patches stay in the order of derivation; keys stay
/// stable. A cut that would leave less than 1e-6 of the patch on a side is left out. `assets` as for buildNodes. Gives
/// the old number of each new patch.
std::vector<u32> splitPatches(NodeTreeBuild& build, std::span<const AssetSummary> assets, const SplitPlan& plan);

} // namespace helio
