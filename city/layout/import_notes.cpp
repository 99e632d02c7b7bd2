// SPDX-License-Identifier: Apache-2.0
#include "city/layout/import_notes.h"

#include "city/base/check.h"

namespace helio {

namespace {

constexpr u32 kLinesPerKind = 20;

} // namespace

bool ImportNotes::admits(const std::string& kind)
{
    return ++lineCounts_[kind] <= kLinesPerKind;
}

void ImportNotes::feature(const std::string& id, const std::vector<Item>& items)
{
    std::string text;
    bool isKept = false;
    for (const auto& [kind, words] : items) {
        count(kind);
        isKept |= admits(kind);
        text += (text.empty() ? "" : ", ") + words;
    }
    if (isKept) lines_.push_back(concat("feature ", id, ": ", text));
}

void ImportNotes::line(const std::string& kind, std::string text)
{
    count(kind);
    if (admits(kind)) lines_.push_back(std::move(text));
}

std::vector<std::string> ImportNotes::take()
{
    for (const auto& [kind, lines] : lineCounts_)
        if (lines > kLinesPerKind) lines_.push_back(concat(kind, ": ", lines, " features, not all of them are listed"));
    lineCounts_.clear();
    return std::move(lines_);
}

} // namespace helio
