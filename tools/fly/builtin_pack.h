// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "city/base/result.h"

namespace helio {

/// The folder where programs may keep what they can make again: $XDG_CACHE_HOME/heliopolis, else ~/.cache/heliopolis,
/// else one in the folder for temporary files.
std::filesystem::path cacheFolder();

/// A pack of the built-in city in a cache folder. Bakes it (and says so on standard output) unless this very program
/// has done so before: the program's own bytes are the key, so a program that would bake differently does. Errors are
/// one line.
Result<std::filesystem::path> builtinPack(const std::filesystem::path& folder);

} // namespace helio
