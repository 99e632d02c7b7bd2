// SPDX-License-Identifier: Apache-2.0
#include "city/light/node_parts.h"

#include "city/base/parallel.h"

namespace helio {
namespace {

void findParts(const NodeTree& tree, u32 node, NodeParts& parts)
{
    parts.node[0] = node;
    parts.count = 1;
    while (true) {
        // The largest part that can be opened; gaps count as size, for a full outline is what the factors are exact
        // for.
        u32 best = kNoIndex;
        double bestArea = 0.0;
        for (u32 i = 0; i < parts.count; ++i) {
            const Node& n = tree.nodes[parts.node[i]];
            if (n.childCount == 0 || parts.count - 1 + n.childCount > NodeParts::kMost) continue;
            const double size = n.area / (n.coverage * n.coverage);
            if (size > bestArea) {
                bestArea = size;
                best = i;
            }
        }
        if (best == kNoIndex) return;
        const std::span<const u32> children = tree.childrenOf(parts.node[best]);
        parts.node[best] = children[0];
        for (u32 c = 1; c < children.size(); ++c) parts.node[parts.count++] = children[c];
    }
}

void describePart(const NodeTree& tree, const Transfer& transfer, std::span<const double> weight, u32 node, u32 k,
                  NodeParts& parts)
{
    const Node& part = tree.nodes[parts.node[k]];
    const glm::vec3 at(part.centroid - tree.nodes[node].centroid);
    parts.x[k] = at.x;
    parts.y[k] = at.y;
    parts.z[k] = at.z;
    parts.area[k] = float(part.area);
    parts.radius[k] = float(transfer.radius(parts.node[k]));
    parts.errorWeight[k] = float(weight[parts.node[k]] / part.area);
}

void findDeviations(u32 node, const Training& training, NodeParts& parts)
{
    const std::span<const float> mean = training.of(node);
    const std::span<const glm::vec2> slope = training.slopeOf(node);
    for (u32 l = 0; l < training.lightCount; ++l) {
        NodeParts::Row d{};
        for (u32 i = 0; i < parts.count; ++i) {
            d[i] = training.of(parts.node[i])[l] - mean[l];
            if (!slope.empty()) d[i] -= slope[l].x * parts.slopeX[i] + slope[l].y * parts.slopeY[i];
        }
        for (u32 i = 0; i < parts.count; ++i)
            for (u32 j = 0; j < NodeParts::kMost; ++j) parts.deviation[i][j] += d[i] * d[j];
    }
    for (NodeParts::Row& row : parts.deviation)
        for (float& value : row) value /= float(training.lightCount);
}

} // namespace

std::vector<NodeParts> nodeParts(const NodeTree& tree, const Training& training, const Transfer& transfer,
                                 std::span<const SlopeFrame> frames, std::span<const double> weight, u32 jobs)
{
    const u32 patches = tree.patchCount();
    std::vector<NodeParts> all(tree.nodeCount() - patches);
    parallelFor(u32(all.size()), 1024, jobs, [&](u32 begin, u32 end) {
        for (u32 i = begin; i < end; ++i) {
            const u32 node = patches + i;
            if (tree.nodes[node].kind == NodeKind::Cluster) continue;
            NodeParts& parts = all[i];
            findParts(tree, node, parts);
            for (u32 k = 0; k < parts.count; ++k) {
                describePart(tree, transfer, weight, node, k, parts);
                parts.inside[k] = training.variance[parts.node[k]];
                if (frames.empty()) continue;
                const glm::vec2 slope(frames[node].at(tree.nodes[parts.node[k]].centroid - tree.nodes[node].centroid));
                parts.slopeX[k] = slope.x;
                parts.slopeY[k] = slope.y;
            }
            findDeviations(node, training, parts);
        }
    });
    return all;
}

void putLeaf(const NodeTree& tree, const Transfer& transfer, std::span<const double> weight, u32 leaf, NodeParts& parts)
{
    parts.node[0] = leaf;
    parts.count = 1;
    describePart(tree, transfer, weight, leaf, 0, parts);
}

} // namespace helio
