// SPDX-License-Identifier: Apache-2.0
// The container of a tile and the index: what goes in comes out, and nothing else is read.
#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>

#include "city/base/hash.h"
#include "city/format/index_text.h"
#include "city/format/tile_reader.h"
#include "city/format/validate.h"
#include "city/pack/writer.h"
#include "tests/unit/pack_sample.h"

namespace helio {
namespace {

using test::linkedPack;
using test::samplePack;

/// Tiles in all codecs.
std::vector<EncodedTile> tilesInAllCodecs()
{
    const PackContent sample = samplePack(), linked = linkedPack();
    return {encodeTile(sample.view(), false), encodeTile(sample.view(), true), encodeTile(linked.view(), false, true),
            encodeTile(linked.view(), true, true)};
}

/// A copy in a block of exactly its size, so that a sanitizer sees a read beyond the end.
Result<LoadedTile> readCopy(const std::vector<std::byte>& bytes)
{
    const auto block = std::make_unique<std::byte[]>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), block.get());
    Result<LoadedTile> tile = readTile({block.get(), bytes.size()}, "tile");
    if (tile) tile->view = {}; // The block dies here.
    return tile;
}

void expectSame(const TileView& written, const TileView& read)
{
    std::vector<std::span<const std::byte>> all;
    forEachSection(written, [&](SectionId, const char*, const auto& span) { all.push_back(std::as_bytes(span)); });
    forEachSection(read, [&](SectionId id, const char* name, const auto& span) {
        const auto& expected = all[u32(id) - 1];
        const auto bytes = std::as_bytes(span);
        EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), expected.begin(), expected.end())) << name;
    });
}

/// Writes the header's checksum anew, as a forger would.
void sealTable(std::vector<std::byte>& bytes)
{
    const size_t place = offsetof(TileHeader, tableChecksum);
    std::memset(bytes.data() + place, 0, 8);
    const u64 checksum = hashBytes(std::span(bytes).first(kTableBytes));
    std::memcpy(bytes.data() + place, &checksum, 8);
}

TEST(PackFormat, EverySectionComesBack)
{
    PackContent content = samplePack();
    for (const bool zstd : {false, true}) {
        if (zstd) content.skyFactors.assign(content.skyFactors.size(), 0.5f);
        const EncodedTile encoded = encodeTile(content.view(), zstd);
        Result<LoadedTile> tile = readTile(encoded.bytes, "tile");
        ASSERT_TRUE(tile.ok()) << tile.error().message;
        expectSame(content.view(), tile->view);
        EXPECT_EQ(tile->tableChecksum, encoded.entry.tableChecksum);
        EXPECT_EQ(tile->unpacked.empty(), !zstd) << "zstd must pack at least the zeros of this sample";
    }
}

SectionEntry entryOf(const std::vector<std::byte>& bytes, SectionId id)
{
    SectionEntry entry;
    std::memcpy(&entry, bytes.data() + sizeof(TileHeader) + (u32(id) - 1) * sizeof entry, sizeof entry);
    return entry;
}

/// Puts a section's entry back, with the right checksums.
void sealSection(std::vector<std::byte>& bytes, SectionEntry entry)
{
    entry.checksum = hashBytes(std::span(bytes).subspan(entry.offset, entry.storedBytes));
    std::memcpy(bytes.data() + sizeof(TileHeader) + (entry.id - 1) * sizeof entry, &entry, sizeof entry);
    sealTable(bytes);
}

constexpr SectionId kLinkSections[] = {SectionId::LinkColumns, SectionId::LinkFactors, SectionId::LinkMoments};

