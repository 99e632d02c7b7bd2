// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/light/precise_polygon.h"

// The double contour integral in extended precision. Internal to city/light.
namespace helio {

/// A_a F_ab of two polygons that lie wholly before each other's planes, m2: (1 / 2 pi) sum over pairs of edges of
/// (e_p . e_q) times the double integral of ln r along them (Sparrow 1963). Parallel edges in closed form; else the
/// inner integral in closed form, the outer by tanh-sinh rules (Takahasi, Mori 1974) between the places nearest to the
/// other edge, its line and its ends, halving the step until two results agree to `tolerance` (relative). The error is
/// that difference and the rounding of all terms.
Estimate preciseContour(const PrecisePolygon& a, const PrecisePolygon& b, double tolerance);

} // namespace helio
