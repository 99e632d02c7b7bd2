// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

namespace helio {

using u8 = std::uint8_t;
using u16 = std::uint16_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;
using i32 = std::int32_t;
using i64 = std::int64_t;

/// "No such element" in every index of the project; also the background of the sun raster.
inline constexpr u32 kNoIndex = 0xFFFFFFFFu;

} // namespace helio
