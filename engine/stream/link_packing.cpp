// SPDX-License-Identifier: Apache-2.0
#include "engine/stream/link_packing.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace helio {

namespace {

constexpr u32 kMostColumns = 1u << (32 - gpu::kMinFactorBits);
constexpr int kExponentBias = 31;
constexpr int kLargestByte = 127;
constexpr u64 kRowRecords = 65000; // software devices end a shader's loops after 65 535 rounds

/// Places of a row's links, by the form that they take; each in the row's order.
struct RowParts
{
    std::vector<u32> patches, inner, singles;

    u32 patchRecords() const { return u32(patches.size() + 3) / 4; }
    u32 innerRecords() const { return u32(inner.size() + 3) / 4; }
    u32 singleRecords() const { return u32(singles.size()); }
};

/// Senders that short links of a strip can name, in two windows of columns.
struct Windows
{
    u32 patchBase = 0, innerBase = 0;
};

/// Start of the window of kMostColumns columns that holds the most of these.
u32 bestWindow(std::vector<u32>& columns)
{
    if (columns.empty()) return 0;
    std::sort(columns.begin(), columns.end());
    if (columns.back() < kMostColumns) return 0;
    size_t best = 0, most = 0;
    for (size_t first = 0, last = 0; first < columns.size(); ++first) {
        while (last < columns.size() && columns[last] - columns[first] < kMostColumns) ++last;
        if (last - first > most) most = last - first, best = first;
    }
    return columns[best];
}

class Packer
{
public:
    Packer(const LinkRows& links, const PackOptions& options) : links_(links), options_(options)
    {
        u32 last = 0;
        for (u32 k = 0; k < links.columns.size(); ++k) last = std::max(last, shortColumn(k));
        wide_ = last >= kMostColumns;
        const u32 columnBits = std::max(u32(std::bit_width(last)), 32 - gpu::kMaxFactorBits);
        packed_.factorBits = wide_ ? gpu::kMinFactorBits : 32 - columnBits;
    }

    Status level(const RowLevel& rows)
    {
        for (u32 first = 0; first < rows.count; first += kRowBlock) {
            std::vector<u32> block(std::min(kRowBlock, rows.count - first));
            for (u32 k = 0; k < block.size(); ++k) block[k] = rows.first + first + k;
            std::vector<std::pair<u32, u32>> lengths(block.size()); // inner records, patch records
            for (u32 k = 0; k < block.size(); ++k) lengths[k] = lengthOf(block[k]);
            std::stable_sort(block.begin(), block.end(), [&](u32 a, u32 b) {
                return lengths[a - rows.first - first] > lengths[b - rows.first - first];
            });
            for (size_t k = 0; k < block.size(); k += gpu::kStripRows) {
                const Status added =
                    strip(std::span(block).subspan(k, std::min<size_t>(gpu::kStripRows, block.size() - k)));
                if (!added) return added;
            }
        }
        closeDispatch();
        ++level_;
        return Nothing{};
    }

    PackedLinks finish()
    {
        if (packed_.records.size() > page_.recordFirst || packed_.pages.empty()) closePage();
        return std::move(packed_);
    }

private:
    std::pair<u32, u32> lengthOf(u32 row) const
    {
        u32 inner = 0, patches = 0;
        for (u32 k = links_.rows[row]; k < links_.rows[row + 1]; ++k)
            ++(links_.linear() && links_.columns[k] >= links_.patchCount ? inner : patches);
        return options_.exact ? std::pair(inner + patches, 0u) : std::pair((inner + 3) / 4, (patches + 3) / 4);
    }

    bool toInner(u32 link) const { return links_.linear() && links_.columns[link] >= links_.patchCount; }
    /// Where a short link's column counts from 0; with constant senders patches and inner nodes are one array.
    u32 shortColumn(u32 link) const { return links_.columns[link] - (toInner(link) ? links_.patchCount : 0); }

    Windows windowsOf(std::span<const u32> rows) const
    {
        if (!wide_) return {}; // one window holds all
        std::vector<u32> patches, inner;
        for (const u32 row : rows)
            for (u32 k = links_.rows[row]; k < links_.rows[row + 1]; ++k)
                (toInner(k) ? inner : patches).push_back(shortColumn(k));
        return {bestWindow(patches), bestWindow(inner)};
    }

    bool isShort(u32 link, const Windows& windows) const
    {
        u32 code;
        if (options_.exact || !encodeFactor(double(links_.factors[link]), packed_.factorBits, code)) return false;
        const bool inner = toInner(link);
        if (shortColumn(link) - (inner ? windows.innerBase : windows.patchBase) >= kMostColumns) return false;
        if (!inner) return true;
        const float limit = gpu::kMomentLimit * links_.factors[link];
        return std::abs(links_.moments[2 * link]) <= limit && std::abs(links_.moments[2 * link + 1]) <= limit;
    }

