// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/base/result.h"
#include "city/base/types.h"

namespace helio {

// The compact form of the link sections, byte by byte in README.md; encodeLinks of city/pack makes it. The decoders
// take a payload of any content: nothing is read outside the spans, and the error names the link or byte at fault.
// `rows` must have passed checkLinkRows for as many links as `out` holds.

/// Offsets that start at 0, never fall and end at `linkCount`.
Status checkLinkRows(std::span<const u32> rows, u64 linkCount);

/// Columns rise inside a row; they may lie beyond the last node (validateTile looks).
Status decodeLinkColumns(std::span<const std::byte> payload, std::span<const u32> rows, std::span<u32> out);

/// Factors of a row add up to its stored sum. They may exceed 1 (validateTile looks).
Status decodeLinkFactors(std::span<const std::byte> payload, std::span<const u32> rows, std::span<float> out);

/// Two moments a link. `columns` and `factors` are canonical, one a link.
Status decodeLinkMoments(std::span<const std::byte> payload, std::span<const u32> rows, std::span<const u32> columns,
                         std::span<const float> factors, std::span<float> out);

/// A factor is row sum x code^2 / sum of the row's code^2.
inline constexpr u32 kLargestFactorCode = 4095;

/// A moment is factor x limit of the sender x code / 127, code in -127..127.
inline constexpr i32 kLargestMomentCode = 127;

/// Limit of |moment / factor| of a sender by its code, slope coordinates: 0 for 0, else (8 + code % 8) x 2^(code / 8 -
/// 7), from 0.0703 to 2.5e8 in steps of 7 to 12.5 %.
double momentLimit(u8 code);

/// Here, so that writer and reader round alike.
inline float factorFromCode(float rowSum, u64 square, u64 squares)
{
    return squares == 0 ? 0.0f : float(double(rowSum) * double(square) / double(squares));
}
inline float momentFromCode(float factor, double limit, i32 code)
{
    return float(double(factor) * limit * code / kLargestMomentCode);
}

} // namespace helio
