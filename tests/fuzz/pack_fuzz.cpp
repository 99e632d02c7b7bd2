// SPDX-License-Identifier: Apache-2.0
// Entry point in libFuzzer's form. Any bytes as a tile file or as an index must give a value or an error, never a
// crash, and a tile that passes all checks must be safe to walk. With clang: -fsanitize=fuzzer,address and without
// fuzz_main.cpp.
#include <cstdio>
#include <cstring>
#include <memory>

#include "city/base/hash.h"
#include "city/format/index_text.h"
#include "city/format/tile_reader.h"
#include "city/format/validate.h"

namespace helio {
namespace {

/// Makes the checksums right wherever the sections lie inside the file, so that the checks behind them are reached.
void seal(std::span<std::byte> bytes)
{
    if (bytes.size() < kTableBytes) return;
    for (u32 i = 0; i < kSectionCount; ++i) {
        std::byte* place = bytes.data() + sizeof(TileHeader) + i * sizeof(SectionEntry);
        SectionEntry entry;
        std::memcpy(&entry, place, sizeof entry);
        if (entry.offset > bytes.size() || entry.storedBytes > bytes.size() - entry.offset) continue;
        entry.checksum = hashBytes(bytes.subspan(entry.offset, entry.storedBytes));
        std::memcpy(place, &entry, sizeof entry);
    }
    const u64 fileBytes = bytes.size(), zero = 0;
    std::memcpy(bytes.data() + offsetof(TileHeader, fileBytes), &fileBytes, 8);
    std::memcpy(bytes.data() + offsetof(TileHeader, tableChecksum), &zero, 8);
    const u64 checksum = hashBytes(bytes.first(kTableBytes));
    std::memcpy(bytes.data() + offsetof(TileHeader, tableChecksum), &checksum, 8);
}

/// An index whose last line is the right checksum of what stands before it, so that the JSON behind it is read.
std::string sealedIndex(std::string_view text)
{
    const size_t end = text.rfind("xxh3 ");
    std::string body(text.substr(0, end == std::string_view::npos ? text.size() : end));
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hashText(body)));
    return body + "xxh3 " + digits + '\n';
}

/// Reads everything that the tables point to without a look at any bound, as the engine does.
float walk(const TileView& tile)
{
    float sum = 0.0f;
    for (u64 i = 0; i < tile.nodes.size(); ++i) {
        for (u32 k = tile.linkRows[i]; k < tile.linkRows[i + 1]; ++k) {
            sum += tile.linkFactors[k] * tile.nodes[tile.linkColumns[k]].area;
            if (!tile.linkMoments.empty()) sum += tile.linkMoments[2 * k] + tile.linkMoments[2 * k + 1];
        }
        for (u32 k = 0; k < tile.nodes[i].childCount; ++k)
            sum += tile.nodeInfos[tile.children[tile.nodes[i].childBegin + k]].coverage;
        for (u32 r = tile.outlineRows[i]; r < tile.outlineRows[i + 1]; ++r)
            for (u32 p = tile.outlineRings[r] >> 1; p < tile.outlineRings[r + 1] >> 1; ++p)
                sum += tile.outlinePoints[p].x + tile.outlineRests[p].x;
    }
    for (u64 i = 0; i < tile.patches.size(); ++i)
        for (u32 k = tile.skyRows[i]; k < tile.skyRows[i + 1]; ++k)
            sum += tile.skyFactors[k] * tile.skyPatches[tile.skyColumns[k]].solidAngle;
    for (const gpu::DrawRecord& draw : tile.draws)
        for (u32 n = 0; n < draw.instanceCount && draw.indexCount > 0; ++n)
            for (const u32 k : {draw.firstIndex, draw.firstIndex + draw.indexCount - 1}) {
                const gpu::VertexRecord& vertex = tile.vertices[tile.indices[k] + draw.vertexOffset];
                sum += tile.patches[vertex.patchId + tile.instances[draw.firstInstance + n].patchId].area;
            }
    return sum;
}

volatile float sink; ///< keeps the walk

} // namespace

/// Tiles that passed every check so far: the driver's proof that the deep checks were reached.
u64 acceptedTiles = 0;
/// Indices with the right checksum that were read, and those that were refused for what their JSON says.
u64 acceptedIndices = 0, refusedIndices = 0;

} // namespace helio

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size)
{
    using namespace helio;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    (void)decodeIndex(text, "index");
    if (text.substr(0, kIndexMagic.size()) == kIndexMagic)
        ++(decodeIndex(sealedIndex(text), "index") ? acceptedIndices : refusedIndices);
    // A block of exactly the size, so that a sanitizer sees one byte too far.
    const auto block = std::make_unique<std::byte[]>(size);
    const std::span<std::byte> bytes(block.get(), size);
    if (size > 0) std::memcpy(bytes.data(), data, size);
    PackIndex index;
    index.sourceFaceCount = 3;
    for (const bool sealed : {false, true}) {
        if (sealed) seal(bytes);
        Result<LoadedTile> tile = readTile(bytes, "tile");
        if (!tile || !validateTile(tile->view, index, tile->places)) continue;
        sink = walk(tile->view);
        ++acceptedTiles;
    }
    return 0;
}
