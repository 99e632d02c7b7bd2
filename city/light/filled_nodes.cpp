// SPDX-License-Identifier: Apache-2.0
#include "city/light/filled_nodes.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace helio {
namespace {

bool isConvex(const Ring3& ring, const glm::dvec3& normal, double tolerance)
{
    for (size_t k = 0; k < ring.size(); ++k) {
        const glm::dvec3 edge = ring[k + 1 < ring.size() ? k + 1 : 0] - ring[k];
        const double length = glm::length(edge);
        if (length == 0.0) continue;
        const glm::dvec3 outwards = glm::cross(edge / length, normal);
        for (const glm::dvec3& corner : ring)
            if (glm::dot(outwards, corner - ring[k]) > tolerance) return false;
    }
    return true;
}

} // namespace

std::vector<u8> filledNodes(const NodeTree& tree, double tolerance)
{
    std::vector<u8> filled(tree.nodeCount(), 0);
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        const Node& node = tree.nodes[i];
        if (node.kind != NodeKind::Tiling) continue;
        const std::span<const Ring3> rings = tree.outlineOf(i);
        filled[i] = rings.size() == 1 && rings[0].size() >= 3 && rings[0].size() <= kFilledCorners &&
                    isConvex(rings[0], node.normal, tolerance);
    }
    for (u32 patch = 0; patch < tree.patchCount(); ++patch) {
        for (u32 i = patch; i != kNoIndex && tree.nodes[i].kind != NodeKind::Cluster; i = tree.nodes[i].parent) {
            const Node& node = tree.nodes[i];
            if (node.covered != tree.patches[patch].covered) filled[i] = 0;
            if (filled[i] == 0) continue;
            for (const Ring3& ring : tree.outlineOf(patch))
                for (const glm::dvec3& corner : ring)
                    if (std::abs(glm::dot(node.normal, corner - node.centroid)) > tolerance) filled[i] = 0;
        }
    }
    return filled;
}

} // namespace helio
