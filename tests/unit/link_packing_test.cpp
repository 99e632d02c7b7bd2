// SPDX-License-Identifier: Apache-2.0
// Links in the form that the device reads: nothing is lost, and rounding stays where it belongs.
#include "engine/stream/link_packing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "city/base/hash.h"
#include "tests/support/unpack_links.h"

namespace helio {

namespace {

/// Rows of links by hand.
struct Rows
{
    std::vector<u32> rows{0}, columns;
    std::vector<float> factors, moments;
    u32 patchCount = 0;
    bool linear = false;

    void link(u32 column, float factor, float x = 0.0f, float y = 0.0f)
    {
        columns.push_back(column);
        factors.push_back(factor);
        if (linear) moments.insert(moments.end(), {x, y});
    }
    void endRow() { rows.push_back(u32(columns.size())); }
    LinkRows view() const { return {rows, columns, factors, moments, patchCount}; }
    RowLevel all() const { return {0, u32(rows.size() - 1)}; }
};

Result<PackedLinks> pack(const Rows& rows, const PackOptions& options = {})
{
    const RowLevel all = rows.all();
    return packLinks(rows.view(), {&all, 1}, options);
}

Rows randomRows(u32 rowCount, u32 nodeCount, u64 seed, bool linear)
{
    Rows r;
    r.linear = linear;
    r.patchCount = nodeCount / 2;
    Random random(seed);
    for (u32 i = 0; i < rowCount; ++i) {
        for (u32 k = 0; k < u32(random.uniform() * 40.0); ++k) {
            const float factor = float(1e-6 + 0.9 * std::pow(random.uniform(), 8.0));
            const auto part = [&] { return factor * float(3.0 * (2.0 * random.uniform() - 1.0)); };
            const float x = part();
            r.link(u32(random.uniform() * nodeCount), factor, x, part());
        }
        r.endRow();
    }
    return r;
}

TEST(LinkPacking, CodesOfFactorsAreFloatsWithoutSign)
{
    for (u32 code = 128; code < 4096; ++code) {
        u32 again = 0;
        ASSERT_TRUE(encodeFactor(decodeFactor(code, 12), 12, again));
        EXPECT_EQ(again, code);
    }
    EXPECT_EQ(decodeFactor(31 * 128, 12), 1.0);
    EXPECT_EQ(decodeFactor(30 * 128 + 64, 12), 0.75);
    EXPECT_EQ(decodeFactor(30 * 1024 + 512, 15), 0.75);
    EXPECT_EQ(decodeFactor(0, 12), 0.0);
    Random random(1);
    u32 code = 0;
    for (const u32 bits : {12u, 16u, 28u})
        for (int k = 0; k < 10000; ++k) {
            const double factor = std::pow(2.0, -29.0 * random.uniform());
            ASSERT_TRUE(encodeFactor(factor, bits, code));
            EXPECT_NEAR(decodeFactor(code, bits), factor, std::ldexp(factor, 4 - int(bits)));
        }
    EXPECT_TRUE(encodeFactor(1e-12, 12, code));
    EXPECT_EQ(code, 0u);
    for (const double bad : {-0.1, 2.0, double(NAN), double(INFINITY)})
        EXPECT_FALSE(encodeFactor(bad, 12, code)) << bad;
}

TEST(LinkPacking, ByHand)
{
    // Two patches, two inner nodes (2, 3). Row 0: five links to patches; row 1: none; row 2: a patch and an inner node.
    Rows r;
    r.linear = true;
    r.patchCount = 2;
    for (u32 k = 0; k < 5; ++k) r.link(k % 2, 0.5f);
    r.endRow();
    r.endRow();
    r.link(1, 0.25f);
    r.link(3, 0.5f, 2.0f, -1.0f); // moment over factor: the limit, and half of it with the other sign
    r.endRow();
    const auto packed = pack(r);
    ASSERT_TRUE(packed.ok());
    ASSERT_EQ(packed->rows.size(), 8u) << "a strip";
    EXPECT_EQ(packed->rows[0].receiver, 2u) << "most links with moments first";
    EXPECT_EQ(packed->rows[1].receiver, 0u);
    EXPECT_EQ(packed->rows[2].receiver, 1u);
    EXPECT_EQ(packed->rows[3].receiver, kNoIndex);
    ASSERT_EQ(packed->strips.size(), 1u);
    const gpu::StripRecord& strip = packed->strips[0];
    EXPECT_EQ(strip.patchRecords, 2u);
    EXPECT_EQ(strip.innerRecords, 1u);
    EXPECT_EQ(strip.singleRecords, 0u);
    ASSERT_EQ(packed->records.size(), 24u);
    EXPECT_EQ(packed->factorBits, 28u) << "columns of few nodes take four bits";
    EXPECT_EQ(packed->records[0].link0, 1u << 28 | 29u << 23);
    EXPECT_EQ(packed->records[0].link1, 1u << 28) << "the padding reads nothing new";
    EXPECT_EQ(packed->records[1].link3, 1u << 28 | 30u << 23);
    EXPECT_EQ(packed->records[9].link0, 30u << 23) << "the second record of a row lies eight on";
    EXPECT_EQ(packed->records[16].link0, 1u << 28 | 30u << 23) << "inner nodes count from the first";
    ASSERT_EQ(packed->moments.size(), 8u);
    EXPECT_EQ(packed->moments[0].moments01, 127u | (256u - 64u) << 8);
    EXPECT_EQ(packed->dispatches, (std::vector<LinkDispatch>{{0, 0, 0, 8}}));
    EXPECT_EQ(packed->pages, (std::vector<LinkPage>{{0, 24, 0, 8}}));
}

TEST(LinkPacking, KeepsEveryLinkAndTheSumOfARow)
{
    for (const bool linear : {false, true}) {
        const Rows r = randomRows(3000, linear ? 2000000 : 1000000, 7, linear);
        const auto packed = pack(r);
        ASSERT_TRUE(packed.ok());
        EXPECT_EQ(packed->factorBits, 12u);
        EXPECT_EQ(packed->singles, 0u);
        const auto rows = twin::unpackLinks(*packed, 3000, r.patchCount);
        for (u32 i = 0; i < 3000; ++i) {
            // Links to patches first, each kind in the row's order.
            std::vector<u32> order;
            for (u32 k = r.rows[i]; k < r.rows[i + 1]; ++k) order.push_back(k);
            if (linear)
                std::stable_partition(order.begin(), order.end(), [&](u32 k) { return r.columns[k] < r.patchCount; });
            double sum = 0.0, rounded = 0.0, largest = 0.0;
            size_t at = 0;
            for (const u32 k : order) {
                const double factor = double(r.factors[k]);
                sum += factor;
                ASSERT_LT(at, rows[i].size()) << i;
                EXPECT_EQ(rows[i][at].column, r.columns[k]);
                // Its own rounding, and what it takes over: at most as much as a step of seven bits.
                EXPECT_NEAR(rows[i][at].factor, factor, 0.015 * factor);
                if (linear && r.columns[k] >= r.patchCount) {
                    const double step = double(gpu::kMomentLimit) / 127.0;
                    EXPECT_NEAR(rows[i][at].momentX / rows[i][at].factor, double(r.moments[2 * k]) / factor,
                                0.51 * step);
                    EXPECT_NEAR(rows[i][at].momentY / rows[i][at].factor, double(r.moments[2 * k + 1]) / factor,
                                0.51 * step);
                }
                largest = std::max(largest, factor);
                ++at;
            }
            for (const twin::UnpackedLink& link : rows[i]) rounded += link.factor;
            EXPECT_NEAR(rounded, sum, largest / 256.0 + 1e-8);
        }
    }
}

TEST(LinkPacking, RoundingIsPassedOnToTheSmallestLink)
{
    Random random(9);
    for (u32 i = 0; i < 200; ++i) {
        Rows r;
        double sum = 0.0, rounded = 0.0, smallest = 1.0;
        r.patchCount = 1000000; // 12 bits are left for factors
        for (u32 k = 0; k < 20; ++k) {
            const float factor = float(0.1 * std::pow(10.0, -random.uniform()));
            r.link(999000 + k, factor);
            sum += double(factor);
            smallest = std::min(smallest, double(factor));
        }
        r.endRow();
        const auto packed = pack(r);
        ASSERT_TRUE(packed.ok());
        EXPECT_EQ(packed->factorBits, 12u);
        const auto rows = twin::unpackLinks(*packed, 1, 1000000);
        for (const twin::UnpackedLink& link : rows[0]) rounded += link.factor;
        EXPECT_NEAR(rounded, sum, smallest / 128.0) << i;
    }
}

TEST(LinkPacking, WhatTheShortFormCannotHoldStaysExact)
{
    Rows r;
    r.linear = true;
    r.patchCount = 2;
    r.link(0, 2.5f);
    r.link(3, 0.0f, 0.125f, 0.0f);
    r.link(3, 0.1f, 0.5f, 0.3f);
    r.link(2, 0.1f, 0.3f, 0.0f);
    r.endRow();
    const auto packed = pack(r);
    ASSERT_TRUE(packed.ok());
    EXPECT_EQ(packed->singles, 3u);
    const auto row = twin::unpackLinks(*packed, 1, 2)[0];
    ASSERT_EQ(row.size(), 4u);
    EXPECT_EQ(row[0].column, 2u);
    EXPECT_FALSE(row[0].single);
    EXPECT_EQ(row[1].factor, 2.5);
    EXPECT_EQ(row[2].momentX, 0.125);
    EXPECT_EQ(row[3].momentX, 0.5);
    const auto exact = pack(r, {.exact = true});
    ASSERT_TRUE(exact.ok());
    EXPECT_EQ(exact->singles, 4u);
}

TEST(LinkPacking, FarSendersStayExact)
{
    // 20 bits of column: rows of patches around 3 000 000, with a few links far from there.
    Rows r;
    r.linear = true;
    r.patchCount = 4000000;
    Random random(3);
    for (u32 i = 0; i < 64; ++i) {
        for (u32 k = 0; k < 10; ++k) r.link(3000000 + u32(random.uniform() * 500000.0), 0.01f);
        for (u32 k = 0; k < 10; ++k) r.link(r.patchCount + 2000000 + u32(random.uniform() * 500000.0), 0.01f);
        r.link(5, 0.01f);
        r.link(r.patchCount + 5, 0.01f, 0.02f, 0.0f);
        r.endRow();
    }
    const auto packed = pack(r);
    ASSERT_TRUE(packed.ok());
    EXPECT_EQ(packed->singles, 128u);
    const auto rows = twin::unpackLinks(*packed, 64, r.patchCount);
    for (u32 i = 0; i < 64; ++i) {
        ASSERT_EQ(rows[i].size(), 22u);
        for (u32 k = 0; k < 20; ++k) EXPECT_EQ(rows[i][k].column, r.columns[r.rows[i] + k]);
        EXPECT_EQ(rows[i][20].column, 5u);
        EXPECT_EQ(rows[i][21].column, r.patchCount + 5);
        EXPECT_EQ(rows[i][21].momentX, double(0.02f));
    }
}

TEST(LinkPacking, PagesAndLevelsHoldWholeStrips)
{
    const Rows r = randomRows(400, 300, 11, true);
    const std::vector<RowLevel> levels{{300, 100}, {0, 300}};
    const auto packed = packLinks(r.view(), levels, {false, 200});
    ASSERT_TRUE(packed.ok());
    EXPECT_GT(packed->pages.size(), 4u);
    std::vector<bool> seen(400, false);
    u32 next = 0, level = 0;
    for (const LinkDispatch& d : packed->dispatches) {
        EXPECT_EQ(d.rowFirst, next);
        EXPECT_EQ(d.rowCount % gpu::kStripRows, 0u);
        EXPECT_GE(d.level, level);
        level = d.level;
        const LinkPage& page = packed->pages[d.page];
        EXPECT_LE(page.recordCount, 200u);
        for (u32 row = d.rowFirst; row < d.rowFirst + d.rowCount; ++row) {
            const gpu::StripRecord& strip = packed->strips[row / gpu::kStripRows];
            EXPECT_GE(strip.begin, page.recordFirst);
            EXPECT_LE(strip.begin + gpu::kStripRows * (strip.patchRecords + strip.innerRecords + strip.singleRecords),
                      page.recordFirst + page.recordCount);
            EXPECT_GE(strip.momentBegin, page.momentFirst);
            const u32 receiver = packed->rows[row].receiver;
            if (receiver == kNoIndex) continue;
            EXPECT_EQ(receiver >= 300, d.level == 0);
            EXPECT_FALSE(seen[receiver]);
            seen[receiver] = true;
        }
        next += d.rowCount;
    }
    EXPECT_EQ(next, packed->rows.size());
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](bool s) { return s; }));
}