TEST(PackFormat, CompactLinksComeBackNearly)
{
    const PackContent content = linkedPack();
    PackContent alike = content; // All links but their last digits.
    for (const bool zstd : {false, true}) {
        const EncodedTile encoded = encodeTile(content.view(), zstd, true);
        for (const SectionId id : kLinkSections) {
            const SectionEntry entry = entryOf(encoded.bytes, id);
            EXPECT_GE(entry.codec, u32(SectionCodec::Compact)) << u32(id);
            EXPECT_LT(entry.storedBytes, entry.rawBytes) << u32(id);
        }
        const Result<LoadedTile> tile = readTile(encoded.bytes, "tile");
        ASSERT_TRUE(tile.ok()) << tile.error().message;
        ASSERT_EQ(tile->view.linkFactors.size(), content.linkFactors.size());
        ASSERT_EQ(tile->view.linkMoments.size(), content.linkMoments.size());
        for (size_t k = 0; k < content.linkFactors.size(); ++k) {
            EXPECT_NEAR(tile->view.linkFactors[k], content.linkFactors[k], 2e-4f);
            for (size_t m = 2 * k; m < 2 * k + 2; ++m)
                EXPECT_NEAR(tile->view.linkMoments[m], content.linkMoments[m], content.linkFactors[k] / 60.0f);
        }
        alike.linkFactors.assign(tile->view.linkFactors.begin(), tile->view.linkFactors.end());
        alike.linkMoments.assign(tile->view.linkMoments.begin(), tile->view.linkMoments.end());
        expectSame(alike.view(), tile->view);
        EXPECT_TRUE(validateTile(tile->view, content.index, tile->places).ok());
    }
}

TEST(PackFormat, ATileTooSmallForTheCompactFormStaysAsItIs)
{
    PackContent content = samplePack();
    content.linkMoments[0] = 0.01f;
    content.linkFactors[0] = 0.0f; // A moment without a factor has no code.
    const EncodedTile encoded = encodeTile(content.view(), false, true);
    EXPECT_EQ(entryOf(encoded.bytes, SectionId::LinkColumns).codec, u32(SectionCodec::Compact));
    EXPECT_EQ(entryOf(encoded.bytes, SectionId::LinkFactors).codec, u32(SectionCodec::Raw)) << "18 bytes against 16";
    EXPECT_EQ(entryOf(encoded.bytes, SectionId::LinkMoments).codec, u32(SectionCodec::Raw));
    const Result<LoadedTile> tile = readTile(encoded.bytes, "tile");
    ASSERT_TRUE(tile.ok()) << tile.error().message;
    expectSame(content.view(), tile->view);
}

TEST(PackFormat, ForgedCompactLinksAreRefusedOrSafe)
{
    const PackContent content = linkedPack();
    const std::vector<std::byte> good = encodeTile(content.view(), false, true).bytes;
    for (const SectionId id : kLinkSections) {
        const SectionEntry entry = entryOf(good, id);
        size_t refused = 0, accepted = 0;
        for (u64 at = entry.offset; at < entry.offset + entry.storedBytes; ++at)
            for (u32 value = 0; value < 256; ++value) {
                std::vector<std::byte> bytes = good;
                bytes[at] = std::byte(value);
                sealSection(bytes, entry);
                const Result<LoadedTile> tile = readTile(bytes, "tile");
                ++(tile && validateTile(tile->view, content.index, tile->places) ? accepted : refused);
            }
        EXPECT_GT(refused, 0u) << u32(id);
        EXPECT_GT(accepted, entry.storedBytes - 1) << u32(id) << ": the byte that was there before is right";
    }
}

