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

/// Rows that may be gathered together, once those before them are done.
struct RowLevel
{
    u32 first = 0, count = 0;
    bool operator==(const RowLevel&) const = default;
};

/// Link records that lie in one device buffer, and the moment records that go with them in another.
struct LinkPage
{
    u32 recordFirst = 0, recordCount = 0, momentFirst = 0, momentCount = 0;
    bool operator==(const LinkPage&) const = default;
};

/// One dispatch of the gather: whole strips of one level, with their links in one page.
struct LinkDispatch
{
    u32 page = 0, level = 0;
    u32 rowFirst = 0, rowCount = 0; ///< into PackedLinks::rows
    bool operator==(const LinkDispatch&) const = default;
};

/// Rows are sorted by length among so many neighbours: enough for strips of equal rows, few enough that what a strip
/// reads and writes stays close together.
inline constexpr u32 kRowBlock = 8192;

/// Links as the gather reads them (shaders/shared/solve.h): strips of eight rows, four bytes a link to a patch or with
/// constant senders, six a link to an inner node with linear ones, 16 for what the short form cannot hold. Rounding in
/// the short form keeps the sum of a row's factors: what one link gains the next one loses, so that only differences
/// between senders count.
struct PackedLinks
{
    std::vector<gpu::RowRecord> rows; ///< receivers alone: parents are kNone
    std::vector<gpu::StripRecord> strips;
    std::vector<gpu::LinkQuadRecord> records; ///< LinkSingleRecords among them, as their bits
    std::vector<gpu::MomentQuadRecord> moments;
    std::vector<LinkPage> pages;
    std::vector<LinkDispatch> dispatches; ///< in the order of the levels; every row once
    u64 singles = 0;                      ///< links in full precision
    u32 factorBits = gpu::kMinFactorBits; ///< of a short link: what the columns leave

    /// Of links, moments and strips.
    u64 bytes() const;
};

struct PackOptions
{
    bool exact = false;     ///< every link in full precision
    u64 maxRecords = ~0ull; ///< that the device reads from one buffer, 16 bytes each
};

/// Repacks the pack's links. levels: cover all rows, each once, in the order in which they are gathered. Error: a strip
/// that no page can hold, or more than 2^32 - 1 records.
Result<PackedLinks> packLinks(const LinkRows& links, std::span<const RowLevel> levels, const PackOptions& options);

/// The short form of a factor in so many bits, see LinkQuadRecord; false if it is below 0, 2 or more, or not a number.
/// Factors below 2^-30 round to 0 or to it.
bool encodeFactor(double factor, u32 factorBits, u32& code);
double decodeFactor(u32 code, u32 factorBits);

} // namespace helio
