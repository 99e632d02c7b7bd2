// SPDX-License-Identifier: Apache-2.0
#include "city/format/pack.h"

#include <algorithm>

#include "city/format/index_text.h"
#include "city/format/mapped_file.h"
#include "city/format/tile_reader.h"
#include "city/format/validate.h"

namespace helio {
namespace {

/// What a TileView's spans point into.
struct TileBytes
{
    MappedFile file;
    std::vector<std::unique_ptr<std::byte[]>> unpacked;
};

} // namespace

Result<Pack> Pack::open(const std::filesystem::path& folder)
{
    std::error_code failure;
    if (!std::filesystem::is_directory(folder, failure)) {
        if (std::filesystem::exists(folder, failure))
            return Error{concat(folder.string(), ": is not a pack: a pack is a folder")};
        return Error{concat(folder.string(), ": there is no such pack; heliopolis-bake -o makes one")};
    }
    const std::filesystem::path indexPath = folder / kIndexFile, tilePath = folder / kTileFile;
    if (!std::filesystem::exists(indexPath, failure))
        return Error{concat(folder.string(), ": is not a pack: the folder has no file '", kIndexFile, "'")};
    Result<MappedFile> indexFile = MappedFile::open(indexPath);
    if (!indexFile) return indexFile.error();
    const std::span<const std::byte> text = indexFile->bytes();
    Result<IndexText> index =
        decodeIndex({reinterpret_cast<const char*>(text.data()), text.size()}, indexPath.string());
    if (!index) return index.error();

    Result<MappedFile> tileFile = MappedFile::open(tilePath);
    if (!tileFile) return tileFile.error();
    const auto bytes = std::make_shared<TileBytes>();
    bytes->file = std::move(*tileFile);
    Result<LoadedTile> tile = readTile(bytes->file.bytes(), tilePath.string());
    if (!tile) return tile.error();
    if (index->tile != TileEntry{bytes->file.bytes().size(), tile->tableChecksum})
        return Error{concat(tilePath.string(),
                            ": byte 24: this tile belongs to another bake than the index; bake the pack again")};
    if (Status status = validateTile(tile->view, index->index, tile->places); !status) return status.error();

    bytes->unpacked = std::move(tile->unpacked);
    Pack pack;
    pack.index_ = std::move(index->index);
    pack.tile_ = tile->view;
    const auto stored = [&](SectionId id) { return tile->storedBytes[u32(id) - 1]; };
    pack.linkBytes_ = {stored(SectionId::LinkColumns), stored(SectionId::LinkFactors), stored(SectionId::LinkMoments)};
    pack.bytes_ = bytes;
    return pack;
}

u32 skyCellCount(std::span<const gpu::SkyPatchRecord> skyPatches)
{
    return u32(skyPatches.size()) - u32(!skyPatches.empty() && skyPatches.back().direction.z < 0.0f);
}

glm::vec4 farGroundOf(const TileView& tile)
{
    return skyCellCount(tile.skyPatches) < tile.skyPatches.size() ? tile.skyPatches.back().rho : glm::vec4(0.0f);
}

std::vector<std::string> splitNames(std::span<const char> section)
{
    std::vector<std::string> names;
    for (auto begin = section.begin(); begin != section.end();) {
        const auto end = std::find(begin, section.end(), '\n');
        names.emplace_back(begin, end);
        begin = end == section.end() ? end : end + 1;
    }
    return names;
}

} // namespace helio