TEST(PackFormat, ForgedCompactTablesAreNamed)
{
    for (const bool zstd : {false, true}) {
        PackContent content = linkedPack();
        const std::vector<std::byte> good = encodeTile(content.view(), zstd, true).bytes;
        const auto errorWith = [&](SectionId id, const auto& change) {
            std::vector<std::byte> bytes = good;
            SectionEntry entry = entryOf(good, id);
            change(entry);
            sealSection(bytes, entry);
            const Result<LoadedTile> tile = readCopy(bytes);
            return tile ? std::string() : tile.error().message;
        };
        for (const SectionId id : kLinkSections) {
            for (const u64 size : {u64(1) << 40, u64(40)}) // One link more or a terabyte: nothing is allocated for it.
                EXPECT_NE(errorWith(id, [&](SectionEntry& e) { e.rawBytes = size; }), "") << u32(id) << ' ' << size;
            EXPECT_NE(errorWith(id, [](SectionEntry& e) { e.rawBytes += 2; }), "");
            EXPECT_NE(errorWith(id, [](SectionEntry& e) { e.rawBytes = e.storedBytes; }).find("cannot hold"),
                      std::string::npos);
            EXPECT_NE(errorWith(id, [](SectionEntry& e) { e.codec = 4; }).find("unknown codec 4"), std::string::npos);
            EXPECT_NE(errorWith(id, [](SectionEntry& e) { e.codec ^= 1; }), "");
        }
        EXPECT_NE(errorWith(SectionId::LinkRows, [](SectionEntry& e) { e.codec = 2; }).find("unknown codec 2"),
                  std::string::npos);
    }
}

TEST(PackFormat, RowsThatDoNotFitCompactLinksAreNamed)
{
    const std::vector<std::byte> good = encodeTile(linkedPack().view(), false, true).bytes;
    const SectionEntry rows = entryOf(good, SectionId::LinkRows);
    const auto errorWith = [&](u32 row, u32 value) {
        std::vector<std::byte> bytes = good;
        std::memcpy(bytes.data() + rows.offset + 4 * row, &value, 4);
        sealSection(bytes, rows);
        const Result<LoadedTile> tile = readCopy(bytes);
        return tile ? std::string() : tile.error().message;
    };
    EXPECT_NE(errorWith(5, 8).find("section link columns: compact links: the link rows do not hold 9 links"),
              std::string::npos);
    EXPECT_NE(errorWith(0, 1).find("do not hold 9 links"), std::string::npos);
    EXPECT_NE(errorWith(2, 0xFFFFFFFF).find("link row 3 starts before row 2"), std::string::npos);
}

TEST(PackFormat, SectionsAreAlignedAndInOrder)
{
    const EncodedTile encoded = encodeTile(samplePack().view());
    u64 end = kTableBytes;
    for (u32 i = 0; i < kSectionCount; ++i) {
        SectionEntry entry;
        std::memcpy(&entry, encoded.bytes.data() + sizeof(TileHeader) + i * sizeof entry, sizeof entry);
        EXPECT_EQ(entry.id, i + 1);
        EXPECT_EQ(entry.offset % 64, 0u);
        EXPECT_GE(entry.offset, end);
        EXPECT_LT(entry.offset, end + 64);
        end = entry.offset + entry.storedBytes;
    }
    EXPECT_EQ(end, encoded.bytes.size());
}

TEST(PackFormat, EveryTruncatedPrefixIsRejected)
{
    for (const EncodedTile& encoded : tilesInAllCodecs()) {
        for (size_t size = 0; size < encoded.bytes.size(); ++size) {
            std::vector<std::byte> prefix(encoded.bytes.begin(), encoded.bytes.begin() + std::ptrdiff_t(size));
            ASSERT_FALSE(readCopy(prefix).ok()) << size;
            if (size < kTableBytes) continue;
            const u64 forged = size; // A header that admits the shorter file must not help.
            std::memcpy(prefix.data() + offsetof(TileHeader, fileBytes), &forged, 8);
            sealTable(prefix);
            ASSERT_FALSE(readCopy(prefix).ok()) << size << " with a forged header";
        }
    }
}

TEST(PackFormat, EveryFlippedByteIsRejected)
{
    for (const EncodedTile& encoded : tilesInAllCodecs()) {
        std::vector<std::byte> bytes = encoded.bytes;
        for (size_t i = 0; i < bytes.size(); ++i) {
            bytes[i] ^= std::byte{0x20};
            ASSERT_FALSE(readCopy(bytes).ok()) << "byte " << i;
            bytes[i] ^= std::byte{0x20};
        }
    }
}

