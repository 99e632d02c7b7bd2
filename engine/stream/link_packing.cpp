// SPDX-License-Identifier: Apache-2.0
#include "engine/stream/link_packing.h"

#include <algorithm>
#include <bit>

namespace helio {

namespace {

/// Appends the links of a row, two a record; links that `take` refuses are left out.
template <class Take> void appendPairs(const LinkRows& links, u32 row, Take&& take, PackedLinks& packed)
{
    bool open = false;
    for (u32 k = links.rows[row]; k < links.rows[row + 1]; ++k) {
        if (!take(links.columns[k])) continue;
        const u32 column = links.columns[k], factor = std::bit_cast<u32>(links.factors[k]);
        if (open) {
            packed.records.back().column1 = column;
            packed.records.back().factor1 = factor;
        } else {
            // The padding names the same sender again, so that it reads nothing that the row does not read.
            packed.records.push_back({column, factor, column, 0u});
        }
        open = !open;
    }
}

/// Fetches of a row: three a pair, and four a link with moments.
u64 costOf(const RowRecords& row)
{
    return 3ull * row.pairs + 4ull * (row.all - row.pairs);
}

} // namespace

RowRecords recordsOfRow(const LinkRows& links, u32 row)
{
    const u32 length = links.rows[row + 1] - links.rows[row];
    if (!links.linear()) return {(length + 1) / 2, (length + 1) / 2};
    u32 inner = 0;
    for (u32 k = links.rows[row]; k < links.rows[row + 1]; ++k) inner += links.columns[k] >= links.patchCount;
    const u32 pairs = (length - inner + 1) / 2;
    return {pairs, pairs + inner};
}

Result<PackedLinks> packLinks(const LinkRows& links, u64 maxRecordsPerPage)
{
    const auto& [rows, columns, factors, moments, patchCount] = links;
    HELIO_CHECK(!rows.empty() && rows.front() == 0 && rows.back() == columns.size() && columns.size() == factors.size(),
                rows.size(), " rows, ", columns.size(), " columns, ", factors.size(), " factors");
    HELIO_CHECK(moments.empty() || moments.size() == 2 * columns.size(), moments.size(), " moments for ",
                columns.size(), " links");
    const bool linear = links.linear();
    PackedLinks packed;
    std::vector<RowRecords> sizes;
    u64 total = 0;
    for (u32 i = 0; i < links.rowCount(); ++i) {
        sizes.push_back(recordsOfRow(links, i));
        total += sizes[i].all;
        if (sizes[i].all > maxRecordsPerPage)
            return Error{concat("node ", i, " has ", rows[i + 1] - rows[i], " links; this device reads at most ",
                                (linear ? 1 : 2) * maxRecordsPerPage, " from one buffer")};
        packed.order.push_back(i);
    }
    if (total > 0xFFFFFFFFull)
        return Error{
            concat("the tile has ", columns.size(), " links, more than a device can index; bake smaller tiles")};
    for (u32 first = 0; first < links.rowCount(); first += kRowBlock) {
        const auto begin = packed.order.begin() + first;
        std::stable_sort(begin, begin + std::min(kRowBlock, links.rowCount() - first),
                         [&](u32 a, u32 b) { return costOf(sizes[a]) > costOf(sizes[b]); });
    }

    packed.rows.reserve(linear ? 2 * rows.size() - 1 : rows.size());
    packed.records.reserve(total);
    LinkPage page;
    for (u32 k = 0; k < packed.order.size(); ++k) {
        const u32 i = packed.order[k];
        if (u64(page.recordCount) + sizes[i].all > maxRecordsPerPage) {
            packed.pages.push_back(page);
            page = {k, 0, u32(packed.records.size()), 0};
        }
        ++page.rowCount;
        page.recordCount += sizes[i].all;
        packed.rows.push_back(u32(packed.records.size()));
        appendPairs(
            links, i, [&](u32 column) { return !linear || column < patchCount; }, packed);
        if (!linear) continue;
        packed.rows.push_back(u32(packed.records.size()));
        for (u32 link = rows[i]; link < rows[i + 1]; ++link)
            if (columns[link] >= patchCount)
                packed.records.push_back(std::bit_cast<gpu::LinkPairRecord>(
                    gpu::LinearLinkRecord{columns[link], factors[link], moments[2 * link], moments[2 * link + 1]}));
    }
    packed.rows.push_back(u32(packed.records.size()));
    if (page.rowCount > 0) packed.pages.push_back(page);
    return packed;
}

} // namespace helio
