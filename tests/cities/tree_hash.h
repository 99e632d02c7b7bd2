// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/model/build_nodes.h"

namespace helio {

/// Hash of a derivation: shapes with their paths, surfaces and assets, and every corner, to the last bit.
u64 hashOf(const ShapeTree& shapes);

/// Hash of a light hierarchy: patches with keys and light, nodes, outlines and instances, to the last bit.
u64 hashOf(const NodeTreeBuild& build);

} // namespace helio
