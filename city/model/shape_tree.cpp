// SPDX-License-Identifier: Apache-2.0
#include "city/model/shape_tree.h"

#include <algorithm>

#include "city/base/check.h"

namespace helio {

std::string treeKey(const ShapeTree& tree, u32 shape)
{
    HELIO_CHECK(shape < tree.shapes.size(), shape, " of ", tree.shapes.size());
    std::vector<u32> path;
    for (u32 at = shape; tree.shapes[at].parent != kNoIndex; at = tree.shapes[at].parent)
        path.push_back(tree.shapes[at].child);
    std::string key;
    for (auto number = path.rbegin(); number != path.rend(); ++number) {
        if (!key.empty()) key += '/';
        key += std::to_string(*number);
    }
    return key;
}

} // namespace helio
