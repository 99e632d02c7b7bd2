// SPDX-License-Identifier: Apache-2.0
#include "city/pack/encode_links.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "city/format/compact_links.h"

namespace helio {
namespace {

using ByteVector = std::vector<std::byte>;

void appendVarint(ByteVector& bytes, u64 value)
{
    for (; value >= 128; value >>= 7) bytes.push_back(std::byte(value & 127) | std::byte{128});
    bytes.push_back(std::byte(value));
}

ByteVector encodeColumns(const TileView& tile)
{
    ByteVector bytes;
    i64 first = 0; // of the last row with links
    for (size_t i = 0; i + 1 < tile.linkRows.size(); ++i) {
        const auto row = tile.linkColumns.subspan(tile.linkRows[i], tile.linkRows[i + 1] - tile.linkRows[i]);
        if (row.empty()) continue;
        const i64 step = i64(row[0]) - first;
        appendVarint(bytes, step < 0 ? u64(-step - 1) << 1 | 1 : u64(step) << 1);
        for (size_t k = 1; k < row.size(); ++k) {
            if (row[k] <= row[k - 1]) return {};
            appendVarint(bytes, row[k] - row[k - 1] - 1);
        }
        first = row[0];
    }
    return bytes;
}

/// Codes of a row's factors, and their sum, to be stored: no factor that comes out of it is larger than 1 or, if that
/// is more, than the largest that went in.
float encodeRow(std::span<const float> factors, std::span<u32> codes)
{
    const double largest = double(*std::max_element(factors.begin(), factors.end()));
    double sum = 0.0, squares = 0.0;
    u32 largestCode = 0;
    for (size_t k = 0; k < factors.size(); ++k) {
        sum += double(factors[k]);
        codes[k] = largest > 0.0 ? u32(std::lround(kLargestFactorCode * std::sqrt(double(factors[k]) / largest))) : 0;
        squares += double(codes[k]) * codes[k];
        largestCode = std::max(largestCode, codes[k]);
    }
    if (largestCode == 0) return 0.0f;
    const double most = std::max(1.0, largest) * squares / (double(largestCode) * largestCode);
    return sum <= most ? float(sum) : float(most * (1.0 - 1e-6)); // Not up again by rounding.
}

ByteVector encodeFactors(const TileView& tile)
{
    const std::span<const float> factors = tile.linkFactors;
    if (!std::all_of(factors.begin(), factors.end(), [](float f) { return f >= 0.0f && f <= 1.0001f; })) return {};
    ByteVector sums;
    std::vector<u32> codes(factors.size());
    for (size_t i = 0; i + 1 < tile.linkRows.size(); ++i) {
        const u32 begin = tile.linkRows[i], count = tile.linkRows[i + 1] - begin;
        if (count == 0) continue;
        const float sum = encodeRow(factors.subspan(begin, count), std::span(codes).subspan(begin, count));
        const auto bytes = std::as_bytes(std::span(&sum, 1));
        sums.insert(sums.end(), bytes.begin(), bytes.end());
    }
    ByteVector bytes = std::move(sums);
    const size_t high = bytes.size(), low = high + codes.size();
    bytes.resize(low + (codes.size() + 1) / 2);
    for (size_t k = 0; k < codes.size(); ++k) {
        bytes[high + k] = std::byte(codes[k] >> 4);
        bytes[low + k / 2] |= std::byte((codes[k] & 15) << (k % 2 * 4));
    }
    return bytes;
}

/// |moment / factor| of a link; infinite where a code cannot stand for it.
double offsetOf(float moment, float factor)
{
    if (moment == 0.0f) return 0.0;
    const double offset = std::abs(double(moment) / double(factor));
    return offset <= momentLimit(255) ? offset : HUGE_VAL;
}

/// The least code whose limit is not below `offset`.
u8 limitCode(double offset)
{
    u8 code = 0;
    while (momentLimit(code) < offset) ++code;
    return code;
}

ByteVector encodeMoments(const TileView& tile)
{
    const size_t nodeCount = tile.linkRows.size() - 1;
    std::vector<double> offsets(2 * nodeCount, 0.0); // the largest of each sender
    for (size_t k = 0; k < tile.linkColumns.size(); ++k)
        for (size_t axis = 0; axis < 2; ++axis) {
            const double offset = offsetOf(tile.linkMoments[2 * k + axis], tile.linkFactors[k]);
            if (offset == HUGE_VAL || tile.linkColumns[k] >= nodeCount) return {};
            double& largest = offsets[2 * tile.linkColumns[k] + axis];
            largest = std::max(largest, offset);
        }
    ByteVector bytes(offsets.size());
    std::transform(offsets.begin(), offsets.end(), bytes.begin(), [](double o) { return std::byte(limitCode(o)); });
    std::vector<double> limits(offsets.size());
    std::transform(bytes.begin(), bytes.begin() + std::ptrdiff_t(limits.size()), limits.begin(),
                   [](std::byte code) { return momentLimit(std::to_integer<u8>(code)); });
    for (size_t i = 0; i < nodeCount; ++i) {
        std::array<double, 2> carried{}; // what rounding took from the moments of the row so far
        for (u32 k = tile.linkRows[i]; k < tile.linkRows[i + 1]; ++k)
            for (size_t axis = 0; axis < 2; ++axis) {
                const double limit = limits[2 * tile.linkColumns[k] + axis];
                if (limit == 0.0) continue;
                const double factor = double(tile.linkFactors[k]), moment = double(tile.linkMoments[2 * k + axis]);
                i32 code = 0;
                if (factor > 0.0) {
                    // A small link cannot make up for a large one: no code moves by more than one.
                    const double steps = kLargestMomentCode / (factor * limit), own = std::round(moment * steps);
                    const double wanted = std::round((moment + carried[axis]) * steps);
                    code = i32(std::clamp(std::clamp(wanted, own - 1.0, own + 1.0), -double(kLargestMomentCode),
                                          double(kLargestMomentCode)));
                    carried[axis] += moment - code / steps;
                }
                bytes.push_back(std::byte(code + 128));
            }
    }
    return bytes;
}

} // namespace

std::vector<std::byte>* CompactLinks::of(SectionId id)
{
    ByteVector* found = id == SectionId::LinkColumns   ? &columns
                        : id == SectionId::LinkFactors ? &factors
                        : id == SectionId::LinkMoments ? &moments
                                                       : nullptr;
    return found != nullptr && !found->empty() ? found : nullptr;
}

CompactLinks encodeLinks(const TileView& tile)
{
    const u64 linkCount = tile.linkColumns.size();
    if (tile.linkFactors.size() != linkCount || !checkLinkRows(tile.linkRows, linkCount)) return {};
    CompactLinks links{encodeColumns(tile), encodeFactors(tile), {}};
    if (tile.linkMoments.size() == 2 * linkCount && linkCount > 0) links.moments = encodeMoments(tile);
    return links;
}

} // namespace helio
