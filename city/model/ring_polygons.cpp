// SPDX-License-Identifier: Apache-2.0
#include "city/model/ring_polygons.h"

namespace helio {

std::vector<Polygon3> ringPolygons(const NodeTree& tree, u32 ringBegin, u32 ringCount)
{
    std::vector<Polygon3> polygons;
    for (u32 r = ringBegin; r < ringBegin + ringCount; ++r) {
        if (tree.ringIsHole[r] == 0 || polygons.empty())
            polygons.push_back({tree.rings[r], {}});
        else
            polygons.back().holes.push_back(tree.rings[r]);
    }
    return polygons;
}

} // namespace helio
