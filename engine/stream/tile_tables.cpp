// SPDX-License-Identifier: Apache-2.0
#include "engine/stream/tile_tables.h"

#include <algorithm>
#include <bit>
#include <glm/vec2.hpp>

#include "engine/gpu/transfer.h"

namespace helio {

namespace {

/// Sky links as rows of links whose senders are the sky patches: inner nodes with slopes where they are linear (see
/// kSkySlopeScale), else patches.
struct SkyRows
{
    explicit SkyRows(const TileView& tile) : rows(tile.skyRows), columns(tile.skyColumns), factors(tile.skyFactors)
    {
        moments.reserve(2 * tile.skyOffsets.size());
        for (size_t k = 0; k < tile.skyOffsets.size(); ++k)
            for (const u32 half : {tile.skyOffsets[k] & 0xFFFF, tile.skyOffsets[k] >> 16}) {
                const float offset = std::max(float(std::int16_t(u16(half))) / 32767.0f, -1.0f);
                moments.push_back(offset * gpu::kMomentLimit * factors[k]);
            }
    }
    LinkRows links(u32 skyCount) const { return {rows, columns, factors, moments, moments.empty() ? skyCount : 0}; }

    std::span<const u32> rows, columns;
    std::span<const float> factors;
    std::vector<float> moments;
};

/// Rows of links by level, downwards: the inner nodes from the highest, then the patches.
std::vector<RowLevel> downwards(const std::vector<TreeLevel>& levels, u32 patchCount)
{
    std::vector<RowLevel> rows;
    for (auto level = levels.rbegin(); level != levels.rend(); ++level) rows.push_back({level->first, level->count});
    rows.push_back({0, patchCount});
    return rows;
}

Result<LinkBuffers> packAndUpload(Context& context, const char* name, const LinkRows& links,
                                  std::span<const RowLevel> levels, std::span<const gpu::NodeRecord> parents,
                                  const PackOptions& options)
{
    Result<PackedLinks> packed = packLinks(links, levels, options);
    if (!packed) return packed.error();
    for (gpu::RowRecord& row : packed->rows)
        if (row.receiver < parents.size()) row.parent = parents[row.receiver].parent;
    return uploadLinks(context, name, *packed, links);
}

/// Elements of the largest array that the solve and the pictures read, links and interpolated light aside.
u64 largestArray(const TileView& tile)
{
    const u64 inner = tile.nodes.size() - tile.patches.size();
    const u64 senders = tile.patches.size() + (tile.linkMoments.empty() ? 1 : 2) * inner;
    return std::max({senders, u64(tile.children.size()), u64(tile.nodes.size() + tile.nodes.size() / 4)});
}

} // namespace

LinkBuffers uploadLinks(Context& context, const std::string& name, const PackedLinks& packed, const LinkRows& links)
{
    LinkBuffers out;
    out.stride = links.linear() ? 2 : 1;
    out.senderPatches = links.patchCount;
    out.linkCount = links.columns.size();
    out.factorBits = packed.factorBits;
    out.singles = packed.singles;
    out.bytes = packed.bytes();
    out.rows = makeBuffer(context, name + " rows", packed.rows);
    out.strips = makeBuffer(context, name + " strips", packed.strips);
    for (const LinkPage& page : packed.pages)
        out.pages.push_back(
            {page,
             makeBuffer(
                 context, name,
                 std::span<const gpu::LinkQuadRecord>(packed.records).subspan(page.recordFirst, page.recordCount)),
             makeBuffer(
                 context, name + " moments",
                 std::span<const gpu::MomentQuadRecord>(packed.moments).subspan(page.momentFirst, page.momentCount))});
    out.dispatches = packed.dispatches;
    return out;
}

std::vector<u32> staticTriangles(const TileView& tile)
{
    std::vector<u32> triangles;
    for (const gpu::DrawRecord& draw : tile.draws)
        if (isStaticDraw(draw))
            for (u32 k = 0; k < draw.indexCount; ++k)
                triangles.push_back(tile.indices[draw.firstIndex + k] + draw.vertexOffset);
    return triangles;
}

Result<TileTables> uploadTile(Context& context, const TileView& tile, const UploadOptions& options)
{
    if (tile.patches.empty()) return Error{"the pack has no patches: there is nothing to light"};
    TileTables t;
    t.patchCount = u32(tile.patches.size());
    t.nodeCount = u32(tile.nodes.size());
    std::vector<glm::vec4> reflectance, emission, planes;
    for (const gpu::PatchRecord& patch : tile.patches) {
        t.patchArea += double(patch.area);
        t.emits = t.emits || patch.emission != glm::vec4(0.0f);
        reflectance.push_back(patch.rho);
        emission.push_back(patch.emission);
        planes.emplace_back(patch.normal, patch.area);
    }
    std::vector<glm::uvec2> nodes;
    for (const gpu::NodeRecord& node : tile.nodes) nodes.emplace_back(node.parent, std::bit_cast<u32>(node.area));
    t.linear = !tile.linkMoments.empty();
    t.contraction = contractionOf(tile);
    auto tree = buildTreeLevels(tile.nodes, tile.children, t.patchCount, tile.childSlopes);
    if (!tree) return tree.error();
    t.levels = std::move(tree->levels);
    // Links come in pages, but not in hundreds.
    const u64 largest = std::max(largestArray(tile), u64(tile.linkColumns.size() / 64));
    t.reads = options.reads ? *options.reads : fastestReads(context, largest);
    const u64 records = t.reads == Reads::Storage ? context.facts().maxStorageBufferBytes / 16
                                                  : u64(context.facts().maxTexelBufferElements);
    const PackOptions pack{options.exactLinks, std::min(records, options.maxRecords)};
    const LinkRows rows{tile.linkRows, tile.linkColumns, tile.linkFactors, tile.linkMoments, t.patchCount};
    auto links = packAndUpload(context, "links", rows, downwards(t.levels, t.patchCount), tile.nodes, pack);
    if (!links) return links.error();
    t.links = std::move(*links);
    const SkyRows sky(tile);
    const RowLevel allPatches{0, t.patchCount};
    auto skyLinks =
        packAndUpload(context, "sky links", sky.links(u32(tile.skyPatches.size())), {&allPatches, 1}, {}, pack);
    if (!skyLinks) return skyLinks.error();
    t.skyLinks = std::move(*skyLinks);
    t.skyPatches.assign(tile.skyPatches.begin(), tile.skyPatches.end());

    t.reflectance = makeBuffer(context, "reflectance", reflectance);
    t.emission = makeBuffer(context, "emission", t.emits ? emission : std::vector<glm::vec4>(1));
    t.planes = makeBuffer(context, "planes", planes);
    t.nodes = makeBuffer(context, "nodes", nodes);
    t.childRows = makeBuffer(context, "child rows", tree->childRows);
    t.children = makeBuffer(context, "children", tree->children);
    t.turns = makeBuffer(context, "child turns", tree->turns);

    t.vertices = makeBuffer(context, "vertices", tile.vertices);
    t.instances = makeBuffer(context, "instances", tile.instances);
    std::vector<u32> indices(tile.indices.begin(), tile.indices.end());
    t.chunks = buildDrawChunks(tile, indices);
    t.indices = makeBuffer(context, "indices", indices);
    return t;
}

} // namespace helio
