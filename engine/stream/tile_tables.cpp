// SPDX-License-Identifier: Apache-2.0
#include "engine/stream/tile_tables.h"

#include <algorithm>

#include "engine/gpu/transfer.h"

namespace helio {

namespace {

LinkRows linksOf(const TileView& tile)
{
    return {tile.linkRows, tile.linkColumns, tile.linkFactors, tile.linkMoments, u32(tile.patches.size())};
}

/// Does the gather that reads texel buffers serve: the radiosity and the longest row in one view each, few pages?
bool texelsServe(const Context& context, const TileView& tile)
{
    const LinkRows links = linksOf(tile);
    u64 recordCount = 0, longestRow = 0;
    for (u32 i = 0; i < links.rowCount(); ++i) {
        const u64 records = recordsOfRow(links, i).all;
        recordCount += records;
        longestRow = std::max(longestRow, records);
    }
    const u64 slopes = links.linear() ? 2 * (tile.nodes.size() - tile.patches.size()) : 0;
    return context.texelsFit(std::max<u64>(tile.nodes.size(), slopes)) && context.texelsFit(longestRow) &&
           context.texelsFit(recordCount / 64);
}

} // namespace

std::vector<u32> staticTriangles(const TileView& tile)
{
    std::vector<u32> triangles;
    for (const gpu::DrawRecord& draw : tile.draws)
        if (isStaticDraw(draw))
            for (u32 k = 0; k < draw.indexCount; ++k)
                triangles.push_back(tile.indices[draw.firstIndex + k] + draw.vertexOffset);
    return triangles;
}

u32 countStaticVertices(const TileView& tile)
{
    u32 count = 0;
    for (const gpu::DrawRecord& draw : tile.draws)
        if (isStaticDraw(draw))
            for (u32 k = 0; k < draw.indexCount; ++k)
                count = std::max(count, tile.indices[draw.firstIndex + k] + draw.vertexOffset + 1);
    return count;
}

Result<TileTables> uploadTile(Context& context, const TileView& tile)
{
    if (tile.patches.empty()) return Error{"the pack has no patches: there is nothing to light"};
    TileTables t;
    t.patchCount = u32(tile.patches.size());
    t.nodeCount = u32(tile.nodes.size());
    for (const gpu::PatchRecord& patch : tile.patches) {
        t.patchArea += double(patch.area);
        t.emits = t.emits || patch.emission != glm::vec4(0.0f);
    }
    t.linear = !tile.linkMoments.empty();
    t.contraction = contractionOf(tile);
    auto tree = buildTreeLevels(tile.nodes, tile.children, t.patchCount, tile.childSlopes);
    if (!tree) return tree.error();
    t.texelLinks = texelsServe(context, tile);
    const u64 recordsPerPage = t.texelLinks ? context.facts().maxTexelBufferElements
                                            : context.facts().maxStorageBufferBytes / sizeof(gpu::LinkPairRecord);
    auto links = packLinks(linksOf(tile), recordsPerPage);
    if (!links) return links.error();

    t.patches = makeBuffer(context, "patches", tile.patches);
    t.nodes = makeBuffer(context, "nodes", tile.nodes);
    t.parents = makeBuffer(context, "parents", tree->parents);
    t.childRows = makeBuffer(context, "child rows", tree->childRows);
    t.children = makeBuffer(context, "children", tree->children);
    if (t.linear) t.childSlopes = makeBuffer(context, "child slopes", tree->childSlopes);
    t.levels = std::move(tree->levels);

    t.linkOrder = makeBuffer(context, "link order", links->order);
    t.linkRows = makeBuffer(context, "link rows", links->rows);
    for (const LinkPage& page : links->pages)
        t.links.push_back({page, makeBuffer(context, "links",
                                            std::span<const gpu::LinkPairRecord>(links->records)
                                                .subspan(page.recordFirst, page.recordCount))});

    if (tile.skyColumns.size_bytes() > context.facts().maxStorageBufferBytes)
        return Error{concat(tile.skyColumns.size(), " sky links are more than one buffer of this device holds (",
                            context.facts().maxStorageBufferBytes, " bytes); bake with fewer --sky-patches")};
    t.skyPatches.assign(tile.skyPatches.begin(), tile.skyPatches.end());
    t.skyRows = makeBuffer(context, "sky rows", tile.skyRows);
    t.skyColumns = makeBuffer(context, "sky columns", tile.skyColumns);
    t.skyFactors = makeBuffer(context, "sky factors", tile.skyFactors);
    t.hasSkyOffsets = !tile.skyOffsets.empty();
    t.skyOffsets = makeBuffer(context, "sky offsets", tile.skyOffsets);

    t.vertices = makeBuffer(context, "vertices", tile.vertices);
    t.indices = makeBuffer(context, "indices", tile.indices);
    t.instances = makeBuffer(context, "instances", tile.instances);
    t.staticVertexCount = countStaticVertices(tile);
    t.chunks = buildDrawChunks(tile);
    return t;
}

} // namespace helio
