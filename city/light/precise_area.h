// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/light/precise_polygon.h"

// The area integral of the point factor in extended precision. Internal to city/light.
namespace helio {

/// A_s F_sl of two polygons that lie wholly before each other's planes and apart from each other, m2: Gauss points over
/// `small`, Lambert's contour formula with atan2 to `large` (Baum, Rushmeier, Winget 1989, eq. 4). The orders 4, 8, 16
/// and 32 are tried until two results agree to `tolerance` (relative); the error is their difference and the rounding.
/// Right at any distance where the orders agree, best where the gap is larger than `small`.
Estimate preciseArea(const PrecisePolygon& small, const PrecisePolygon& large, double tolerance);

} // namespace helio
