// SPDX-License-Identifier: Apache-2.0
#include "city/format/tile_reader.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <new>
#include <zstd.h>

#include "city/base/hash.h"
#include "city/format/compact_links.h"

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

using Bytes = std::span<const std::byte>;
using Block = std::unique_ptr<std::byte[]>;

struct TileParser
{
    Bytes bytes;
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
            if (entry.codec > u32(hasCompactForm(SectionId(i + 1)) ? SectionCodec::CompactZstd : SectionCodec::Zstd))
                return fail(place + 4, "section ", section, ": unknown codec ", entry.codec);
            if (entry.zero != 0) return fail(place + 40, "section ", section, ": the reserved bytes are not zero");
            if (entry.offset != alignSection(end))
                return fail(place + 8, "section ", section, ": offset ", entry.offset, " where ", alignSection(end),
                            " is due");
            if (entry.offset > bytes.size() || entry.storedBytes > bytes.size() - entry.offset)
                return fail(place + 16, "section ", section, ": ends beyond the file of ", bytes.size(), " bytes");
            if (!canHold(entry))
                return fail(place + 24, "section ", section, ": ", entry.storedBytes, " bytes cannot hold ",
                            entry.rawBytes);
            for (u64 at = end; at < entry.offset; ++at)
                if (bytes[at] != std::byte{0}) return fail(at, "a byte between two sections is not zero");
            end = entry.offset + entry.storedBytes;
        }
        if (end != bytes.size()) return fail(end, bytes.size() - end, " bytes follow the last section");
        return Nothing{};
    }

    /// Whether the bytes in the file can be as many as the table says after unpacking. The size of what compact links
    /// unpack to follows from the link rows (expandLinks).
    static bool canHold(const SectionEntry& entry)
    {
        switch (SectionCodec(entry.codec)) {
        case SectionCodec::Raw:
            return entry.rawBytes == entry.storedBytes;
        case SectionCodec::Zstd:
            return entry.rawBytes / kLargestRatio <= entry.storedBytes;
        case SectionCodec::Compact:
        case SectionCodec::CompactZstd:
            break;
        }
        return entry.storedBytes < entry.rawBytes;
    }

    Result<Block> allocate(const char* section, u64 size) const
    {
        Block block(new (std::nothrow) std::byte[size]);
        if (!block) return Error{concat(name, ": section ", section, ": no memory for ", size, " bytes")};
        return block;
    }

    /// One zstd frame of `size` bytes after unpacking.
    Result<Block> unpackFrame(u32 i, Bytes stored, u64 size) const
    {
        const char* section = nameOf(SectionId(i + 1));
        if (ZSTD_getFrameContentSize(stored.data(), stored.size()) != size)
            return fail(entries[i].offset, "section ", section, ": the packed data do not hold ", size, " bytes");
        Result<Block> block = allocate(section, size);
        if (!block) return block;
        const size_t written = ZSTD_decompress(block->get(), size, stored.data(), stored.size());
        if (ZSTD_isError(written) || written != size)
            return fail(entries[i].offset, "section ", section, ": cannot be unpacked");
        return block;
    }

    /// The canonical form of a section of links; rows, and for moments columns and factors, have been read before it.
    Result<Block> expandLinks(u32 i, Bytes payload, const TileView& tile) const
    {
        const SectionEntry& entry = entries[i];
        const SectionId id = SectionId(i + 1);
        const char* section = nameOf(id);
        const auto place = [&](const Error& error) {
            return fail(entry.offset, "section ", section, ": ", error.message);
        };
        // A link takes a byte of columns or factors at least, and has a column before it has moments: what is
        // allocated here is in proportion to the file.
        const u64 linkBytes = id == SectionId::LinkMoments ? 2 * sizeof(float) : sizeof(u32);
        const u64 linkCount = entry.rawBytes / linkBytes;
        const bool fits = id == SectionId::LinkMoments
                              ? tile.linkColumns.size() == linkCount && tile.linkFactors.size() == linkCount
                              : payload.size() >= linkCount;
        if (entry.rawBytes % linkBytes != 0 || !fits)
            return fail(entry.offset, "section ", section, ": ", payload.size(), " bytes cannot hold ", linkCount,
                        " links");
        if (Status rows = checkLinkRows(tile.linkRows, linkCount); !rows) return place(rows.error());
        Result<Block> block = allocate(section, entry.rawBytes);
        if (!block) return block;
        const std::span<float> floats(reinterpret_cast<float*>(block->get()), entry.rawBytes / sizeof(float));
        Status status = Nothing{};
        if (id == SectionId::LinkColumns)
            status = decodeLinkColumns(payload, tile.linkRows, {reinterpret_cast<u32*>(block->get()), linkCount});
        else if (id == SectionId::LinkFactors)
            status = decodeLinkFactors(payload, tile.linkRows, floats);
        else
            status = decodeLinkMoments(payload, tile.linkRows, tile.linkColumns, tile.linkFactors, floats);
        if (!status) return place(status.error());
        return block;
    }

    /// The canonical bytes of a section: in place, or in a block that `tile` keeps.
    Result<Bytes> readSection(u32 i, LoadedTile& tile) const
    {
        const SectionEntry& entry = entries[i];
        const Bytes stored = bytes.subspan(entry.offset, entry.storedBytes);
        const char* section = nameOf(SectionId(i + 1));
        if (hashBytes(stored) != entry.checksum)
            return fail(entry.offset, "section ", section, ": the checksum of its ", entry.storedBytes,
                        " bytes does not match");
        const SectionCodec codec = SectionCodec(entry.codec);
        if (codec == SectionCodec::Raw) return stored;

        Result<Block> block = Block();
        if (codec == SectionCodec::Zstd) {
            block = unpackFrame(i, stored, entry.rawBytes);
        } else if (codec == SectionCodec::Compact) {
            block = expandLinks(i, stored, tile.view);
        } else {
            const u64 size = ZSTD_getFrameContentSize(stored.data(), stored.size());
            if (size >= entry.rawBytes || size / kLargestRatio > entry.storedBytes) // Unknown sizes are huge numbers.
                return fail(entry.offset, "section ", section, ": the packed data are no compact links");
            const Result<Block> payload = unpackFrame(i, stored, size);
            if (!payload) return payload.error();
            block = expandLinks(i, {payload->get(), size}, tile.view);
        }
        if (!block) return block.error();
        const Bytes unpacked(block->get(), entry.rawBytes);
        tile.unpacked.push_back(std::move(*block));
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
        tile.storedBytes[i] = parser.entries[i].storedBytes;
        Result<Bytes> data = parser.readSection(i, tile);
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
