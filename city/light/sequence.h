// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "city/base/types.h"

namespace helio {

/// Point `index` of the four-dimensional Sobol sequence (direction numbers of Joe and Kuo 2008), as 32-bit fractions.
/// Any 2^k points from a multiple of 2^k on are well spread in every pair of dimensions used here.
std::array<u32, 4> sobol4(u32 index);

/// The same point shifted by a random digital shift (an exclusive or, one hash of the seed a dimension), in [0, 1).
std::array<double, 4> shiftedSobol4(u32 index, const std::array<u32, 4>& shift);

/// The shift that belongs to a seed.
std::array<u32, 4> digitalShift(u64 seed);

} // namespace helio
