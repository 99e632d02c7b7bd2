// SPDX-License-Identifier: Apache-2.0
#include "tests/accuracy/csv_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace helio::test {
namespace {

std::vector<std::string> cells(const std::string& line)
{
    std::vector<std::string> out;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
    return out;
}

/// Not a number for text: a text column is no harm until somebody compares with it.
double number(const std::string& cell)
{
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    return !cell.empty() && *end == '\0' ? value : std::nan("");
}

} // namespace

std::vector<double> CsvTable::column(const std::string& name) const
{
    const auto found = columns.find(name);
    if (found != columns.end()) return found->second;
    ADD_FAILURE() << "no column " << name;
    return std::vector<double>(rows, 0.0);
}

CsvTable readCsvTable(const std::string& path)
{
    CsvTable table;
    std::ifstream in(path);
    EXPECT_TRUE(in.good()) << path << " cannot be opened";
    std::vector<std::string> header;
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || line[0] == '#') continue;
        const std::vector<std::string> row = cells(line);
        if (header.empty()) {
            header = row;
            continue;
        }
        EXPECT_EQ(row.size(), header.size()) << path << ", data row " << table.rows;
        for (size_t i = 0; i < header.size(); ++i)
            table.columns[header[i]].push_back(i < row.size() ? number(row[i]) : std::nan(""));
        ++table.rows;
    }
    return table;
}

} // namespace helio::test
