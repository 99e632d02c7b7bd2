// SPDX-License-Identifier: Apache-2.0
#include "city/format/tile_reader.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <new>
#include <zstd.h>

#include "city/base/hash.h"

namespace helio {
namespace {

static_assert(std::endian::native == std::endian::little, "the pack is little endian and read in place");

constexpr const char* kRemedy = "; bake the pack again";

const char* nameOf(SectionId id)
{
    const char* found = "?";
    const TileView none;
    forEachSection(none, [&](SectionId each, const char* name, const auto&) {
        if (each == id) found = name;
    });
    return found;
}

/// zstd stores a run of 128 KiB in 4 bytes at best; a larger ratio is a forged size.
constexpr u64 kLargestRatio = 65536;

struct TileParser
{
    std::span<const std::byte> bytes;
    const std::string& name;
    TileHeader header;
    std::array<SectionEntry, kSectionCount> entries;

    template <class... Ts> Error fail(u64 offset, const Ts&... parts) const
    {
        return Error{concat(name, ": byte ", offset, ": ", parts..., kRemedy)};
    }

    Status readTable()
    {
        if (bytes.size() < sizeof(TileHeader))
            return fail(bytes.size(), "the file ends inside the header of ", sizeof(TileHeader), " bytes");
        std::memcpy(&header, bytes.data(), sizeof header);
        if (header.magic != kTileMagic) return fail(0, "this is not a tile of a pack");
        if (header.version != kPackVersion)
            return fail(8, "version ", header.version, " of the format, this program reads version ", kPackVersion);
        if (header.sectionCount != kSectionCount)
            return fail(12, "a table of ", header.sectionCount, " sections, not ", kSectionCount);
        if (header.fileBytes != bytes.size())
            return fail(16, "the file has ", bytes.size(), " bytes, its header says ", header.fileBytes);
        if (bytes.size() < kTableBytes) return fail(bytes.size(), "the file ends inside the section table");
        std::memcpy(entries.data(), bytes.data() + sizeof header, sizeof entries);

        std::array<std::byte, kTableBytes> table;
        std::memcpy(table.data(), bytes.data(), table.size());
        std::memset(table.data() + offsetof(TileHeader, tableChecksum), 0, sizeof header.tableChecksum);
        if (hashBytes(table) != header.tableChecksum)
            return fail(24, "the checksum of the section table does not match");
        if (header.zeros != std::array<u64, 4>{}) return fail(32, "the reserved bytes of the header are not zero");
        return Nothing{};
    }

    /// Sections lie one after the other with zeros between them, so that every byte of the file is accounted for.
    Status checkLayout() const
    {
        u64 end = kTableBytes;
        for (u32 i = 0; i < kSectionCount; ++i) {
            const SectionEntry& entry = entries[i];
            const u64 place = sizeof(TileHeader) + i * sizeof(SectionEntry);
            const char* section = nameOf(SectionId(i + 1));
            if (entry.id != i + 1) return fail(place, "section ", entry.id, " where section ", i + 1, " is due");
            if (entry.codec > u32(SectionCodec::Zstd))
                return fail(place + 4, "section ", section, ": unknown codec ", entry.codec);
            if (entry.zero != 0) return fail(place + 40, "section ", section, ": the reserved bytes are not zero");
            if (entry.offset != alignSection(end))
                return fail(place + 8, "section ", section, ": offset ", entry.offset, " where ", alignSection(end),
                            " is due");
            if (entry.offset > bytes.size() || entry.storedBytes > bytes.size() - entry.offset)
                return fail(place + 16, "section ", section, ": ends beyond the file of ", bytes.size(), " bytes");
            const bool plain = entry.codec == u32(SectionCodec::Raw);
            if (plain ? entry.rawBytes != entry.storedBytes : entry.rawBytes / kLargestRatio > entry.storedBytes)
                return fail(place + 24, "section ", section, ": ", entry.storedBytes, " bytes cannot hold ",
                            entry.rawBytes);
            for (u64 at = end; at < entry.offset; ++at)
                if (bytes[at] != std::byte{0}) return fail(at, "a byte between two sections is not zero");
            end = entry.offset + entry.storedBytes;
        }
        if (end != bytes.size()) return fail(end, bytes.size() - end, " bytes follow the last section");
        return Nothing{};
    }

    Result<std::span<const std::byte>> readSection(u32 i, LoadedTile& tile) const
    {
        const SectionEntry& entry = entries[i];
        const std::span<const std::byte> stored = bytes.subspan(entry.offset, entry.storedBytes);
        const char* section = nameOf(SectionId(i + 1));
        if (hashBytes(stored) != entry.checksum)
            return fail(entry.offset, "section ", section, ": the checksum of its ", entry.storedBytes,
                        " bytes does not match");
        if (entry.codec == u32(SectionCodec::Raw)) return stored;

        if (ZSTD_getFrameContentSize(stored.data(), stored.size()) != entry.rawBytes)
            return fail(entry.offset, "section ", section, ": the packed data do not hold ", entry.rawBytes, " bytes");
        std::unique_ptr<std::byte[]> raw(new (std::nothrow) std::byte[entry.rawBytes]);
        if (!raw) return Error{concat(name, ": section ", section, ": no memory for ", entry.rawBytes, " bytes")};
        const size_t written = ZSTD_decompress(raw.get(), entry.rawBytes, stored.data(), stored.size());
        if (ZSTD_isError(written) || written != entry.rawBytes)
            return fail(entry.offset, "section ", section, ": cannot be unpacked");
        const std::span<const std::byte> unpacked(raw.get(), entry.rawBytes);
        tile.unpacked.push_back(std::move(raw));
        return unpacked;
    }
};

} // namespace

std::string SectionPlaces::describe(SectionId id, u64 byteInSection) const
{
    const u32 i = u32(id) - 1;
    if (packed[i]) return concat(file, ": section ", nameOf(id), ", byte ", byteInSection, " after unpacking");
    return concat(file, ": section ", nameOf(id), ", byte ", offset[i] + byteInSection);
}

Result<LoadedTile> readTile(std::span<const std::byte> bytes, const std::string& name)
{
    HELIO_CHECK(reinterpret_cast<std::uintptr_t>(bytes.data()) % 16 == 0, name);
    TileParser parser{bytes, name, {}, {}};
    if (Status status = parser.readTable(); !status) return status.error();
    if (Status status = parser.checkLayout(); !status) return status.error();

    LoadedTile tile;
    tile.places.file = name;
    tile.tableChecksum = parser.header.tableChecksum;
    std::optional<Error> failure;
    forEachSection(tile.view, [&]<class T>(SectionId id, const char* section, std::span<const T>& span) {
        if (failure) return;
        const u32 i = u32(id) - 1;
        tile.places.offset[i] = parser.entries[i].offset;
        tile.places.packed[i] = parser.entries[i].codec != u32(SectionCodec::Raw);
        Result<std::span<const std::byte>> data = parser.readSection(i, tile);
        if (!data)
            failure = data.error();
        else if (data->size() % sizeof(T) != 0)
            failure = parser.fail(parser.entries[i].offset, "section ", section, ": ", data->size(),
                                  " bytes are no whole number of records of ", sizeof(T));
        else
            span = {reinterpret_cast<const T*>(data->data()), data->size() / sizeof(T)};
    });
    if (failure) return *failure;
    return tile;
}

} // namespace helio
