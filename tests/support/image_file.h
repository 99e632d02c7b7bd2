// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "city/base/result.h"
#include "city/base/types.h"

namespace helio {

/// A picture of three channels, rows from the top. From a PNG: 0..255, the bytes as they are. From an EXR: linear
/// values.
struct TestImage
{
    u32 width = 0;
    u32 height = 0;
    std::vector<float> rgb; ///< 3 x width x height

    const float* at(u32 x, u32 y) const { return rgb.data() + (size_t(y) * width + x) * 3; }
    float* at(u32 x, u32 y) { return rgb.data() + (size_t(y) * width + x) * 3; }
};

/// A picture of one colour.
TestImage makeTestImage(u32 width, u32 height, float value);

/// Reads a picture by its extension, .png or .exr (channels R, G and B). Errors name the file and the library's reason.
Result<TestImage> readTestImage(const std::filesystem::path& path);

/// Writes .png (values rounded and clamped to 0..255) or .exr (half floats). Errors name the file.
Status writeTestImage(const std::filesystem::path& path, const TestImage& image);

} // namespace helio
