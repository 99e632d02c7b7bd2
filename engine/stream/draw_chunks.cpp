// SPDX-License-Identifier: Apache-2.0
#include "engine/stream/draw_chunks.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

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

} // namespace

std::vector<DrawChunk> buildDrawChunks(const TileView& tile)
{
    std::vector<DrawChunk> chunks;
    for (const gpu::DrawRecord& draw : tile.draws) {
        if (draw.indexCount == 0 || draw.instanceCount == 0) continue;
        if (draw.instanceCount > 1) {
            const Box local = boundsOf(tile, draw);
            for (u32 first = 0; first < draw.instanceCount; first += kChunkInstances) {
                DrawChunk chunk{draw, kEmpty};
                chunk.draw.firstInstance = draw.firstInstance + first;
                chunk.draw.instanceCount = std::min(kChunkInstances, draw.instanceCount - first);
                for (u32 k = 0; k < chunk.draw.instanceCount; ++k)
                    growPlaced(chunk.box, tile.instances[chunk.draw.firstInstance + k], local);
                chunks.push_back(chunk);
            }
        } else {
            for (u32 first = 0; first < draw.indexCount; first += 3 * kChunkTriangles) {
                DrawChunk chunk{draw, kEmpty};
                chunk.draw.firstIndex = draw.firstIndex + first;
                chunk.draw.indexCount = std::min(3 * kChunkTriangles, draw.indexCount - first);
                growPlaced(chunk.box, tile.instances[draw.firstInstance], boundsOf(tile, chunk.draw));
                chunks.push_back(chunk);
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
    for (const DrawChunk& chunk : chunks) {
        if (!mayShow(chunk.box, clipFromWorld)) continue;
        if (!draws.empty() && continues(draws.back(), chunk.draw)) {
            gpu::DrawRecord& last = draws.back();
            if (last.firstInstance == chunk.draw.firstInstance)
                last.indexCount += chunk.draw.indexCount;
            else
                last.instanceCount += chunk.draw.instanceCount;
        } else {
            draws.push_back(chunk.draw);
        }
    }
    return draws;
}

} // namespace helio
