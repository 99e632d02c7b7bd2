// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string_view>

#include "city/base/types.h"

namespace helio {

/// A file that the program carries inside: the shipped rule file and its assets.
struct EmbeddedFile
{
    std::string_view name; ///< "midrise.cga", or an asset as a rule names it: "facade/sill.glb"
    std::span<const std::byte> bytes;
};

/// All of them, in the order of the build file.
std::span<const EmbeddedFile> embeddedFiles();

} // namespace helio
