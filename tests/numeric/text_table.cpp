// SPDX-License-Identifier: Apache-2.0
#include "tests/numeric/text_table.h"

#include <gtest/gtest.h>

#include <fstream>

namespace helio::test {
namespace {

std::vector<std::string> cellsOf(const std::string& line)
{
    std::vector<std::string> cells(1);
    for (const char c : line)
        if (c == ',')
            cells.emplace_back();
        else
            cells.back() += c;
    return cells;
}

} // namespace

std::vector<std::vector<std::string>> readTextTable(const std::string& path)
{
    std::ifstream in(path);
    EXPECT_TRUE(in.good()) << path << " cannot be opened";
    std::string line;
    std::getline(in, line);
    const size_t width = cellsOf(line).size();
    std::vector<std::vector<std::string>> rows;
    while (std::getline(in, line)) {
        rows.push_back(cellsOf(line));
        EXPECT_EQ(rows.back().size(), width) << path << ": " << line;
        rows.back().resize(width);
    }
    return rows;
}

} // namespace helio::test