TEST(LinkPacking, SortsInsideBlocksAlone)
{
    // Every fifth row is longer than the others, in a block and a bit.
    Rows r;
    r.patchCount = 1;
    for (u32 i = 0; i < kRowBlock + 10; ++i) {
        for (u32 k = 0; k < (i % 5 == 4 ? 9u : 1u); ++k) r.link(0, 0.5f);
        r.endRow();
    }
    const auto packed = pack(r);
    ASSERT_TRUE(packed.ok());
    EXPECT_EQ(packed->rows[0].receiver, 4u);
    EXPECT_EQ(packed->rows[1].receiver, 9u);
    for (u32 k = 0; k < kRowBlock; ++k) EXPECT_LT(packed->rows[k].receiver, kRowBlock);
    EXPECT_EQ(packed->rows[kRowBlock].receiver % 5, 4u);
}

TEST(LinkPacking, RefusesAStripThatNoPageHolds)
{
    Rows r;
    r.patchCount = 1;
    for (u32 k = 0; k < 9; ++k) r.link(0, 0.1f);
    r.endRow();
    const auto packed = pack(r, {false, 23});
    ASSERT_FALSE(packed.ok());
    EXPECT_NE(packed.error().message.find("node"), std::string::npos) << packed.error().message;
    EXPECT_TRUE(pack(r, {false, 24}).ok());
}

TEST(LinkPacking, RefusesARowThatNoShaderReads)
{
    Rows r;
    r.patchCount = 1;
    for (u32 k = 0; k < 70000; ++k) r.link(0, 1e-5f);
    r.endRow();
    EXPECT_TRUE(pack(r).ok());
    const auto packed = pack(r, {.exact = true});
    ASSERT_FALSE(packed.ok());
    EXPECT_NE(packed.error().message.find("70000"), std::string::npos) << packed.error().message;
}

} // namespace

} // namespace helio
