// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "tests/support/image_file.h"

namespace helio {

/// How far a picture may be from its golden, in the picture's own units (steps of 1/255, or W/m2).
struct Tolerance
{
    double maxDifference = 0;  ///< largest channel difference that a pixel may have...
    double share = 0;          ///< ...but for this share of the pixels, which may have any
    double meanDifference = 0; ///< mean over all channels of the absolute difference
};

/// No pixel may differ.
inline constexpr Tolerance kIdentical{};

struct Difference
{
    bool sameSize = false;
    u64 pixelsOver =
        0;            ///< pixels with a channel that differs by more than Tolerance::maxDifference, or is not a number
    double share = 0; ///< pixelsOver over all pixels
    double worst = 0; ///< largest channel difference
    u32 worstX = 0, worstY = 0;
    double mean = 0; ///< of the absolute difference over all channels
};

/// Compares two pictures; all but sameSize is zero when their sizes differ.
Difference compareImages(const TestImage& actual, const TestImage& golden, double maxDifference);

/// Is the difference within the tolerance?
bool accepts(const Tolerance& tolerance, const Difference& difference);

/// The numbers and limits in a few lines.
std::string describe(const Difference& difference, const Tolerance& tolerance);

/// Where the pictures differ: black = equal, blue to white = up to the tolerance, yellow to red = over it. Values
/// 0..255.
TestImage heatMap(const TestImage& actual, const TestImage& golden, double maxDifference);

} // namespace helio
