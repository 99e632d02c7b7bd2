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
    Buffer values; ///< written by addSmoothLight: two vec4 a corner, then a patch, then a fan
    std::vector<DrawChunk> chunks;
};

/// Refines the tile's static mesh and puts it on the device. reads: how shaders read it, if its arrays are not too
/// large for that. A tile without patches makes empty tables.
SmoothTables uploadSmoothMesh(Context& context, const TileView& tile, Reads reads);

} // namespace helio
