// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "engine/gpu/resources.h"
#include "engine/stream/draw_chunks.h"
#include "engine/stream/reads.h"

namespace helio {

/// A smooth mesh on the device (see SmoothMesh).
struct SmoothTables
{
    u32 cornerCount = 0, patchCount = 0;
    Reads reads = Reads::Storage;
    Buffer vertices, indices, valueOfVertex;
    Buffer cornerRows, cornerPatches, patchRows, patchWeights, fanRows, fanWeightRows, fanWeights;
    Buffer values; ///< written by addSmoothLight: a vec4 a corner, then a patch, then a fan
    std::vector<DrawChunk> chunks;
    u64 tooLarge = 0; ///< bytes of the largest array, where the device cannot bind it: the rest is empty then
};

/// Refines the tile's static mesh and puts it on the device. reads: how shaders read it, if its arrays are not too
/// large for that. mostBytes: the largest array that may be bound, at most what the device can
/// (DeviceFacts::maxStorageBufferBytes). A tile without patches makes empty tables.
SmoothTables uploadSmoothMesh(Context& context, const TileView& tile, Reads reads, u64 mostBytes);

} // namespace helio
