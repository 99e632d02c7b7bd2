// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "city/base/result.h"
#include "city/base/types.h"
#include "shaders/shared/solve.h"

namespace helio {

/// Whole rows whose pairs lie in one device buffer.
struct LinkPage
{
    u32 rowFirst = 0, rowCount = 0;
    u32 pairFirst = 0, pairCount = 0; ///< into PackedLinks::pairs
    bool operator==(const LinkPage&) const = default;
};

/// Links as the gather reads them: two a 16-byte fetch, rows padded to even length with a link of factor 0.
struct PackedLinks
{
    std::vector<u32> rows; ///< rowCount + 1 offsets, in pairs
    std::vector<gpu::LinkPairRecord> pairs;
    std::vector<LinkPage> pages; ///< cover all rows in order, empty ones too
};

/// Repacks the pack's links for a device that reads at most `maxPairsPerPage` pairs from one buffer. rows: rowCount + 1
/// ascending offsets into columns and factors. The order of a row's links stays. Error: a row that no page can hold, or
/// more than 2^32 pairs.
Result<PackedLinks> packLinks(std::span<const u32> rows, std::span<const u32> columns, std::span<const float> factors,
                              u64 maxPairsPerPage);

} // namespace helio
