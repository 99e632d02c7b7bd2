// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "city/base/result.h"
#include "city/format/pack.h"
#include "engine/gpu/context.h"
#include "engine/gpu/resources.h"
#include "engine/stream/contraction.h"
#include "engine/stream/draw_chunks.h"
#include "engine/stream/link_packing.h"
#include "engine/stream/reads.h"
#include "engine/stream/tree_levels.h"

namespace helio {

/// Packed links on the device (see PackedLinks).
struct LinkBuffers
{
    struct Page
    {
        LinkPage page;
        Buffer records, moments;
    };
    Buffer rows, strips;
    std::vector<Page> pages;
    std::vector<LinkDispatch> dispatches;
    u32 stride = 1;        ///< of an inner sender: 2 where links have moments
    u32 senderPatches = 0; ///< senders that take one element each; inner ones follow
    u32 factorBits = 0;    ///< see PackedLinks
    u64 linkCount = 0, singles = 0, bytes = 0;
};

/// Slopes of linear sky patches in the array of senders, per change from side to side of the patch. Offsets count in
/// its halves; the rest makes their moments use the whole range of the short form.
inline constexpr float kSkySlopeScale = 0.5f / gpu::kMomentLimit;

/// A tile on the device, with what the host needs to drive it. Every buffer is read-only after the upload.
struct TileTables
{
    u32 patchCount = 0, nodeCount = 0;
    u32 innerCount() const { return nodeCount - patchCount; }
    double patchArea = 0.0; ///< m2, of all patches
    bool emits = false;     ///< does any patch?
    Reads reads = Reads::Storage;
    Buffer reflectance;                ///< vec4 a patch
    Buffer emission;                   ///< vec4 a patch; one zero where nothing emits
    Buffer planes;                     ///< vec4 a patch: normal, area (m2)
    Buffer nodes;                      ///< two words a node: parent, area as a float's bits
    Buffer childRows, children, turns; ///< see TreeLevels
    std::vector<TreeLevel> levels;

    bool linear = false; ///< linear senders: links have moments, inner nodes have slopes
    LinkBuffers links;
    /// Elements of the array of senders, see shaders/shared/solve.h.
    u64 senderCount() const { return patchCount + u64(links.stride) * innerCount(); }
    Contraction contraction;

    std::vector<gpu::SkyPatchRecord> skyPatches;
    LinkBuffers skyLinks; ///< receivers: patches; senders: sky patches, see skySenders

    Buffer vertices, indices, instances;
    std::vector<DrawChunk> chunks;
};

/// Puts packed links on the device. `links`: what they were packed from.
LinkBuffers uploadLinks(Context& context, const std::string& name, const PackedLinks& packed, const LinkRows& links);

struct UploadOptions
{
    bool exactLinks = false;         ///< links in full precision: 16 bytes each
    std::optional<Reads> reads = {}; ///< none: the fastest on the device that can hold the tile's arrays
    u64 maxRecords = ~0ull;          ///< of a page of links, if the device allows more
};

/// Puts a tile on the device. Errors: no patches; a tree or links that the device cannot take.
Result<TileTables> uploadTile(Context& context, const TileView& tile, const UploadOptions& options = {});

/// Triangles of the static mesh, as vertex numbers with the draws' offsets applied.
std::vector<u32> staticTriangles(const TileView& tile);

} // namespace helio
