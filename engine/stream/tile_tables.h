// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "city/base/result.h"
#include "city/format/pack.h"
#include "engine/gpu/context.h"
#include "engine/gpu/resources.h"
#include "engine/stream/contraction.h"
#include "engine/stream/draw_chunks.h"
#include "engine/stream/link_packing.h"
#include "engine/stream/tree_levels.h"

namespace helio {

/// One page of links on the device.
struct LinkPageBuffer
{
    LinkPage page;
    Buffer records; ///< see PackedLinks::records
};

/// A tile on the device, with what the host needs to drive it. Every buffer is read-only after the upload.
struct TileTables
{
    u32 patchCount = 0, nodeCount = 0;
    u32 innerCount() const { return nodeCount - patchCount; }
    double patchArea = 0.0; ///< m2, of all patches
    bool emits = false;     ///< does any patch?
    Buffer patches;         ///< PatchRecord
    Buffer nodes;           ///< NodeRecord
    Buffer parents;         ///< u32 a node
    Buffer childRows, children;
    Buffer childSlopes; ///< ChildSlopeRecord, parallel to children; linear senders only
    std::vector<TreeLevel> levels;

    bool linear = false;        ///< linear senders: links have moments, inner nodes have slopes
    Buffer linkOrder, linkRows; ///< see PackedLinks
    std::vector<LinkPageBuffer> links;
    Contraction contraction;
    bool texelLinks = false; ///< links and radiosity fit texel buffers: the faster gather

    std::vector<gpu::SkyPatchRecord> skyPatches;
    bool hasSkyOffsets = false; ///< radiance is linear across sky patches
    Buffer skyRows, skyColumns, skyFactors, skyOffsets;

    Buffer vertices, indices, instances;
    u32 staticVertexCount = 0; ///< vertices of the static mesh (instance 0), which come first
    std::vector<DrawChunk> chunks;
};

/// Puts a tile on the device. Errors: no patches; a tree or links that the device cannot take.
Result<TileTables> uploadTile(Context& context, const TileView& tile);

/// Vertices of the static mesh: those that draws of instance 0 use, counted from vertex 0.
u32 countStaticVertices(const TileView& tile);
/// Triangles of the static mesh, as vertex numbers with the draws' offsets applied.
std::vector<u32> staticTriangles(const TileView& tile);

} // namespace helio
