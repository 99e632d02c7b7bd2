// SPDX-License-Identifier: Apache-2.0
#include "city/format/compact_links.h"

#include <cmath>
#include <cstring>

namespace helio {
namespace {

template <class... Ts> Error fault(const Ts&... parts)
{
    return Error{concat("compact links: ", parts...)};
}

/// Reads varints: 7 bits a byte, the lowest first, the top bit set on all bytes but the last.
class VarintReader
{
public:
    explicit VarintReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    /// False at the end of the bytes, for more than 32 bits, and for a number that fewer bytes could hold.
    bool read(u32& value)
    {
        u64 sum = 0;
        for (u32 shift = 0; shift < 35 && at_ < bytes_.size(); shift += 7) {
            const u32 byte = std::to_integer<u32>(bytes_[at_++]);
            sum |= u64(byte & 127) << shift;
            if (byte >= 128) continue;
            value = u32(sum);
            return sum <= 0xFFFFFFFFu && (byte != 0 || shift == 0);
        }
        return false;
    }
    size_t place() const { return at_; }

private:
    std::span<const std::byte> bytes_;
    size_t at_ = 0;
};

size_t countFilledRows(std::span<const u32> rows)
{
    size_t count = 0;
    for (size_t i = 0; i + 1 < rows.size(); ++i) count += rows[i] != rows[i + 1] ? 1 : 0;
    return count;
}

} // namespace

double momentLimit(u8 code)
{
    return code == 0 ? 0.0 : std::ldexp(double(8 + code % 8), code / 8 - 7);
}

Status checkLinkRows(std::span<const u32> rows, u64 linkCount)
{
    if (rows.empty() || rows.front() != 0 || rows.back() != linkCount)
        return fault("the link rows do not hold ", linkCount, " links");
    for (size_t i = 1; i < rows.size(); ++i)
        if (rows[i] < rows[i - 1]) return fault("link row ", i, " starts before row ", i - 1);
    return Nothing{};
}

Status decodeLinkColumns(std::span<const std::byte> payload, std::span<const u32> rows, std::span<u32> out)
{
    VarintReader reader(payload);
    u32 first = 0; // of the last row with links
    for (size_t i = 0; i + 1 < rows.size(); ++i) {
        i64 column = first;
        for (u32 k = rows[i]; k < rows[i + 1]; ++k) {
            u32 step = 0;
            const size_t place = reader.place();
            if (!reader.read(step)) return fault("link ", k, ": no number of 32 bits at byte ", place);
            // The step from row to row has a sign, in its lowest bit; inside a row columns rise by at least one.
            if (k == rows[i])
                column += (step & 1) != 0 ? -i64(step >> 1) - 1 : i64(step >> 1);
            else
                column += i64(step) + 1;
            if (column < 0 || column > 0xFFFFFFFFll) return fault("link ", k, ": column ", column);
            out[k] = u32(column);
            if (k == rows[i]) first = u32(column);
        }
    }
    if (reader.place() != payload.size())
        return fault(payload.size() - reader.place(), " bytes follow the last column");
    return Nothing{};
}

Status decodeLinkFactors(std::span<const std::byte> payload, std::span<const u32> rows, std::span<float> out)
{
    const size_t sumBytes = countFilledRows(rows) * sizeof(float), count = out.size(), lowBytes = (count + 1) / 2;
    if (payload.size() != sumBytes + count + lowBytes)
        return fault(payload.size(), " bytes of factors where ", sumBytes + count + lowBytes, " are due");
    const std::span<const std::byte> high = payload.subspan(sumBytes, count), low = payload.last(lowBytes);
    if (count % 2 != 0 && std::to_integer<u32>(low.back()) >= 16) return fault("the last half byte is not zero");
    const auto squareAt = [&](u32 k) {
        const u32 half = std::to_integer<u32>(low[k / 2]) >> (k % 2 * 4) & 15;
        const u64 code = std::to_integer<u64>(high[k]) << 4 | half;
        return code * code;
    };
    size_t place = 0;
    for (size_t i = 0; i + 1 < rows.size(); ++i) {
        if (rows[i] == rows[i + 1]) continue;
        float sum;
        std::memcpy(&sum, payload.data() + place, sizeof sum);
        place += sizeof sum;
        u64 squares = 0;
        for (u32 k = rows[i]; k < rows[i + 1]; ++k) squares += squareAt(k);
        if (!(sum >= 0.0f) || !std::isfinite(sum) || (squares == 0 && sum != 0.0f))
            return fault("row ", i, ": the factors cannot add up to ", sum);
        for (u32 k = rows[i]; k < rows[i + 1]; ++k) out[k] = factorFromCode(sum, squareAt(k), squares);
    }
    return Nothing{};
}

Status decodeLinkMoments(std::span<const std::byte> payload, std::span<const u32> rows, std::span<const u32> columns,
                         std::span<const float> factors, std::span<float> out)
{
    const size_t tableBytes = (rows.size() - 1) * 2;
    if (columns.size() != rows.back() || factors.size() != rows.back())
        return fault(columns.size(), " columns and ", factors.size(), " factors for ", rows.back(), " links");
    if (payload.size() < tableBytes) return fault("the limits of ", rows.size() - 1, " nodes are cut off");
    size_t place = tableBytes;
    for (size_t k = 0; k < columns.size(); ++k) {
        const size_t sender = columns[k];
        if (sender >= rows.size() - 1) return fault("link ", k, ": column ", sender, " of ", rows.size() - 1);
        for (size_t axis = 0; axis < 2; ++axis) {
            const u8 limit = std::to_integer<u8>(payload[2 * sender + axis]);
            out[2 * k + axis] = 0.0f;
            if (limit == 0) continue;
            if (place == payload.size()) return fault("link ", k, ": its moments are cut off");
            const i32 code = std::to_integer<i32>(payload[place++]) - 128;
            if (code < -kLargestMomentCode) return fault("link ", k, ": code ", code, " of a moment");
            out[2 * k + axis] = momentFromCode(factors[k], momentLimit(limit), code);
        }
    }
    if (place != payload.size()) return fault(payload.size() - place, " bytes follow the last moment");
    return Nothing{};
}

} // namespace helio
