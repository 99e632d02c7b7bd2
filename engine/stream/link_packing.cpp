// SPDX-License-Identifier: Apache-2.0
#include "engine/stream/link_packing.h"

#include <bit>

namespace helio {

Result<PackedLinks> packLinks(std::span<const u32> rows, std::span<const u32> columns, std::span<const float> factors,
                              u64 maxPairsPerPage)
{
    HELIO_CHECK(!rows.empty() && rows.front() == 0 && rows.back() == columns.size() && columns.size() == factors.size(),
                rows.size(), " rows, ", columns.size(), " columns, ", factors.size(), " factors");
    const u32 rowCount = u32(rows.size() - 1);
    u64 total = 0;
    for (u32 i = 0; i < rowCount; ++i) total += (u64(rows[i + 1]) - rows[i] + 1) / 2;
    if (total > 0xFFFFFFFFull)
        return Error{
            concat("the tile has ", columns.size(), " links, more than a device can index; bake smaller tiles")};

    PackedLinks packed;
    packed.rows.reserve(rows.size());
    packed.pairs.reserve(total);
    LinkPage page;
    for (u32 i = 0; i < rowCount; ++i) {
        const u32 length = rows[i + 1] - rows[i];
        const u32 pairCount = (length + 1) / 2;
        if (pairCount > maxPairsPerPage)
            return Error{concat("node ", i, " has ", length, " links; this device reads at most ", 2 * maxPairsPerPage,
                                " from one buffer")};
        if (u64(page.pairCount) + pairCount > maxPairsPerPage) {
            packed.pages.push_back(page);
            page = {i, 0, u32(packed.pairs.size()), 0};
        }
        ++page.rowCount;
        page.pairCount += pairCount;
        packed.rows.push_back(u32(packed.pairs.size()));
        for (u32 k = rows[i]; k < rows[i + 1]; k += 2) {
            const bool both = k + 1 < rows[i + 1];
            // The padding names the first sender again, so that it reads nothing that the row does not read.
            packed.pairs.push_back({columns[k], std::bit_cast<u32>(factors[k]), columns[both ? k + 1 : k],
                                    both ? std::bit_cast<u32>(factors[k + 1]) : 0u});
        }
    }
    packed.rows.push_back(u32(packed.pairs.size()));
    if (page.rowCount > 0) packed.pages.push_back(page);
    return packed;
}

} // namespace helio
