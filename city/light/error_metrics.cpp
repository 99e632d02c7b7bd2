// SPDX-License-Identifier: Apache-2.0
#include "city/light/error_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace helio {

ErrorMetrics compare(const std::vector<double>& area, const std::vector<double>& result,
                     const std::vector<double>& reference, const std::vector<double>& referenceSe,
                     const std::vector<bool>& keep)
{
    const double bad = std::numeric_limits<double>::infinity();
    const ErrorMetrics unusable{bad, bad, bad, bad, bad, bad, bad};
    const size_t faces = area.size();
    if (result.size() != faces || reference.size() != faces || referenceSe.size() != faces || keep.size() != faces)
        return unusable;
    double areaSum = 0.0, mean = 0.0, difference = 0.0, square = 0.0, noise = 0.0, meanVariance = 0.0;
    std::vector<std::pair<double, double>> magnitudes; // |e - r|, area
    for (size_t i = 0; i < area.size(); ++i) {
        if (!keep[i]) continue;
        const double d = result[i] - reference[i], variance = referenceSe[i] * referenceSe[i];
        areaSum += area[i];
        mean += area[i] * reference[i];
        difference += area[i] * d;
        square += area[i] * d * d;
        noise += area[i] * variance;
        meanVariance += area[i] * area[i] * variance;
        magnitudes.emplace_back(std::abs(d), area[i]);
    }
    if (!std::isfinite(square) || !std::isfinite(noise) || !(areaSum > 0.0)) return unusable;
    mean /= areaSum;
    if (mean == 0.0) return square == 0.0 ? ErrorMetrics{} : unusable;
    std::sort(magnitudes.begin(), magnitudes.end());
    ErrorMetrics metrics;
    metrics.rms = std::sqrt(std::max(0.0, (square - noise) / areaSum)) / mean;
    metrics.bias = difference / areaSum / mean;
    metrics.noise = std::sqrt(noise / areaSum) / mean;
    metrics.biasError = std::sqrt(meanVariance) / areaSum / mean;
    metrics.largest = magnitudes.back().first / mean;
    metrics.mean = mean;
    double below = 0.0;
    for (const auto& [magnitude, weight] : magnitudes) {
        below += weight;
        metrics.p95 = magnitude / mean;
        if (below >= 0.95 * areaSum) break;
    }
    return metrics;
}

} // namespace helio
