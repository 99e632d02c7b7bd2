// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "city/base/result.h"
#include "city/base/types.h"
#include "shaders/shared/solve.h"

namespace helio {

/// The links of a pack (see TileView), with what repacking needs to know of the nodes.
struct LinkRows
{
    std::span<const u32> rows;      ///< rowCount + 1 ascending offsets into columns
    std::span<const u32> columns;   ///< sender node
    std::span<const float> factors; ///< a link
    std::span<const float> moments; ///< two a link, or empty: constant senders
    u32 patchCount = 0;             ///< senders below this are patches, which have no slopes

    u32 rowCount() const { return u32(rows.size() - 1); }
    bool linear() const { return !moments.empty(); }
};

/// Whole rows whose records lie in one device buffer.
struct LinkPage
{
    u32 rowFirst = 0, rowCount = 0;       ///< into PackedLinks::order
    u32 recordFirst = 0, recordCount = 0; ///< into PackedLinks::records
    bool operator==(const LinkPage&) const = default;
};

/// Among so many neighbouring rows the longer ones come first, so that threads that run side by side have rows of about
/// the same length, and still write close together.
inline constexpr u32 kRowBlock = 512;

/// Links as the gather reads them, in 16-byte records. Constant senders: two links a record, rows padded to even length
/// with a link of factor 0. Linear senders: the links of a row to patches in the same way, then a LinearLinkRecord for
/// each of its links to inner nodes (as the bits of a LinkPairRecord), both in their order.
struct PackedLinks
{
    std::vector<u32> order; ///< receiver of each row
    std::vector<u32>
        rows; ///< rowCount + 1 offsets into records; linear: begin and first linear record of each row, end
    std::vector<gpu::LinkPairRecord> records;
    std::vector<LinkPage> pages; ///< cover all rows in order, empty ones too
};

/// Records of one row: of the pairs, and of all.
struct RowRecords
{
    u32 pairs = 0, all = 0;
};
RowRecords recordsOfRow(const LinkRows& links, u32 row);

/// Repacks the pack's links for a device that reads at most `maxRecordsPerPage` records from one buffer. Error: a row
/// that no page can hold, or more than 2^32 - 1 records.
Result<PackedLinks> packLinks(const LinkRows& links, u64 maxRecordsPerPage);

} // namespace helio
