// SPDX-License-Identifier: Apache-2.0
#include "engine/stream/draw_chunks.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <utility>

#include "city/base/check.h"

namespace helio {

namespace {

const Box kEmpty{glm::vec3(std::numeric_limits<float>::max()), glm::vec3(std::numeric_limits<float>::lowest())};

void grow(Box& box, glm::vec3 point)
{
    box.lo = glm::min(box.lo, point);
    box.hi = glm::max(box.hi, point);
}

glm::vec3 corner(const Box& box, u32 k)
{
    return {(k & 1) ? box.hi.x : box.lo.x, (k & 2) ? box.hi.y : box.lo.y, (k & 4) ? box.hi.z : box.lo.z};
}

void growPlaced(Box& box, const gpu::InstanceRecord& instance, const Box& local)
{
    for (u32 k = 0; k < 8; ++k) {
        const glm::vec4 p(corner(local, k), 1.0f);
        grow(box, {glm::dot(instance.worldFromLocal[0], p), glm::dot(instance.worldFromLocal[1], p),
                   glm::dot(instance.worldFromLocal[2], p)});
    }
}

Box boundsOf(const TileView& tile, const gpu::DrawRecord& draw)
{
    Box box = kEmpty;
    for (u32 k = 0; k < draw.indexCount; ++k)
        grow(box, tile.vertices[tile.indices[draw.firstIndex + k] + draw.vertexOffset].position);
    return box;
}

bool continues(const gpu::DrawRecord& a, const gpu::DrawRecord& b)
{
    if (a.vertexOffset != b.vertexOffset) return false;
    const bool sameInstances = a.firstInstance == b.firstInstance && a.instanceCount == b.instanceCount;
    const bool sameTriangles = a.firstIndex == b.firstIndex && a.indexCount == b.indexCount;
    return (sameInstances && a.firstIndex + a.indexCount == b.firstIndex) ||
           (sameTriangles && a.firstInstance + a.instanceCount == b.firstInstance);
}

bool mayShow(const Box& box, const glm::mat4& clipFromWorld)
{
    std::array<u32, 6> beyond{};
    for (u32 k = 0; k < 8; ++k) {
        const glm::vec4 p = clipFromWorld * glm::vec4(corner(box, k), 1.0f);
        beyond[0] += p.x < -p.w;
        beyond[1] += p.x > p.w;
        beyond[2] += p.y < -p.w;
        beyond[3] += p.y > p.w;
        beyond[4] += p.z < 0.0f;
        beyond[5] += p.z > p.w;
    }
    return std::none_of(beyond.begin(), beyond.end(), [](u32 count) { return count == 8; });
}

/// The corners of a draw's triangles.
std::vector<glm::vec3> cornersOf(const TileView& tile, const gpu::DrawRecord& draw)
{
    std::vector<glm::vec3> positions;
    for (const u32 index : tile.indices.subspan(draw.firstIndex, draw.indexCount))
        positions.push_back(tile.vertices[index + draw.vertexOffset].position);
    return positions;
}

/// A draw's triangles, to be sorted part by part.
class FacingSorter
{
public:
    FacingSorter(const TileView& tile, const gpu::DrawRecord& draw, std::vector<u32>& indices)
        : draw_(draw), indices_(indices), corners_(cornersOf(tile, draw)), closed_(closedTriangles(corners_))
    {
    }
    std::shared_ptr<const FacingMesh> sort(const gpu::DrawRecord& part) const
    {
        const u32 first = part.firstIndex - draw_.firstIndex;
        return std::make_shared<const FacingMesh>(
            sortByFacing(std::span(corners_).subspan(first, part.indexCount), closed_, first / 3,
                         std::span(indices_).subspan(part.firstIndex, part.indexCount), part.firstIndex));
    }

private:
    const gpu::DrawRecord& draw_;
    std::vector<u32>& indices_;
    std::vector<glm::vec3> corners_;
    std::vector<bool> closed_;
};

/// Normals go by the cofactors of the transform: n . (M^-1 s) |M| > 0 where the outside of a local n is seen from s.
glm::mat3 localFromDirection(const glm::mat3& world)
{
    return glm::determinant(world) * glm::inverse(world);
}

/// The turn and stretch of an instance, without its place.
glm::mat3 worldFromLocal(const gpu::InstanceRecord& instance)
{
    const auto& rows = instance.worldFromLocal;
    return glm::transpose(glm::mat3(glm::vec3(rows[0]), glm::vec3(rows[1]), glm::vec3(rows[2])));
}

/// The chunks that may show. For an eye those of the static mesh, then those of assets, each from near to far: what is
/// covered then fails the depth test before it is shaded. The sun's picture has no shading to save: its chunks keep
/// their order, which makes fewer draws.
std::vector<const DrawChunk*> chunksInView(std::span<const DrawChunk> chunks, const glm::mat4& clipFromWorld,
                                           const glm::vec4& viewer)
{
    std::vector<const DrawChunk*> shown;
    for (const DrawChunk& chunk : chunks)
        if (mayShow(chunk.box, clipFromWorld)) shown.push_back(&chunk);
    if (viewer.w == 0.0f) return shown;
    // By the middle of the box: by its nearest point wide ground would come before what stands on it.
    const auto rank = [&](const DrawChunk* chunk) {
        const glm::vec3 middle = 0.5f * (chunk->box.lo + chunk->box.hi);
        return std::pair(!isStaticDraw(chunk->draw), glm::distance(middle, glm::vec3(viewer)));
    };
    std::stable_sort(shown.begin(), shown.end(),
                     [&](const DrawChunk* a, const DrawChunk* b) { return rank(a) < rank(b); });
    return shown;
}

void append(std::vector<gpu::DrawRecord>& draws, const gpu::DrawRecord& draw)
{
    if (draw.indexCount == 0) return;
    if (draws.empty() || !continues(draws.back(), draw)) {
        draws.push_back(draw);
        return;
    }
    gpu::DrawRecord& last = draws.back();
    if (last.firstInstance == draw.firstInstance)
        last.indexCount += draw.indexCount;
    else
        last.instanceCount += draw.instanceCount;
}

} // namespace

std::vector<DrawChunk> buildDrawChunks(const TileView& tile, std::vector<u32>& indices)
{
    HELIO_CHECK(indices.size() == tile.indices.size(), indices.size(), " indices");
    std::vector<DrawChunk> chunks;
    for (const gpu::DrawRecord& draw : tile.draws) {
        if (draw.indexCount == 0 || draw.instanceCount == 0) continue;
        const FacingSorter sorter(tile, draw, indices);
        if (!isStaticDraw(draw)) {
            const Box local = boundsOf(tile, draw);
            const std::shared_ptr<const FacingMesh> facing = sorter.sort(draw);
            for (u32 first = 0; first < draw.instanceCount; first += kChunkInstances) {
                DrawChunk chunk{draw, kEmpty, facing, {}};
                chunk.draw.firstInstance = draw.firstInstance + first;
                chunk.draw.instanceCount = std::min(kChunkInstances, draw.instanceCount - first);
                for (u32 k = 0; k < chunk.draw.instanceCount; ++k) {
                    const gpu::InstanceRecord& instance = tile.instances[chunk.draw.firstInstance + k];
                    growPlaced(chunk.box, instance, local);
                    const glm::mat3 world = worldFromLocal(instance);
                    const glm::mat3 turn = localFromDirection(world);
                    auto& turns = chunk.localFromDirection;
                    if (std::find(turns.begin(), turns.end(), turn) == turns.end()) turns.push_back(turn);
                    // What a mirror turns inside out is drawn whole, and so are its neighbours.
                    if (!(glm::determinant(world) > 0.0f)) chunk.facing = nullptr;
                }
                chunks.push_back(std::move(chunk));
            }
        } else {
            for (u32 first = 0; first < draw.indexCount; first += 3 * kChunkTriangles) {
                DrawChunk chunk{draw, kEmpty, nullptr, {glm::mat3(1.0f)}};
                chunk.draw.firstIndex = draw.firstIndex + first;
                chunk.draw.indexCount = std::min(3 * kChunkTriangles, draw.indexCount - first);
                growPlaced(chunk.box, tile.instances[draw.firstInstance], boundsOf(tile, chunk.draw));
                chunk.facing = sorter.sort(chunk.draw);
                chunks.push_back(std::move(chunk));
            }
        }
    }
    std::stable_partition(chunks.begin(), chunks.end(),
                          [](const DrawChunk& chunk) { return isStaticDraw(chunk.draw); });
    return chunks;
}

std::vector<gpu::DrawRecord> visibleDraws(std::span<const DrawChunk> chunks, const glm::mat4& clipFromWorld)
{
    std::vector<gpu::DrawRecord> draws;
    for (const DrawChunk& chunk : chunks)
        if (mayShow(chunk.box, clipFromWorld)) append(draws, chunk.draw);
    return draws;
}

FacingDraws facingDraws(std::span<const DrawChunk> chunks, const glm::mat4& clipFromWorld, const glm::vec4& viewer)
{
    FacingDraws draws;
    std::vector<glm::vec3> towards;
    for (const DrawChunk* const shown : chunksInView(chunks, clipFromWorld, viewer)) {
        const DrawChunk& chunk = *shown;
        if (!chunk.facing) {
            append(draws.open, chunk.draw);
            continue;
        }
        gpu::DrawRecord part = chunk.draw;
        part.indexCount = chunk.facing->openCount;
        append(draws.open, part);
        // Seen from a point, a normal faces it from somewhere in the box if it does from one of its corners.
        towards.clear();
        for (u32 k = 0; k < (viewer.w == 0.0f ? 1u : 8u); ++k)
            for (const glm::mat3& m : chunk.localFromDirection)
                towards.push_back(m * (glm::vec3(viewer) - viewer.w * corner(chunk.box, k)));
        for (const FacingRange& range : chunk.facing->ranges) {
            const bool faces =
                range.always || std::any_of(towards.begin(), towards.end(), [&](const glm::vec3& direction) {
                    return std::any_of(range.normals.begin(), range.normals.end(),
                                       [&](const glm::vec3& normal) { return glm::dot(normal, direction) > 0.0f; });
                });
            if (!faces) continue;
            part.firstIndex = range.firstIndex;
            part.indexCount = range.indexCount;
            append(draws.closed, part);
        }
    }
    return draws;
}

} // namespace helio