TEST(PackFormat, ExtraBytesAreRejected)
{
    std::vector<std::byte> bytes = encodeTile(samplePack().view()).bytes;
    bytes.push_back(std::byte{0});
    EXPECT_NE(readCopy(bytes).error().message.find("its header says"), std::string::npos);
    const u64 forged = bytes.size();
    std::memcpy(bytes.data() + offsetof(TileHeader, fileBytes), &forged, 8);
    sealTable(bytes);
    EXPECT_NE(readCopy(bytes).error().message.find("follow the last section"), std::string::npos);
}

TEST(PackFormat, AnotherVersionIsNamed)
{
    std::vector<std::byte> bytes = encodeTile(samplePack().view()).bytes;
    bytes[8] = std::byte{4};
    sealTable(bytes);
    EXPECT_EQ(readCopy(bytes).error().message,
              "tile: byte 8: version 4 of the format, this program reads version 3; bake the pack again");
}

TEST(PackFormat, AForgedTableIsRejected)
{
    const std::vector<std::byte> good = encodeTile(samplePack().view()).bytes;
    struct Forgery
    {
        size_t offset; // in the entry of section "children", the fourth
        u64 value;
        const char* message;
    };
    for (const Forgery& forgery : {Forgery{0, 5, "section 5 where section 4 is due"}, Forgery{8, 64, "is due"},
                                   Forgery{8, ~u64(0) << 6, "is due"}, Forgery{16, ~u64(0), "ends beyond the file"},
                                   Forgery{24, 1, "cannot hold"}, Forgery{40, 1, "reserved"}}) {
        std::vector<std::byte> bytes = good;
        std::memcpy(bytes.data() + sizeof(TileHeader) + 3 * sizeof(SectionEntry) + forgery.offset, &forgery.value,
                    forgery.offset == 0 ? 4 : 8);
        sealTable(bytes);
        const Result<LoadedTile> tile = readCopy(bytes);
        ASSERT_FALSE(tile.ok()) << forgery.message;
        EXPECT_NE(tile.error().message.find(forgery.message), std::string::npos) << tile.error().message;
    }
}

TEST(PackFormat, APartOfARecordIsRejected)
{
    PackContent content = samplePack();
    content.surfaceNames.clear();
    content.buildingIds.clear();
    content.nodeNames = "abc";
    std::vector<std::byte> bytes = encodeTile(content.view()).bytes;
    // The three bytes become the draws: section 20 takes over what follows it.
    SectionEntry draws, names;
    const size_t place = sizeof(TileHeader) + 19 * sizeof(SectionEntry);
    std::memcpy(&draws, bytes.data() + place, sizeof draws);
    std::memcpy(&names, bytes.data() + place + sizeof draws, sizeof names);
    draws.storedBytes = draws.rawBytes = draws.storedBytes - 1;
    draws.checksum = hashBytes(std::span(bytes).subspan(draws.offset, draws.storedBytes));
    bytes[draws.offset + draws.storedBytes] = std::byte{0};
    std::memcpy(bytes.data() + place, &draws, sizeof draws);
    sealTable(bytes);
    EXPECT_NE(readCopy(bytes).error().message.find("no whole number of records of 20"), std::string::npos);
}

TEST(PackFormat, ErrorsNameSectionAndByte)
{
    std::vector<std::byte> bytes = encodeTile(samplePack().view()).bytes;
    SectionEntry nodes;
    std::memcpy(&nodes, bytes.data() + sizeof(TileHeader) + sizeof(SectionEntry), sizeof nodes);
    bytes[nodes.offset + 3] ^= std::byte{1};
    EXPECT_EQ(readCopy(bytes).error().message,
              concat("tile: byte ", nodes.offset,
                     ": section nodes: the checksum of its 80 bytes does not match; bake the pack again"));
}

