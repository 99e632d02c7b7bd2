// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "city/base/result.h"
#include "engine/view/renderer.h"

namespace helio {

/// Writes a PNG, 8 bits RGB (alpha is dropped), sRGB. rgba: 4 bytes a pixel, rows from the top. Atomic. Error: the
/// file.
Status writePng(const std::filesystem::path& path, u32 width, u32 height, std::span<const u8> rgba);

/// One channel of an EXR, as floats or as whole numbers.
struct ExrChannel
{
    std::string name;
    std::vector<float> floats; ///< one a pixel, or empty
    std::vector<u32> uints;    ///< one a pixel, or empty
};
/// Writes an EXR, 32-bit channels, rows from the top. Atomic. Error: the file.
Status writeExr(const std::filesystem::path& path, u32 width, u32 height, std::span<const ExrChannel> channels);

/// The values of a picture as channels: final R, G, B in W/m2/sr; E_sun, E_sky, E_indirect and radiosity R, G, B, solar
/// in W/m2; id a whole number `id` (background 0xFFFFFFFF) and its colour; depth `Z` in m (background infinite); sun
/// visibility `Y`, 0 to 1.
std::vector<ExrChannel> exrChannels(const Picture& picture, u32 mode);

} // namespace helio
