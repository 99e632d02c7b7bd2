// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "city/base/result.h"
#include "city/base/types.h"

namespace helio {

/// Reads a whole file. The error names the path and the operating system's reason.
Result<std::string> readTextFile(const std::filesystem::path& path);

/// Writes a file to a temporary name beside it and renames it when complete: never half-written.
Status writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
Status writeTextAtomically(const std::filesystem::path& path, std::string_view text);

/// Says in one line why no file can be written at `path` (its folder is missing or closed, a folder lies there): to be
/// asked before the work whose result goes there.
Status checkFileTarget(const std::filesystem::path& path);

} // namespace helio
