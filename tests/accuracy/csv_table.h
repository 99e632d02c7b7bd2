// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <vector>

namespace helio::test {

/// A CSV file with a header line; lines that start with '#' are comments. Cells that are no number read as NaN.
struct CsvTable
{
    std::map<std::string, std::vector<double>> columns;
    size_t rows = 0;

    /// Fails the running test and gives zeros when the column is missing.
    std::vector<double> column(const std::string& name) const;
};

/// Fails the running test when the file cannot be read or a row has too few cells.
CsvTable readCsvTable(const std::string& path);

} // namespace helio::test
