// SPDX-License-Identifier: Apache-2.0
#include "engine/stream/tree_levels.h"

#include <algorithm>

namespace helio {

Result<TreeLevels> buildTreeLevels(std::span<const gpu::NodeRecord> nodes, std::span<const u32> children,
                                   u32 patchCount, std::span<const gpu::ChildSlopeRecord> childSlopes)
{
    HELIO_CHECK(childSlopes.empty() || childSlopes.size() == children.size(), childSlopes.size(), " child slopes for ",
                children.size(), " children");
    HELIO_CHECK(patchCount <= nodes.size(), patchCount, " patches in ", nodes.size(), " nodes");
    TreeLevels tree;
    tree.childRows.push_back(0);

    std::vector<u32> height(nodes.size(), 0);
    for (u32 i = patchCount; i < nodes.size(); ++i) {
        const gpu::NodeRecord& node = nodes[i];
        HELIO_CHECK(u64(node.childBegin) + node.childCount <= children.size(), "node ", i, " has children ",
                    node.childBegin, "+", node.childCount, " of ", children.size());
        for (u32 k = 0; k < node.childCount; ++k) {
            const u32 child = children[node.childBegin + k];
            if (child >= i)
                return Error{concat("node ", i, " has child ", child, ": children must come before parents")};
            if (nodes[child].parent != i)
                return Error{concat("node ", child, " is a child of node ", i, " but names ", nodes[child].parent,
                                    " as its parent")};
            height[i] = std::max(height[i], height[child] + 1);
            gpu::ChildRecord record{};
            record.node = child;
            if (node.area > 0.0f) record.weight = float(double(nodes[child].area) / double(node.area));
            if (!childSlopes.empty()) {
                const gpu::ChildSlopeRecord& slope = childSlopes[node.childBegin + k];
                record.offsetX = slope.offsetX;
                record.offsetY = slope.offsetY;
                tree.turns.emplace_back(slope.xx, slope.xy, slope.yx, slope.yy);
            }
            tree.children.push_back(record);
        }
        tree.childRows.push_back(u32(tree.children.size()));
        if (i > patchCount && height[i] < height[i - 1])
            return Error{concat("node ", i, " of height ", height[i], " follows one of height ", height[i - 1],
                                ": inner nodes must rise in height")};
        if (i == patchCount || height[i] != height[i - 1]) tree.levels.push_back({i, 0});
        ++tree.levels.back().count;
    }
    return tree;
}

} // namespace helio
