// SPDX-License-Identifier: Apache-2.0
#include "city/light/cosine_directions.h"

#include <cmath>
#include <numbers>

#include "city/base/check.h"

namespace helio {

glm::dvec3 cosineDirection(const PlaneFrame& frame, double x, double y)
{
    const double r = std::sqrt(x), phi = 2.0 * std::numbers::pi * y;
    return r * std::cos(phi) * frame.u + r * std::sin(phi) * frame.v + std::sqrt(1.0 - x) * frame.normal;
}

HELIO_LANES void cosineDirections(const PlaneFrame& frame, const Row8& x, const Row8& y,
                                  std::span<glm::dvec3> directions)
{
    HELIO_CHECK(directions.size() <= kLanes, directions.size(), " directions");
    // Half a turn less than asked, folded to within a quarter turn of 0, where the series of sine and cosine up to the
    // 11th and 12th power are right to 1e-7.
    Float8 r, turn;
    load(r, x);
    load(turn, y);
    turn -= 0.5f;
    const Float8 most = Float8{} + 0x1.fffffep-1f; // rounding must not lay a direction into the plane
    r = r < most ? r : most;
    const Float8 zero{}, one = zero + 1.0f, quarter = zero + 0.25f, half = zero + 0.5f;
    const Float8 folded = turn > quarter ? half - turn : (turn < -quarter ? -half - turn : turn);
    const Float8 sign = folded == turn ? -one : one; // of the cosine, with the half turn
    const Float8 phi = 2.0f * std::numbers::pi_v<float> * folded, q = phi * phi;
    Float8 sine = one, cosine = one;
    for (const float term : {110.0f, 72.0f, 42.0f, 20.0f, 6.0f}) sine = 1.0f - q / term * sine;
    for (const float term : {132.0f, 90.0f, 56.0f, 30.0f, 12.0f, 2.0f}) cosine = 1.0f - q / term * cosine;
    sine *= -phi;
    cosine *= sign;
    Float8 height = 1.0f - r;
    takeRoot(height);
    takeRoot(r);
    const Float8 u = r * cosine, v = r * sine;
    for (size_t k = 0; k < directions.size(); ++k)
        directions[k] = double(u[k]) * frame.u + double(v[k]) * frame.v + double(height[k]) * frame.normal;
}

} // namespace helio
