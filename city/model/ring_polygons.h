// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/model/node_tree.h"

namespace helio {

/// Rings ringBegin .. ringBegin + ringCount - 1 of a tree as polygons: each outer ring with the holes that follow it.
std::vector<Polygon3> ringPolygons(const NodeTree& tree, u32 ringBegin, u32 ringCount);

} // namespace helio
