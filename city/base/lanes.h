// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <cstring>

#include "city/base/types.h"

// Compiles a function twice, for processors with 256-bit lanes and for all others; glibc chooses one when the program
// starts, before a sanitizer is ready for it. Both give the same bits: neither fuses products with sums.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__has_attribute) && !defined(__SANITIZE_ADDRESS__) &&         \
    !defined(__SANITIZE_THREAD__)
#if __has_attribute(target_clones)
#define HELIO_LANES __attribute__((target_clones("avx2", "default")))
#endif
#endif
#ifndef HELIO_LANES
#define HELIO_LANES
#endif

namespace helio {

constexpr u32 kLanes = 8;

/// Eight floats, or four doubles, side by side: arithmetic and comparisons go lane by lane (vector types of GCC and
/// Clang). Compilers unroll short loops over arrays before they would turn them into vector code, so the kernels say it
/// themselves.
using Float8 = float __attribute__((vector_size(32)));
using Double4 = double __attribute__((vector_size(32)));
using Row8 = std::array<float, kLanes>;

[[gnu::always_inline]] inline void load(Float8& lanes, const Row8& row)
{
    std::memcpy(&lanes, row.data(), sizeof(lanes));
}

[[gnu::always_inline]] inline void store(Row8& row, const Float8& lanes)
{
    std::memcpy(row.data(), &lanes, sizeof(lanes));
}

[[gnu::always_inline]] inline void takeRoot(Double4& x)
{
    for (u32 k = 0; k < 4; ++k) x[k] = std::sqrt(x[k]);
}

[[gnu::always_inline]] inline void takeRoot(Float8& x)
{
    for (u32 k = 0; k < kLanes; ++k) x[k] = std::sqrt(x[k]);
}

[[gnu::always_inline]] inline float sumOf(const Float8& x)
{
    return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]));
}

} // namespace helio
