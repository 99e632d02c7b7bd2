// SPDX-License-Identifier: Apache-2.0
#include "city/pack/patch_scene.h"

#include <glm/geometric.hpp>

namespace helio {

std::vector<Ring3> outlineRings(const TileView& tile, u32 node)
{
    std::vector<Ring3> rings;
    for (u32 r = tile.outlineRows[node]; r < tile.outlineRows[node + 1]; ++r) {
        Ring3& ring = rings.emplace_back();
        for (u32 p = tile.outlineRings[r] >> 1; p < tile.outlineRings[r + 1] >> 1; ++p)
            ring.push_back(glm::dvec3(tile.outlinePoints[p]) + glm::dvec3(tile.outlineRests[p]));
    }
    return rings;
}

NodeTree patchTree(const Pack& pack)
{
    const TileView& tile = pack.tile();
    NodeTree tree;
    tree.names = splitNames(tile.nodeNames);
    tree.surfaceNames = splitNames(tile.surfaceNames);
    tree.buildingIds = splitNames(tile.buildingIds);
    tree.children.assign(tile.children.begin(), tile.children.end());
    tree.patches.reserve(tile.patches.size());
    for (const gpu::PatchRecord& from : tile.patches) {
        Patch& patch = tree.patches.emplace_back();
        patch.building = from.building;
        patch.sourceFace = from.sourceFace;
        patch.surface = from.surface;
        patch.area = double(from.area);
        patch.rho = glm::dvec4(from.rho);
        patch.emission = glm::dvec4(from.emission);
    }
    tree.nodes.reserve(tile.nodes.size());
    for (u32 i = 0; i < pack.nodeCount(); ++i) {
        const gpu::NodeRecord& from = tile.nodes[i];
        const gpu::NodeInfoRecord& info = tile.nodeInfos[i];
        Node& node = tree.nodes.emplace_back();
        node.parent = from.parent;
        node.childBegin = from.childBegin;
        node.childCount = from.childCount;
        node.area = double(from.area);
        node.height = info.height;
        node.kind = NodeKind(info.kind);
        node.building = info.building;
        node.name = info.name;
        node.coverage = double(info.coverage);
        node.centroid = glm::dvec3(info.centroid);
        if (node.kind != NodeKind::Cluster) node.normal = glm::normalize(glm::dvec3(info.normal));
        node.ringBegin = u32(tree.rings.size());
        for (Ring3& ring : outlineRings(tile, i)) tree.rings.push_back(std::move(ring));
        node.ringCount = u32(tree.rings.size()) - node.ringBegin;
        for (u32 r = tile.outlineRows[i]; r < tile.outlineRows[i + 1]; ++r)
            tree.ringIsHole.push_back(tile.outlineRings[r] & 1u);
    }
    return tree;
}

} // namespace helio
