// SPDX-License-Identifier: Apache-2.0
#include "engine/stream/smooth_tables.h"

#include <algorithm>
#include <glm/vec4.hpp>

#include "engine/gpu/transfer.h"
#include "engine/stream/smooth_mesh.h"
#include "engine/stream/tile_tables.h"

namespace helio {

SmoothTables uploadSmoothMesh(Context& context, const TileView& tile, Reads reads, u64 mostBytes)
{
    SmoothMesh mesh = buildSmoothMesh(tile.vertices, staticTriangles(tile), tile.patches, darkPatches(tile));
    SmoothTables t;
    t.cornerCount = mesh.cornerCount;
    t.patchCount = u32(tile.patches.size());
    const std::vector<glm::vec4> values(size_t(t.cornerCount) + t.patchCount + mesh.fanWeightRows.size() - 1);
    const u64 bytes = std::max({values.size() * sizeof(glm::vec4), mesh.valueOfVertex.size() * sizeof(u32),
                                mesh.patchWeights.size() * sizeof(gpu::CornerWeightRecord),
                                mesh.fanWeights.size() * sizeof(gpu::CornerWeightRecord)});
    if (bytes > mostBytes) {
        SmoothTables none = uploadSmoothMesh(context, {}, reads, mostBytes);
        none.tooLarge = bytes;
        return none;
    }
    const size_t largest =
        std::max({values.size(), mesh.valueOfVertex.size(), mesh.patchWeights.size(), mesh.fanWeights.size()});
    t.reads = canRead(context, reads, largest) ? reads : Reads::Storage;
    const gpu::DrawRecord draw{u32(mesh.indices.size()), 1, 0, 0, 0};
    TileView refined = tile;
    refined.vertices = mesh.vertices;
    const std::vector<u32> asBuilt = mesh.indices;
    refined.indices = asBuilt;
    refined.draws = {&draw, 1};
    t.chunks = buildDrawChunks(refined, mesh.indices);
    t.vertices = makeBuffer(context, "smooth vertices", mesh.vertices);
    t.indices = makeBuffer(context, "smooth indices", mesh.indices);
    t.valueOfVertex = makeBuffer(context, "value of vertex", mesh.valueOfVertex);
    t.cornerRows = makeBuffer(context, "corner rows", mesh.cornerRows);
    t.cornerPatches = makeBuffer(context, "corner patches", mesh.cornerPatches);
    t.patchRows = makeBuffer(context, "patch rows", mesh.patchRows);
    t.patchWeights = makeBuffer(context, "patch weights", mesh.patchWeights);
    t.fanRows = makeBuffer(context, "fan rows", mesh.fanRows);
    t.fanWeightRows = makeBuffer(context, "fan weight rows", mesh.fanWeightRows);
    t.fanWeights = makeBuffer(context, "fan weights", mesh.fanWeights);
    t.values = makeBuffer(context, "smooth light", values);
    return t;
}

} // namespace helio