    RowParts partsOf(u32 row, const Windows& windows) const
    {
        RowParts parts;
        for (u32 k = links_.rows[row]; k < links_.rows[row + 1]; ++k)
            (!isShort(k, windows) ? parts.singles : toInner(k) ? parts.inner : parts.patches).push_back(k);
        return parts;
    }

    /// Codes of the links of a row, parallel to the places in `parts`. From the largest factor to the smallest each
    /// code takes over what rounding took from those before it.
    std::vector<u32> codesOf(const std::vector<u32>& all) const
    {
        std::vector<u32> order(all.size()), codes(all.size());
        for (u32 k = 0; k < order.size(); ++k) order[k] = k;
        std::stable_sort(order.begin(), order.end(),
                         [&](u32 a, u32 b) { return links_.factors[all[a]] > links_.factors[all[b]]; });
        double owed = 0.0;
        for (const u32 k : order) {
            const double factor = double(links_.factors[all[k]]);
            const double step = std::ldexp(factor, int(gpu::kExponentBits) - int(packed_.factorBits));
            // No link takes over more than its own rounding could be.
            const double wanted = factor + std::clamp(owed, -step, step);
            if (!encodeFactor(wanted, packed_.factorBits, codes[k]))
                (void)encodeFactor(factor, packed_.factorBits, codes[k]);
            owed += factor - decodeFactor(codes[k], packed_.factorBits);
        }
        return codes;
    }

    Status strip(std::span<const u32> rows)
    {
        const Windows windows = windowsOf(rows);
        std::vector<RowParts> parts;
        gpu::StripRecord strip{0, 0, windows.patchBase, windows.innerBase, 0, 0, 0, 0};
        for (const u32 row : rows) {
            parts.push_back(partsOf(row, windows));
            strip.patchRecords = std::max(strip.patchRecords, parts.back().patchRecords());
            strip.innerRecords = std::max(strip.innerRecords, parts.back().innerRecords());
            strip.singleRecords = std::max(strip.singleRecords, parts.back().singleRecords());
            packed_.singles += parts.back().singles.size();
        }
        const u64 rowRecords = u64(strip.patchRecords) + strip.innerRecords + strip.singleRecords;
        const u64 records = gpu::kStripRows * rowRecords;
        if (rowRecords > kRowRecords)
            return Error{concat("a row of nodes ", rows.front(), " to ", rows.back(), " takes ", rowRecords,
                                " records of links, more than the ", kRowRecords, " that one shader invocation reads")};
        if (records > options_.maxRecords)
            return Error{concat("the rows of nodes ", rows.front(), " to ", rows.back(), " take ", records,
                                " records of links; this device reads at most ", options_.maxRecords,
                                " from one buffer")};
        if (packed_.records.size() + records > std::numeric_limits<u32>::max())
            return Error{concat("the tile has ", links_.columns.size(),
                                " links, more than a device can index; bake smaller tiles")};
        if (packed_.records.size() - page_.recordFirst + records > options_.maxRecords) {
            closeDispatch();
            closePage();
        }
        strip.begin = u32(packed_.records.size());
        strip.momentBegin = u32(packed_.moments.size());
        packed_.strips.push_back(strip);
        packed_.records.resize(packed_.records.size() + records, {0, 0, 0, 0});
        if (links_.linear())
            packed_.moments.resize(packed_.moments.size() + gpu::kStripRows * strip.innerRecords, {0, 0});
        for (u32 r = 0; r < gpu::kStripRows; ++r) {
            packed_.rows.push_back({r < rows.size() ? rows[r] : kNoIndex, kNoIndex});
            if (r < rows.size()) writeRow(strip, r, parts[r]);
        }
        return Nothing{};
    }

    void writeRow(const gpu::StripRecord& strip, u32 r, const RowParts& parts)
    {
        std::vector<u32> all = parts.patches;
        all.insert(all.end(), parts.inner.begin(), parts.inner.end());
        const std::vector<u32> codes = codesOf(all);
        u32 at = strip.begin + r;
        const auto shorts = [&](const std::vector<u32>& links, size_t codeFirst, u32 count, u32 nodeBase) {
            for (u32 n = 0; n < count; ++n, at += gpu::kStripRows)
                for (u32 j = 0; j < 4; ++j) {
                    if (links.empty()) break;
                    // The padding names a sender of the row again, so that it reads nothing that the row does not read.
                    const size_t k = std::min<size_t>(4 * n + j, links.size() - 1);
                    const u32 column = links_.columns[links[k]] - nodeBase;
                    const u32 code = 4 * n + j < links.size() ? codes[codeFirst + k] : 0;
                    word(packed_.records[at], j) = column << packed_.factorBits | code;
                }
        };
        shorts(parts.patches, 0, strip.patchRecords, strip.patchBase);
        shorts(parts.inner, parts.patches.size(), strip.innerRecords, strip.innerBase + links_.patchCount);
        for (size_t k = 0; k < parts.inner.size(); ++k) {
            gpu::MomentQuadRecord& quad = packed_.moments[strip.momentBegin + r + k / 4 * gpu::kStripRows];
            (k % 4 < 2 ? quad.moments01 : quad.moments23) |= momentBytes(parts.inner[k]) << 16 * (k % 2);
        }
        for (u32 k = 0; k < strip.singleRecords; ++k, at += gpu::kStripRows) {
            if (parts.singles.empty()) break;
            const u32 link = parts.singles[std::min<size_t>(k, parts.singles.size() - 1)];
            gpu::LinkSingleRecord single{links_.columns[link], 0.0f, 0.0f, 0.0f};
            if (k < parts.singles.size()) {
                single.factor = links_.factors[link];
                if (toInner(link)) {
                    single.momentX = links_.moments[2 * link];
                    single.momentY = links_.moments[2 * link + 1];
                }
            }
            packed_.records[at] = std::bit_cast<gpu::LinkQuadRecord>(single);
        }
    }

