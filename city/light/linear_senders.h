// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <vector>

#include "city/model/node_tree.h"
#include "shaders/shared/records.h"

namespace helio {

/// Slope coordinates of a planar inner node, X(p) = (x . (p - centroid), y . (p - centroid)): dimensionless, chosen so
/// that over the centroids of the patches below the node, weighted by area, X has mean 0, variance 1 and no
/// correlation. The best linear fit of the radiosity over the node is then B(p) = mean + slope . X(p) with slope = the
/// area mean of X B, which needs no division and is pulled up like the mean itself. A direction in which the patches do
/// not differ has a zero vector, as have leaves and clusters: their slope is 0.
struct SlopeFrame
{
    glm::dvec3 x{0.0}, y{0.0}; ///< 1/m

    glm::dvec2 at(const glm::dvec3& fromCentroid) const
    {
        return {glm::dot(x, fromCentroid), glm::dot(y, fromCentroid)};
    }
};

/// The slope coordinates of every node, O(nodes).
std::vector<SlopeFrame> slopeFrames(const NodeTree& tree);

/// What each child adds to its parent's slope, parallel to NodeTree::children:
/// slope_parent = sum over children c of A_c / A_parent (offset_c B_c + T_c slope_c), T = (xx xy; yx yy).
std::vector<gpu::ChildSlopeRecord> childSlopes(const NodeTree& tree, const std::vector<SlopeFrame>& frames);

} // namespace helio
