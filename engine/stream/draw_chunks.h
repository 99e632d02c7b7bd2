// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "city/base/types.h"
#include "city/format/pack.h"

namespace helio {

struct Box
{
    glm::vec3 lo{0.0f}, hi{0.0f}; ///< m, tile frame
};

/// A part of one draw that is worth culling by itself: some triangles of a mesh, or some instances of one.
struct DrawChunk
{
    gpu::DrawRecord draw{};
    Box box;
};

/// Does this draw belong to the static mesh (instance 0), or to an asset?
inline bool isStaticDraw(const gpu::DrawRecord& draw)
{
    return draw.firstInstance == 0 && draw.instanceCount == 1;
}

inline constexpr u32 kChunkTriangles = 2048;
inline constexpr u32 kChunkInstances = 32;

/// Cuts the tile's draws into chunks with their bounds. The static mesh comes first; apart from that
/// chunks keep the order of the draws.
std::vector<DrawChunk> buildDrawChunks(const TileView& tile);

/// The draws of the chunks that may show in a view: a chunk is left out when its box lies wholly beyond one of the
/// planes -w <= x <= w, -w <= y <= w, 0 <= z <= w. Neighbouring chunks of one draw become one draw again.
std::vector<gpu::DrawRecord> visibleDraws(std::span<const DrawChunk> chunks, const glm::mat4& clipFromWorld);

} // namespace helio
