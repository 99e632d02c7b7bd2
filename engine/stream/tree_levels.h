// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "city/base/result.h"
#include "city/base/types.h"
#include "shaders/shared/records.h"
#include "shaders/shared/solve.h"

namespace helio {

/// Inner nodes first .. first + count - 1, none of which is an ancestor of another.
struct TreeLevel
{
    u32 first = 0, count = 0;
    bool operator==(const TreeLevel&) const = default;
};

/// The tree as the pull reads it.
struct TreeLevels
{
    std::vector<TreeLevel> levels;          ///< upwards; level 0 is the parents of patches alone
    std::vector<u32> childRows;             ///< inner nodes + 1 offsets into children
    std::vector<gpu::ChildRecord> children; ///< in the pack's order; offsets 0 with constant senders
    std::vector<glm::vec4> turns;           ///< parallel to them: xx, xy, yx, yy; empty: constant senders
};

/// Orders the tree by height (leaf 0, else 1 + the highest child). The nodes must be patches first, then inner nodes by
/// rising height; error: they are not, or a child's parent is not the node that lists it. childSlopes: one an entry of
/// children, or none.
Result<TreeLevels> buildTreeLevels(std::span<const gpu::NodeRecord> nodes, std::span<const u32> children,
                                   u32 patchCount, std::span<const gpu::ChildSlopeRecord> childSlopes = {});

} // namespace helio
