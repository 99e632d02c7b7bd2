// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "city/base/result.h"

namespace helio {

/// Prints what a pack is and holds: source, method, place, counts, sizes.
Status printInfo(const std::filesystem::path& folder);

/// Reads a pack with all its checks and prints one line if it is good, with the energy balance of its rows.
Status verifyPack(const std::filesystem::path& folder);

} // namespace helio
