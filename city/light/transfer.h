// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "city/light/form_factor.h"
#include "city/model/node_tree.h"

namespace helio {

/// Unoccluded exchange between planar nodes, with the distance deciding how it is computed.
class Transfer
{
public:
    explicit Transfer(const NodeTree& tree);

    /// A_a F_ab without occlusion, m2, never negative. Far pairs: four points on each that carry the area and its
    /// second moments (for a rectangle the 2 x 2 Gauss points); else the outlines' exchange times both coverages.
    double between(u32 a, u32 b) const;
    /// False if one of the nodes lies wholly behind the other's plane, as far as bounding circles tell.
    bool faceEachOther(u32 a, u32 b) const;
    /// Distance from the centroid to the farthest corner of the outline, m.
    double radius(u32 node) const { return double(extent_[node].radius); }

private:
    struct Extent
    {
        glm::vec3 axis[2]{glm::vec3(0.0f), glm::vec3(0.0f)}; ///< standard deviations along the principal directions, m
        float radius = 0.0f;
    };

    PlanarShape shapeOf(u32 node) const;

    const NodeTree& tree_;
    std::vector<Extent> extent_;
};

} // namespace helio
