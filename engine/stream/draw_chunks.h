// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "city/base/types.h"
#include "city/format/pack.h"

namespace helio {

struct Box
{
    glm::vec3 lo{0.0f}, hi{0.0f}; ///< m, tile frame
};

/// Triangles of closed surfaces that face about the same way, side by side among the indices of a draw.
struct FacingRange
{
    u32 firstIndex = 0, indexCount = 0;
    std::vector<glm::vec3> normals; ///< unit, local, each once: outward
    bool always = false;            ///< too many normals to tell: drawn whatever the sun
};

/// The triangles of a draw, sorted: those of open surfaces first, then closed ones by the way they face.
struct FacingMesh
{
    u32 openCount = 0; ///< indices
    std::vector<FacingRange> ranges;
};

/// A part of one draw that is worth culling by itself: some triangles of a mesh, or some instances of one.
struct DrawChunk
{
    gpu::DrawRecord draw{};
    Box box;
    std::shared_ptr<const FacingMesh> facing; ///< of the draw's triangles
    /// Of its instances, each once: the outside of a local normal n is seen from direction s if n . (m s) > 0.
    std::vector<glm::mat3> localFromDirection;
};

/// Does this draw belong to the static mesh (instance 0), or to an asset?
inline bool isStaticDraw(const gpu::DrawRecord& draw)
{
    return draw.firstInstance == 0 && draw.instanceCount == 1;
}

inline constexpr u32 kChunkTriangles = 2048;
inline constexpr u32 kChunkInstances = 32;

/// Cuts the tile's draws into chunks with their bounds. The static mesh comes first; apart from that
/// chunks keep the order of the draws. indices: the tile's, reordered inside the chunks by facing.
std::vector<DrawChunk> buildDrawChunks(const TileView& tile, std::vector<u32>& indices);

/// Which triangles belong to closed surfaces? positions: three corners each. A connected part (corners at the same
/// place) is closed if every edge has as many triangles on its one side as on its other and it encloses a volume with
/// its faces outwards. Only the back of a closed surface may be left out from a picture of what light meets first:
/// before it there is always a front.
std::vector<bool> closedTriangles(std::span<const glm::vec3> positions);

/// Sorts some triangles of a draw by facing. positions: of their corners, in the order of `indices`, which lie from
/// firstIndex on; closed: closedTriangles of the whole draw, of which they are those from firstTriangle on.
FacingMesh sortByFacing(std::span<const glm::vec3> positions, const std::vector<bool>& closed, size_t firstTriangle,
                        std::span<u32> indices, u32 firstIndex);

/// The draws of the chunks that may show in a view: a chunk is left out when its box lies wholly beyond one of the
/// planes -w <= x <= w, -w <= y <= w, 0 <= z <= w. Neighbouring chunks of one draw become one draw again.
std::vector<gpu::DrawRecord> visibleDraws(std::span<const DrawChunk> chunks, const glm::mat4& clipFromWorld);

/// The same without what certainly shows the viewer its back: draws of closed surfaces, of which the device may leave
/// out back faces, and the rest. viewer: the eye, with 1 as its last component, or the direction towards the sun, with
/// 0. For an eye each list has the static mesh first and, of it and of the assets, near chunks before far ones. An eye
/// inside a closed body looks out of it.
struct FacingDraws
{
    std::vector<gpu::DrawRecord> closed, open;
};
FacingDraws facingDraws(std::span<const DrawChunk> chunks, const glm::mat4& clipFromWorld, const glm::vec4& viewer);

} // namespace helio
