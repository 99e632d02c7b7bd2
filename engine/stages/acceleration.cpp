// SPDX-License-Identifier: Apache-2.0
#include "engine/stages/acceleration.h"

#include <algorithm>
#include <cmath>

#include "city/base/result.h"

namespace helio {

namespace {

constexpr double kWorthIt = 0.5;    // rate of plain sweeps: below it they need few
constexpr double kGain = 1.5;       // how many plain sweeps one of the semi-iteration must be worth
constexpr double kLargest = 0.9999; // radius; at 1 the semi-iteration has no rate
constexpr float kSmallest = 1e-30f; // of a ratio's denominator: near the end of the float range ratios are noise

} // namespace

SpectralBounds spectralBounds(std::span<const glm::vec4> reflectance, std::span<const glm::vec4> planes,
                              std::span<const glm::vec4> before, std::span<const glm::vec4> after)
{
    const size_t count = reflectance.size();
    HELIO_CHECK(planes.size() == count && before.size() == count && after.size() == count, count, " patches, ",
                before.size(), " and ", after.size(), " radiosities");
    SpectralBounds bounds;
    glm::dvec4 product(0.0), square(0.0);
    for (size_t i = 0; i < count; ++i)
        for (int c = 0; c < 4; ++c) {
            if (!(before[i][c] > kSmallest) || !(reflectance[i][c] > 0.0f)) continue;
            const double x = double(before[i][c]), y = double(after[i][c]),
                         weight = double(planes[i].w) / double(reflectance[i][c]);
            bounds.upper[c] = std::max(bounds.upper[c], y / x);
            product[c] += weight * x * y;
            square[c] += weight * x * x;
        }
    for (int c = 0; c < 4; ++c)
        if (square[c] > 0.0) bounds.lower[c] = std::min(product[c] / square[c], bounds.upper[c]);
    return bounds;
}

std::string contractionNote(const Contraction& contraction, const SpectralBounds& spectrum)
{
    if (contraction.largest() < 1.0) return {};
    const glm::dvec4& u = spectrum.upper;
    const double upper = std::max(std::max(u.r, u.g), std::max(u.b, u.a));
    const std::string what =
        concat("patch ", contraction.patch, " reflects ", contraction.reflectance, " and its links add up to ",
               contraction.linkSum, ", so that the error of the light cannot be bounded");
    if (upper < 1.0) return concat(what, "; the sweeps converge all the same (by a factor of ", upper, " each)");
    return concat(what, " and the sweeps may never converge (they grow by up to ", upper,
                  "): bake more accurate links, or lower the reflectance");
}

glm::dvec4 chebyshevRadius(const SpectralBounds& spectrum, const glm::dvec4& contraction)
{
    glm::dvec4 radius(0.0);
    for (int c = 0; c < 4; ++c) {
        // The contraction number bounds the eigenvalues too.
        const double m = std::min(spectrum.upper[c], contraction[c]);
        if (!(spectrum.lower[c] >= kWorthIt) || !(m < kLargest)) continue;
        const double rate = m / (1.0 + std::sqrt(1.0 - m * m));
        if (std::log(rate) < kGain * std::log(spectrum.lower[c])) radius[c] = m;
    }
    return radius;
}

glm::dvec4 chebyshevWeight(u32 sweep, const glm::dvec4& before, const glm::dvec4& radius)
{
    if (sweep == 0) return glm::dvec4(1.0);
    const glm::dvec4 square = radius * radius;
    return 1.0 / (1.0 - (sweep == 1 ? square / 2.0 : square * before / 4.0));
}

} // namespace helio
