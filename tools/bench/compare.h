// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "city/base/result.h"

namespace helio {

/// The medians of the cases that two files of --json share, and their ratio second : first, as a table; the devices,
/// where they differ, above it. Error: a file that cannot be read or holds no cases.
Result<std::string> compareRuns(const std::string& first, const std::string& second);

} // namespace helio