    static u32& word(gpu::LinkQuadRecord& record, u32 j)
    {
        u32* const words[] = {&record.link0, &record.link1, &record.link2, &record.link3};
        return *words[j];
    }

    u32 momentBytes(u32 link) const
    {
        const auto byte = [&](float moment) {
            const double part = double(moment) / (double(links_.factors[link]) * double(gpu::kMomentLimit));
            return u32(u8(std::int8_t(std::clamp(int(std::lround(part * kLargestByte)), -kLargestByte, kLargestByte))));
        };
        if (!(links_.factors[link] > 0.0f)) return 0;
        return byte(links_.moments[2 * link]) | byte(links_.moments[2 * link + 1]) << 8;
    }

    void closeDispatch()
    {
        const u32 end = u32(packed_.rows.size());
        if (end > dispatchFirst_)
            packed_.dispatches.push_back({u32(packed_.pages.size()), level_, dispatchFirst_, end - dispatchFirst_});
        dispatchFirst_ = end;
    }

    void closePage()
    {
        page_.recordCount = u32(packed_.records.size()) - page_.recordFirst;
        page_.momentCount = u32(packed_.moments.size()) - page_.momentFirst;
        packed_.pages.push_back(page_);
        page_ = {u32(packed_.records.size()), 0, u32(packed_.moments.size()), 0};
    }

    const LinkRows& links_;
    const PackOptions& options_;
    PackedLinks packed_;
    LinkPage page_;
    bool wide_ = false;
    u32 level_ = 0, dispatchFirst_ = 0;
};

} // namespace

bool encodeFactor(double factor, u32 factorBits, u32& code)
{
    const u32 mantissas = 1u << (factorBits - gpu::kExponentBits);
    if (!(factor >= 0.0 && factor < 2.0)) return false;
    const double smallest = std::ldexp(1.0, 1 - kExponentBias);
    if (factor < smallest) {
        code = factor < 0.5 * smallest ? 0 : mantissas;
        return true;
    }
    int exponent; // factor = fraction 2^exponent, fraction in [1/2, 1)
    const double fraction = std::frexp(factor, &exponent);
    const u32 mantissa = u32(std::lround((2.0 * fraction - 1.0) * mantissas)); // may carry over into the exponent
    code = std::min(u32(exponent - 1 + kExponentBias) * mantissas + mantissa, (1u << factorBits) - 1);
    return true;
}

double decodeFactor(u32 code, u32 factorBits)
{
    const u32 mantissas = 1u << (factorBits - gpu::kExponentBits);
    if (code < mantissas) return 0.0;
    return std::ldexp(1.0 + double(code % mantissas) / mantissas, int(code / mantissas) - kExponentBias);
}

u64 PackedLinks::bytes() const
{
    return records.size() * sizeof(gpu::LinkQuadRecord) + moments.size() * sizeof(gpu::MomentQuadRecord) +
           strips.size() * sizeof(gpu::StripRecord);
}

Result<PackedLinks> packLinks(const LinkRows& links, std::span<const RowLevel> levels, const PackOptions& options)
{
    const auto& [rows, columns, factors, moments, patchCount] = links;
    HELIO_CHECK(!rows.empty() && rows.front() == 0 && rows.back() == columns.size() && columns.size() == factors.size(),
                rows.size(), " rows, ", columns.size(), " columns, ", factors.size(), " factors");
    HELIO_CHECK(moments.empty() || moments.size() == 2 * columns.size(), moments.size(), " moments for ",
                columns.size(), " links");
    u64 covered = 0;
    for (const RowLevel& level : levels) covered += level.count;
    HELIO_CHECK(covered == links.rowCount(), covered, " rows in levels of ", links.rowCount());
    Packer packer(links, options);
    for (const RowLevel& level : levels)
        if (const Status packed = packer.level(level); !packed) return packed.error();
    return packer.finish();
}

} // namespace helio
