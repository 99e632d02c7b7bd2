// SPDX-License-Identifier: Apache-2.0
#include "tools/support/light_csv.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include "city/base/file.h"

namespace helio {
namespace {

std::vector<std::string_view> cellsOf(std::string_view line)
{
    std::vector<std::string_view> cells;
    for (size_t begin = 0; begin <= line.size();) {
        const size_t end = std::min(line.find(',', begin), line.size());
        cells.push_back(line.substr(begin, end - begin));
        begin = end + 1;
    }
    return cells;
}

} // namespace

Result<LightCsv> readLightCsv(const std::filesystem::path& path)
{
    const Result<std::string> text = readTextFile(path);
    if (!text) return text.error();
    LightCsv table;
    std::vector<std::string> header;
    std::vector<std::vector<double>*> columns;
    size_t lineNumber = 0;
    for (size_t begin = 0; begin < text->size();) {
        const size_t end = std::min(text->find('\n', begin), text->size());
        std::string_view line = std::string_view(*text).substr(begin, end - begin);
        begin = end + 1;
        ++lineNumber;
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        if (line.empty() || line[0] == '#') continue;
        const std::vector<std::string_view> cells = cellsOf(line);
        const auto wrong = [&](auto&&... what) { return Error{concat(path.string(), ":", lineNumber, ": ", what...)}; };
        if (header.empty()) {
            for (const std::string_view cell : cells) {
                const auto [place, isNew] = table.columns.try_emplace(std::string(cell));
                if (!isNew) return wrong("two columns are called ", place->first);
                header.emplace_back(cell);
                columns.push_back(&place->second);
            }
            continue;
        }
        if (cells.size() != header.size())
            return wrong(cells.size(), " cells, but the header names ", header.size(), " columns");
        for (size_t i = 0; i < cells.size(); ++i) {
            double value = 0.0;
            const char* const last = cells[i].data() + cells[i].size();
            const auto [stop, failure] = std::from_chars(cells[i].data(), last, value);
            if (failure != std::errc{} || stop != last || !std::isfinite(value))
                return wrong("column ", header[i], ": a finite number is needed");
            columns[i]->push_back(value);
        }
        ++table.rows;
    }
    if (header.empty()) return Error{concat(path.string(), ": no header line; a table of light is needed")};
    return table;
}

} // namespace helio
