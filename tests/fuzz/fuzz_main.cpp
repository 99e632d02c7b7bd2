// SPDX-License-Identifier: Apache-2.0
// Runs the entry point on a fixed number of mutations of good packs, the same ones every time: pack_fuzz [COUNT]
// [SEED].
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "city/base/hash.h"
#include "city/format/index_text.h"
#include "city/format/sections.h"
#include "city/pack/writer.h"
#include "tests/unit/pack_sample.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size);

namespace helio {
extern u64 acceptedTiles, acceptedIndices, refusedIndices;

namespace {

std::vector<std::uint8_t> toBytes(std::span<const std::byte> bytes)
{
    const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
    return {first, first + bytes.size()};
}

void mutate(std::vector<std::uint8_t>& bytes, Random& random)
{
    constexpr u32 kTelling[] = {0,          1,          2,          3,          0x7FFFFFFF, 0x80000000,
                                0xFFFFFFFE, 0xFFFFFFFF, 0x7F800000, 0x7FC00000, 0x3F800000};
    const auto below = [&](size_t n) { return size_t(random.next() % std::max<size_t>(n, 1)); };
    for (size_t step = 0, count = 1 + below(4); step < count && bytes.size() >= 8; ++step) {
        const size_t at = below(bytes.size()), word = below(bytes.size() / 4 - 1) * 4;
        switch (below(9)) {
        case 0:
            bytes[at] = std::uint8_t(bytes[at] ^ (1u << below(8)));
            break;
        case 1:
            bytes[at] = std::uint8_t(random.next());
            break;
        case 2:
        case 3:
            std::memcpy(&bytes[word], &kTelling[below(std::size(kTelling))], 4);
            break;
        case 4: { // A small step up or down hits counts and offsets by one.
            u32 value;
            std::memcpy(&value, &bytes[word], 4);
            value += u32(below(3)) - 1u;
            std::memcpy(&bytes[word], &value, 4);
            break;
        }
        case 5:
            std::memcpy(&bytes[word], &bytes[below(bytes.size() / 4 - 1) * 4], 4);
            break;
        case 6: { // Links are a small part of the file; aim at them on purpose.
            if (bytes.size() <= kTableBytes) break;
            SectionEntry entry;
            const size_t section = size_t(SectionId::LinkRows) - 1 + below(4);
            std::memcpy(&entry, &bytes[sizeof(TileHeader) + section * sizeof entry], sizeof entry);
            if (entry.offset < bytes.size() && entry.storedBytes <= bytes.size() - entry.offset)
                bytes[entry.offset + below(entry.storedBytes)] = std::uint8_t(random.next());
            break;
        }
        case 7: // Most of the file is table; aim at the table's fields on purpose.
            if (bytes.size() > kTableBytes)
                std::memcpy(&bytes[sizeof(TileHeader) + 8 * below(kSectionCount * 6)], &kTelling[below(4)], 4);
            break;
        default:
            if (below(4) == 0) bytes.resize(at);
            break;
        }
    }
}

/// Changes of an index that keep most of it JSON.
void mutateText(std::vector<std::uint8_t>& bytes, Random& random)
{
    constexpr std::string_view kTelling[] = {"null", "1e999", "-1",  "1e400",   "18446744073709551616",
                                             "\"\"", "[",     "]",   "{",       "}",
                                             ",",    ":",     "\"",  "\\u0000", "true",
                                             "{}",   "[[]]",  "0.5", "\xff"};
    const auto below = [&](size_t n) { return size_t(random.next() % std::max<size_t>(n, 1)); };
    const auto put = [&](size_t at, size_t gone, std::string_view text) {
        const auto first = bytes.begin() + std::ptrdiff_t(at);
        bytes.insert(bytes.erase(first, first + std::ptrdiff_t(std::min(gone, bytes.size() - at))), text.begin(),
                     text.end());
    };
    for (size_t step = 0, count = 1 + below(3); step < count && bytes.size() > 32; ++step) {
        size_t at = 17 + below(bytes.size() - 17);
        switch (below(4)) {
        case 0: { // Another value behind a colon.
            while (at + 2 < bytes.size() && bytes[at] != ':') ++at;
            size_t end = std::min(at + 2, bytes.size());
            const size_t start = end;
            while (end < bytes.size() && bytes[end] != ',' && bytes[end] != '\n') ++end;
            put(start, end - start, kTelling[below(std::size(kTelling))]);
            break;
        }
        case 1: // Digits stay digits.
            while (at + 1 < bytes.size() && (bytes[at] < '0' || bytes[at] > '9')) ++at;
            bytes[at] = std::uint8_t('0' + below(10));
            break;
        case 2:
            put(at, below(8), kTelling[below(std::size(kTelling))]);
            break;
        default: // Nesting, up to more than any stack holds.
            if (below(16) == 0) put(at, 0, std::string(size_t(1) << below(18), below(2) == 0 ? '[' : '{'));
            break;
        }
    }
}

int run(u64 count, u64 seed)
{
    const PackContent content = test::samplePack(), linked = test::linkedPack();
    const EncodedTile plain = encodeTile(content.view(), false), packed = encodeTile(content.view(), true);
    const std::string index = encodeIndex(content.index, plain.entry);
    const std::vector<std::uint8_t> seeds[] = {toBytes(plain.bytes), toBytes(packed.bytes),
                                               toBytes(std::as_bytes(std::span(index))),
                                               toBytes(encodeTile(linked.view(), false, true).bytes),
                                               toBytes(encodeTile(linked.view(), true, true).bytes)};
    for (const std::vector<std::uint8_t>& bytes : seeds) LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    constexpr u64 kGood = 8; // Four tiles, as they are and sealed.
    if (acceptedTiles != kGood) {
        std::printf("the good tiles are not accepted\n");
        return 1;
    }
    for (u64 i = 0; i < count; ++i) {
        Random random(mixSeed(seed, i));
        std::vector<std::uint8_t> bytes = seeds[i % std::size(seeds)];
        if (i % std::size(seeds) == 2 && random.next() % 4 != 0)
            mutateText(bytes, random);
        else
            mutate(bytes, random);
        LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    }
    std::printf("%llu mutated packs, %llu of them readable; indices: %llu readable, %llu not\n",
                static_cast<unsigned long long>(count), static_cast<unsigned long long>(acceptedTiles - kGood),
                static_cast<unsigned long long>(acceptedIndices), static_cast<unsigned long long>(refusedIndices));
    return acceptedTiles > kGood && acceptedIndices > 1 && refusedIndices > 0 ? 0 : 1;
}

} // namespace
} // namespace helio

int main(int argc, char** argv)
{
    const auto number = [&](int i, unsigned long long otherwise) {
        return argc > i ? std::strtoull(argv[i], nullptr, 10) : otherwise;
    };
    return helio::run(number(1, 300000), number(2, 1));
}
