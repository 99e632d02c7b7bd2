// SPDX-License-Identifier: Apache-2.0
// The compact form of links by itself: what is kept of columns, factors and moments, and that no payload is trusted.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <sys/mman.h>

#include "city/base/hash.h"
#include "city/format/compact_links.h"
#include "city/pack/encode_links.h"

namespace helio {
namespace {

struct Links
{
    std::vector<u32> rows{0}, columns;
    std::vector<float> factors, moments;

    TileView view() const
    {
        TileView tile;
        tile.linkRows = rows;
        tile.linkColumns = columns;
        tile.linkFactors = factors;
        tile.linkMoments = moments;
        return tile;
    }
};

/// A copy that ends where memory that cannot be read begins: a read beyond it ends the test. One at a time.
class Block
{
public:
    explicit Block(const std::vector<std::byte>& from) : size_(from.size())
    {
        EXPECT_LE(size_, kRoom);
        std::copy(from.begin(), from.end(), end() - size_);
    }
    operator std::span<const std::byte>() const { return {end() - size_, size_}; }

private:
    static constexpr size_t kRoom = size_t(1) << 18, kGuard = size_t(1) << 16;

    static std::byte* end()
    {
        static std::byte* const room = [] {
            void* memory =
                mmap(nullptr, kRoom + kGuard, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
            EXPECT_NE(memory, MAP_FAILED);
            EXPECT_EQ(mprotect(static_cast<std::byte*>(memory) + kRoom, kGuard, PROT_NONE), 0);
            return static_cast<std::byte*>(memory);
        }();
        return room + kRoom;
    }
    size_t size_;
};

/// Links of `nodes` nodes with factors over six orders of magnitude; every third node sends with slopes.
Links randomLinks(u32 nodes, u64 seed)
{
    Random random(seed);
    Links links;
    for (u32 i = 0; i < nodes; ++i) {
        for (u32 j = 0; j < nodes && i % 7 != 0; ++j) {
            if (random.uniform() < 0.8) continue;
            links.columns.push_back(j);
            links.factors.push_back(float(std::pow(10.0, -6.0 * random.uniform()) / nodes));
            for (u32 axis = 0; axis < 2; ++axis)
                links.moments.push_back(
                    j % 3 == 0 ? float(double(links.factors.back()) * (4.0 * random.uniform() - 1.7)) : 0.0f);
        }
        links.rows.push_back(u32(links.columns.size()));
    }
    return links;
}

/// Decoded from what was encoded.
Links passed(const Links& links)
{
    CompactLinks packed = encodeLinks(links.view());
    Links out = links;
    Status status = decodeLinkColumns(Block(packed.columns), out.rows, out.columns);
    EXPECT_TRUE(status.ok()) << status.error().message;
    status = decodeLinkFactors(Block(packed.factors), out.rows, out.factors);
    EXPECT_TRUE(status.ok()) << status.error().message;
    status = decodeLinkMoments(Block(packed.moments), out.rows, out.columns, out.factors, out.moments);
    EXPECT_TRUE(status.ok()) << status.error().message;
    return out;
}

std::vector<std::byte> bytesOf(std::initializer_list<u32> values)
{
    std::vector<std::byte> bytes;
    for (const u32 value : values) bytes.push_back(std::byte(value));
    return bytes;
}

TEST(CompactLinks, BytesAsDocumented)
{
    // Rows of 2, 0 and 2 links; factors of a row are 1 : 4 and 1 : 1, in codes 2048 (rounded) : 4095 and 4095 twice.
    Links links{{0, 2, 2, 4}, {1, 2, 0, 1}, {0.125f, 0.5f, 0.25f, 0.25f}, {0.125f, 0, 0, 0, 0, -0.0625f, -0.0625f, 0}};
    CompactLinks packed = encodeLinks(links.view());
    // First columns: +1 (2) and -1 (1); the step from 1 to 2 and from 0 to 1 is 0 more than the least one.
    EXPECT_EQ(packed.columns, bytesOf({2, 0, 1, 0}));
    // sum 0.625f, sum 0.5f, high bytes, low halves (first link in the low half).
    EXPECT_EQ(packed.factors, bytesOf({0, 0, 0x20, 0x3F, 0, 0, 0, 0x3F, 0x80, 0xFF, 0xFF, 0xFF, 0xF0, 0xFF}));
    // Limits (x, y) of nodes 0, 1, 2: |moment / factor| is 0, 0.25 | 1, 0 | 0, 0. 0.25 = 8 x 2^-5 is code 16, 1 is code
    // 32. Codes: link 0 x = +1 x 127; link 2 y = -127; link 3 x = -0.25 x 127 = -31.75, rounded.
    EXPECT_EQ(packed.moments, bytesOf({0, 16, 32, 0, 0, 0, 255, 1, 96}));

    const Links back = passed(links);
    EXPECT_EQ(back.columns, links.columns);
    EXPECT_NEAR(back.factors[0], 0.625 * 2048 * 2048 / (2048.0 * 2048 + 4095.0 * 4095), 1e-7);
    EXPECT_EQ(back.factors[2], 0.25f);
    EXPECT_EQ(back.moments[0], back.factors[0]);
    EXPECT_EQ(back.moments[5], -0.0625f);
    EXPECT_NEAR(back.moments[6], -0.25 * 32 / 127, 1e-7);
    EXPECT_EQ(back.moments[1], 0.0f);
}

TEST(CompactLinks, LimitsRiseInSmallSteps)
{
    EXPECT_EQ(momentLimit(0), 0.0);
    EXPECT_EQ(momentLimit(1), 9.0 / 128.0);
    EXPECT_EQ(momentLimit(255), 15.0 * 16777216.0);
    for (u32 code = 1; code < 255; ++code) {
        const double ratio = momentLimit(u8(code + 1)) / momentLimit(u8(code));
        EXPECT_GT(ratio, 1.0);
        EXPECT_LE(ratio, 1.125);
    }
}

TEST(CompactLinks, RowSumsStayAndFactorsNearly)
{
    const Links links = randomLinks(200, 1), back = passed(links);
    ASSERT_GT(links.columns.size(), 5000u);
    EXPECT_EQ(back.columns, links.columns);
    for (size_t i = 0; i + 1 < links.rows.size(); ++i) {
        double sum = 0.0, sumBack = 0.0, largest = 0.0;
        for (u32 k = links.rows[i]; k < links.rows[i + 1]; ++k) {
            sum += double(links.factors[k]);
            sumBack += double(back.factors[k]);
            largest = std::max(largest, double(links.factors[k]));
        }
        EXPECT_NEAR(sumBack, sum, 2e-7 * sum) << "row " << i;
        for (u32 k = links.rows[i]; k < links.rows[i + 1]; ++k) {
            // Half a step of the code, and what restoring the sum moves: less than half a step of the largest factor.
            const double step = std::sqrt(largest) / 4095.0, factor = double(links.factors[k]);
            EXPECT_NEAR(std::sqrt(double(back.factors[k])), std::sqrt(factor), step) << "link " << k;
        }
    }
}

TEST(CompactLinks, MomentsStayWithinAStepAndTheirSumWithinHalfOfOne)
{
    Links links = randomLinks(200, 2);
    std::vector<double> limits(400, 0.0);
    for (size_t k = 0; k < links.moments.size(); ++k) {
        double& limit = limits[2 * links.columns[k / 2] + k % 2];
        limit = std::max(limit, std::abs(double(links.moments[k]) / double(links.factors[k / 2])));
    }
    const Links back = passed(links);
    for (size_t i = 0; i + 1 < links.rows.size(); ++i)
        for (size_t axis = 0; axis < 2; ++axis) {
            double sum = 0.0, largestStep = 0.0;
            for (u32 k = links.rows[i]; k < links.rows[i + 1]; ++k) {
                const double step = 1.125 * limits[2 * links.columns[k] + axis] / 127.0;
                const double offset = double(links.moments[2 * k + axis]) / double(links.factors[k]);
                if (back.factors[k] > 0.0f) {
                    EXPECT_NEAR(double(back.moments[2 * k + axis]) / double(back.factors[k]), offset, 1.5001 * step);
                }
                // With the factors as they were; what their rounding does is not the moments' matter.
                if (back.factors[k] > 0.0f)
                    sum += double(links.factors[k]) * (double(back.moments[2 * k + axis]) / double(back.factors[k])) -
                           double(links.moments[2 * k + axis]);
                largestStep = std::max(largestStep, step * double(links.factors[k]));
            }
            EXPECT_LE(std::abs(sum), 1.01 * largestStep) << "row " << i;
        }
}

TEST(CompactLinks, PackingAgainChangesNoMore)
{
    const Links once = passed(randomLinks(100, 3)), twice = passed(once);
    for (size_t k = 0; k < once.factors.size(); ++k)
        EXPECT_NEAR(twice.factors[k], once.factors[k], 1e-6f * once.factors[k]);
}

TEST(CompactLinks, FactorsNeverExceedWhatAReaderAccepts)
{
    // A million links that round to nothing: their sum would go to the one that does not.
    Links links;
    for (u32 j = 0; j < 1000000; ++j) {
        links.columns.push_back(j);
        links.factors.push_back(j == 0 ? 1.0f : 1e-8f);
    }
    links.rows.push_back(1000000);
    std::vector<float> back(links.factors.size());
    ASSERT_TRUE(decodeLinkFactors(encodeLinks(links.view()).factors, links.rows, back).ok());
    EXPECT_LE(back[0], 1.0f);
    EXPECT_GT(back[0], 0.99999f);
}

TEST(CompactLinks, WhatTheFormCannotHoldIsLeftAsItIs)
{
    const Links good = randomLinks(20, 4);
    const auto without = [&](const auto& change) {
        Links links = good;
        change(links);
        return encodeLinks(links.view());
    };
    EXPECT_TRUE(without([](Links& l) { std::swap(l.columns[0], l.columns[1]); }).columns.empty());
    EXPECT_TRUE(without([](Links& l) { l.factors[3] = 1.5f; }).factors.empty());
    EXPECT_TRUE(without([](Links& l) { l.factors[3] = NAN; }).factors.empty());
    EXPECT_TRUE(without([](Links& l) { l.moments[5] = NAN; }).moments.empty());
    EXPECT_TRUE(without([](Links& l) { l.columns.back() = 20; }).moments.empty()) << "there is no such sender";
    EXPECT_TRUE(without([](Links& l) { l.factors[1] = 0.0f, l.moments[2] = 1e-3f; }).moments.empty());
    CompactLinks rows = without([](Links& l) { l.rows[5] = 0; });
    for (const SectionId id : {SectionId::LinkColumns, SectionId::LinkFactors, SectionId::LinkMoments})
        EXPECT_EQ(rows.of(id), nullptr);
    EXPECT_TRUE(encodeLinks(Links{{0, 0}, {}, {}, {}}.view()).columns.empty());
}

/// Reads each shortened payload, which must fail, and each payload with one byte changed to any value, which must not
/// read outside; returns how many of the latter were refused.
template <class Decode> size_t damage(const std::vector<std::byte>& payload, const Decode& decode)
{
    for (size_t size = 0; size < payload.size(); ++size)
        EXPECT_FALSE(decode(Block({payload.begin(), payload.begin() + std::ptrdiff_t(size)})).ok()) << size;
    std::vector<std::byte> longer = payload;
    longer.push_back(std::byte{0});
    EXPECT_FALSE(decode(Block(longer)).ok());
    size_t refused = 0;
    for (size_t at = 0; at < payload.size(); ++at)
        for (u32 value = 0; value < 256; ++value) {
            std::vector<std::byte> bytes = payload;
            bytes[at] = std::byte(value);
            refused += decode(Block(bytes)).ok() ? 0 : 1;
        }
    return refused;
}

TEST(CompactLinks, DamagedPayloadsAreRefusedOrReadInBounds)
{
    const Links links = randomLinks(15, 5);
    const CompactLinks packed = encodeLinks(links.view());
    Links out = links;
    const auto columns = [&](const Block& b) { return decodeLinkColumns(b, out.rows, out.columns); };
    const auto factors = [&](const Block& b) { return decodeLinkFactors(b, out.rows, out.factors); };
    const auto moments = [&](const Block& b) {
        return decodeLinkMoments(b, links.rows, links.columns, links.factors, out.moments);
    };
    EXPECT_GT(damage(packed.columns, columns), 100u);
    EXPECT_GT(damage(packed.factors, factors), 100u);
    EXPECT_GT(damage(packed.moments, moments), 100u);
}

TEST(CompactLinks, ForgedNumbersAreRefused)
{
    const std::vector<u32> rows{0, 2};
    std::vector<u32> columns(2);
    const auto columnError = [&](std::initializer_list<u32> bytes) {
        const Status status = decodeLinkColumns(Block(bytesOf(bytes)), rows, columns);
        return status ? std::string() : status.error().message;
    };
    EXPECT_EQ(columnError({6, 0x80, 1}), "");
    EXPECT_EQ(columns, (std::vector<u32>{3, 132}));
    EXPECT_NE(columnError({1, 0}).find("column -1"), std::string::npos);
    EXPECT_NE(columnError({6, 0xFF, 0xFF, 0xFF, 0xFF, 0x0F}).find("link 1: column 4294967299"), std::string::npos);
    EXPECT_NE(columnError({6, 0xFF, 0xFF, 0xFF, 0xFF, 0x1F}).find("no number of 32 bits at byte 1"), std::string::npos);
    EXPECT_NE(columnError({6, 0x80, 0x80, 0x80, 0x80, 0x80, 1}).find("no number"), std::string::npos);
    EXPECT_NE(columnError({6, 0x80, 0}).find("no number"), std::string::npos) << "two bytes for nothing";

    std::vector<float> factors(2);
    const auto factorError = [&](float sum, std::initializer_list<u32> codes) {
        std::vector<std::byte> payload(4);
        std::memcpy(payload.data(), &sum, 4);
        for (const u32 code : codes) payload.push_back(std::byte(code));
        const Status status = decodeLinkFactors(Block(payload), rows, factors);
        return status ? std::string() : status.error().message;
    };
    EXPECT_EQ(factorError(0.0f, {0, 0, 0}), "");
    EXPECT_EQ(factors, (std::vector<float>{0.0f, 0.0f}));
    EXPECT_NE(factorError(0.5f, {0, 0, 0}).find("row 0: the factors cannot add up to 0.5"), std::string::npos);
    for (const float sum : {-1.0f, float(NAN), float(INFINITY)})
        EXPECT_NE(factorError(sum, {1, 1, 0}).find("cannot add up"), std::string::npos);

    EXPECT_FALSE(checkLinkRows({}, 0).ok());
    EXPECT_FALSE(checkLinkRows(std::vector<u32>{0, 3, 2}, 2).ok());
    EXPECT_FALSE(checkLinkRows(std::vector<u32>{1, 2}, 2).ok());
    EXPECT_FALSE(checkLinkRows(std::vector<u32>{0, 2}, 3).ok());
    EXPECT_TRUE(checkLinkRows(rows, 2).ok());
}

} // namespace
} // namespace helio
