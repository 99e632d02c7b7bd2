// SPDX-License-Identifier: Apache-2.0
#include "tests/support/image_compare.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace helio {
namespace {

/// Largest channel difference of a pixel; infinite when one side alone is not finite.
double pixelDifference(const float* a, const float* b)
{
    double worst = 0;
    for (int channel = 0; channel < 3; ++channel) {
        const bool finite = std::isfinite(a[channel]) && std::isfinite(b[channel]);
        const double difference =
            finite ? std::abs(double(a[channel]) - double(b[channel])) : std::numeric_limits<double>::infinity();
        worst = std::max(worst, difference);
    }
    return worst;
}

} // namespace

Difference compareImages(const TestImage& actual, const TestImage& golden, double maxDifference)
{
    Difference result;
    result.sameSize = actual.width == golden.width && actual.height == golden.height;
    if (!result.sameSize) return result;
    double sum = 0;
    for (u32 y = 0; y < actual.height; ++y) {
        for (u32 x = 0; x < actual.width; ++x) {
            const float* a = actual.at(x, y);
            const float* b = golden.at(x, y);
            const double difference = pixelDifference(a, b);
            if (difference > maxDifference) ++result.pixelsOver;
            if (difference > result.worst) {
                result.worst = difference;
                result.worstX = x;
                result.worstY = y;
            }
            for (int channel = 0; channel < 3; ++channel) sum += std::abs(double(a[channel]) - double(b[channel]));
        }
    }
    const double pixels = double(actual.width) * actual.height;
    result.share = double(result.pixelsOver) / pixels;
    result.mean = sum / (3 * pixels);
    return result;
}

bool accepts(const Tolerance& tolerance, const Difference& difference)
{
    // Written so that a mean that is not a number is refused.
    return difference.sameSize && difference.share <= tolerance.share && difference.mean <= tolerance.meanDifference;
}

std::string describe(const Difference& difference, const Tolerance& tolerance)
{
    if (!difference.sameSize) return "sizes differ";
    return concat("pixels that differ by more than ", tolerance.maxDifference, ": ", difference.pixelsOver, " = ",
                  100 * difference.share, " % (allowed ", 100 * tolerance.share,
                  " %)\nmean difference: ", difference.mean, " (allowed ", tolerance.meanDifference,
                  ")\nworst: ", difference.worst, " at pixel ", difference.worstX, ", ", difference.worstY);
}

TestImage heatMap(const TestImage& actual, const TestImage& golden, double maxDifference)
{
    TestImage map = makeTestImage(golden.width, golden.height, 0);
    if (actual.width != golden.width || actual.height != golden.height) return map;
    const double unit = std::max(maxDifference, 1e-6);
    for (u32 y = 0; y < map.height; ++y) {
        for (u32 x = 0; x < map.width; ++x) {
            const double difference = pixelDifference(actual.at(x, y), golden.at(x, y));
            float* pixel = map.at(x, y);
            if (difference > maxDifference) {
                pixel[0] = 255;
                pixel[1] = float(255 * std::max(0.0, 1 - (difference - maxDifference) / (10 * unit)));
            } else if (difference > 0) {
                const double level = difference / unit;
                pixel[0] = pixel[1] = float(255 * level);
                pixel[2] = 255;
            }
        }
    }
    return map;
}

} // namespace helio
