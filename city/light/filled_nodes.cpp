// SPDX-License-Identifier: Apache-2.0
#include "city/light/filled_nodes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace helio {
namespace {

constexpr double kStraight = 1e-6; // m

bool isConvex(const Ring3& ring, const glm::dvec3& normal, double tolerance)
{
    for (size_t k = 0; k < ring.size(); ++k) {
        const glm::dvec3 edge = ring[k + 1 < ring.size() ? k + 1 : 0] - ring[k];
        const glm::dvec3 outwards = glm::cross(glm::normalize(edge), normal);
        for (const glm::dvec3& corner : ring)
            if (glm::dot(outwards, corner - ring[k]) > tolerance) return false;
    }
    return true;
}

/// Whether b lies beside the line from a to c, or behind one of them.
bool turns(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    const glm::dvec3 line = c - a, d = b - a;
    const double along = glm::dot(line, line) > 0.0 ? glm::dot(d, line) / glm::dot(line, line) : 0.0;
    return glm::distance(d, std::clamp(along, 0.0, 1.0) * line) > kStraight;
}

} // namespace

Ring3 withoutStraightCorners(const Ring3& ring)
{
    Ring3 kept;
    for (size_t k = 0; k < ring.size(); ++k) {
        const glm::dvec3 &before = kept.empty() ? ring.back() : kept.back(),
                         &after = ring[k + 1 < ring.size() ? k + 1 : 0];
        if (turns(before, ring[k], after)) kept.push_back(ring[k]);
    }
    return kept;
}

std::vector<double> distanceOffPlane(const NodeTree& tree)
{
    std::vector<double> distance(tree.nodeCount(), 0.0);
    for (u32 patch = 0; patch < tree.patchCount(); ++patch) {
        for (u32 i = patch; i != kNoIndex && tree.nodes[i].kind != NodeKind::Cluster; i = tree.nodes[i].parent) {
            const Node& node = tree.nodes[i];
            for (const Ring3& ring : tree.outlineOf(patch))
                for (const glm::dvec3& corner : ring)
                    distance[i] = std::max(distance[i], std::abs(glm::dot(node.normal, corner - node.centroid)));
        }
    }
    return distance;
}

std::vector<u8> filledNodes(const NodeTree& tree, double tolerance)
{
    const std::vector<double> offPlane = distanceOffPlane(tree);
    std::vector<u8> filled(tree.nodeCount(), 0);
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        const Node& node = tree.nodes[i];
        if (node.kind != NodeKind::Tiling || offPlane[i] > tolerance) continue;
        const std::span<const Ring3> rings = tree.outlineOf(i);
        if (rings.size() != 1) continue;
        const Ring3 outline = withoutStraightCorners(rings[0]);
        filled[i] =
            outline.size() >= 3 && outline.size() <= kFilledCorners && isConvex(outline, node.normal, tolerance);
    }
    for (u32 patch = 0; patch < tree.patchCount(); ++patch) {
        for (u32 i = patch; i != kNoIndex && tree.nodes[i].kind != NodeKind::Cluster; i = tree.nodes[i].parent)
            if (tree.nodes[i].covered != tree.patches[patch].covered) filled[i] = 0;
    }
    return filled;
}

} // namespace helio
