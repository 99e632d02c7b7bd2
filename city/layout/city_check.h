// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/layout/city_lots.h"

// Internal to city/layout.
namespace helio {

/// True if the houses of a block can stand: every outline simple and counter-clockwise, no edge below 0.45 m, no two in
/// each other, and walls that meet share their corners or stay 0.5 m apart.
bool isBuildable(const std::vector<Lot>& lots);

} // namespace helio
