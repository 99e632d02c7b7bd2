// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "city/base/result.h"

namespace helio {

/// A table of numbers by column.
struct LightCsv
{
    std::map<std::string, std::vector<double>> columns;
    size_t rows = 0;
};

/// Reads a CSV file of finite numbers with a header line; lines that start with '#' are comments. Errors name file,
/// line and column: unreadable, no header, a column twice, a row of another length, a cell that is no finite number.
Result<LightCsv> readLightCsv(const std::filesystem::path& path);

} // namespace helio
