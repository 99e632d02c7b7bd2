// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace helio::test {

/// Rows of a CSV file without quotes, the header left out. Fails the running test when the file cannot be read or a row
/// has not as many cells as the header.
std::vector<std::vector<std::string>> readTextTable(const std::string& path);

} // namespace helio::test
