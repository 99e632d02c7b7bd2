// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <vector>

#include "city/light/light_tables.h"
#include "city/model/node_tree.h"

namespace helio {

/// Radiosity of every node, W/m2, four channels; with linear senders its two slopes too (empty for constant ones).
struct NodeLight
{
    std::vector<glm::dvec4> mean, slopeX, slopeY;
};

/// Room for the light of all nodes, dark.
NodeLight darkLight(const NodeTree& tree, const LinkTable& links);

/// Flux comes up from the patches' means, and with it the slopes: B_parent = sum A_c B_c / A_parent.
void pullUp(const NodeTree& tree, const LinkTable& links, NodeLight& light);

/// Irradiance per node, W/m2: gathered over the links of every node, then handed down, so that afterwards every patch
/// holds all that reaches it and its ancestors. The result does not depend on `jobs` (0 = all cores).
void gatherLight(const NodeTree& tree, const LinkTable& links, const NodeLight& light, u32 jobs,
                 std::vector<glm::dvec4>& irradiance);

} // namespace helio