TEST(PackIndexText, ComesBack)
{
    const PackIndex written = samplePack().index;
    const TileEntry tile{12345, 0x0123456789ABCDEFull};
    const Result<IndexText> read = decodeIndex(encodeIndex(written, tile), "index");
    ASSERT_TRUE(read.ok()) << read.error().message;
    const PackIndex& index = read->index;
    EXPECT_EQ(index.version, kPackVersion);
    EXPECT_EQ(index.crs, written.crs);
    EXPECT_EQ(index.origin, written.origin);
    EXPECT_EQ(index.latitudeDeg, 51.9);
    EXPECT_EQ(index.longitudeDeg, 4.45);
    EXPECT_EQ(index.northDeg, -0.75);
    EXPECT_EQ(index.source, "made by hand");
    EXPECT_EQ(index.rules, "none.cga");
    EXPECT_EQ(index.method, "heliopolis");
    EXPECT_EQ(index.inputHash, 0xFEDCBA9876543210ull);
    EXPECT_EQ(index.rulesHash, 7u);
    EXPECT_EQ(index.seed, 0xFFFFFFFFFFFFFFFFull);
    EXPECT_EQ(index.options, R"({"rays":16})");
    EXPECT_EQ(index.sourceFaceCount, 3u);
    EXPECT_EQ(index.boundsMin, glm::vec3(0, 0, 0));
    EXPECT_EQ(index.boundsMax, glm::vec3(2, 1, 1));
    EXPECT_EQ(read->tile, tile);
}

TEST(PackIndexText, TruncatedOrFlippedIsRejected)
{
    std::string text = encodeIndex(samplePack().index, {1, 2});
    for (size_t size = 0; size < text.size(); ++size)
        ASSERT_FALSE(decodeIndex(text.substr(0, size), "index").ok()) << size;
    EXPECT_FALSE(decodeIndex(text + "\n", "index").ok());
    for (char& c : text) {
        c = char(c ^ 0x01);
        ASSERT_FALSE(decodeIndex(text, "index").ok());
        c = char(c ^ 0x01);
    }
}

TEST(PackIndexText, AnotherVersionIsNamed)
{
    std::string text = encodeIndex(samplePack().index, {1, 2});
    text.replace(text.find(concat(kPackVersion, "\n")), 1, "9");
    EXPECT_EQ(decodeIndex(text, "index").error().message,
              "index: byte 16: version 9 of the format, this program reads version 3; bake the pack again");
}

/// Puts the right checksum into the last line.
void seal(std::string& text)
{
    const u64 checksum = hashText(std::string_view(text).substr(0, text.rfind("xxh3")));
    for (size_t i = 0; i < 16; ++i) text[text.size() - 17 + i] = "0123456789abcdef"[(checksum >> (60 - 4 * i)) & 15];
}

TEST(PackIndexText, ValuesThatCannotBeReadAreErrors)
{
    const std::string good = encodeIndex(samplePack().index, {1, 2});
    const auto errorWith = [&](const std::string& latitude) {
        std::string text = good;
        text.replace(text.find("51.9"), 4, latitude);
        seal(text);
        const Result<IndexText> read = decodeIndex(text, "index");
        EXPECT_FALSE(read.ok()) << latitude.substr(0, 20);
        return read.ok() ? "" : read.error().message;
    };
    EXPECT_NE(errorWith("1e999").find("cannot be read"), std::string::npos);
    EXPECT_NE(errorWith("nought").find("not JSON"), std::string::npos);
    EXPECT_NE(errorWith("1, \"options\": " + std::string(1000000, '[')).find("nests deeper"), std::string::npos);
}

TEST(PackIndexText, AMemberOfAnotherTypeIsNamed)
{
    std::string text = encodeIndex(samplePack().index, {1, 2});
    text.resize(text.rfind("xxh3"));
    text.replace(text.find("51.9"), 4, "\"x\" ");
    text += concat("xxh3 ", std::string(16, '0'), "\n");
    EXPECT_NE(decodeIndex(text, "index").error().message.find("checksum"), std::string::npos);
    seal(text);
    EXPECT_NE(decodeIndex(text, "index").error().message.find("\"latitude_deg\""), std::string::npos);
}

} // namespace
} // namespace helio
