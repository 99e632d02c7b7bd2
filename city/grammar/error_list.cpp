// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/error_list.h"

#include <algorithm>

#include "city/grammar/limits.h"

namespace helio::cga {

void ErrorList::report(Place place, std::string_view message)
{
    messages_.emplace(std::tuple(place.file, place.line, place.column), message);
    if (messages_.size() <= kMaxErrors) return;
    messages_.erase(std::prev(messages_.end()));
    more_ = true;
}

void ErrorList::merge(const ErrorList& other)
{
    for (const auto& [key, message] : other.messages_)
        if (std::get<0>(key) < files_.size()) report({std::get<1>(key), std::get<2>(key), std::get<0>(key)}, message);
    more_ = more_ || other.more_;
}

Error ErrorList::join() const
{
    std::string all;
    for (const auto& [key, message] : messages_) {
        const Place place{std::get<1>(key), std::get<2>(key), std::get<0>(key)};
        if (!all.empty()) all += '\n';
        all += errorAt(files_[place.file].name, place, message).message;
        const std::string excerpt = excerptOf(files_[place.file].text, place);
        if (!excerpt.empty()) all += '\n' + excerpt;
    }
    if (more_) all += concat("\nand more: these are the first ", messages_.size(), " errors");
    return {std::move(all)};
}

std::string excerptOf(std::string_view text, Place place)
{
    constexpr u32 kWidth = 100, kBefore = 60;                       // columns
    if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3); // not counted by the lexer either
    for (u32 line = 1; line < place.line; ++line) {
        const size_t end = text.find('\n');
        if (end == std::string_view::npos) return {};
        text.remove_prefix(end + 1);
    }
    text = text.substr(0, text.find('\n'));
    while (!text.empty() && (text.back() == '\r' || text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    if (text.empty()) return {};

    const auto startsColumn = [](char c) { return (c & 0xC0) != 0x80; }; // as in the lexer
    const auto columns = u32(std::count_if(text.begin(), text.end(), startsColumn));
    const bool cut = columns > kWidth;
    const u32 last = columns + 1; // the end of the file may be the place of a mistake
    const u32 target = std::min(place.column, last);
    const u32 first = cut && target > kBefore ? target - kBefore : 1;
    std::string shown = "    ", caret = "    ";
    if (first > 1) {
        shown += "...";
        caret += "   ";
    }
    u32 column = 0;
    for (const char c : text) {
        column += startsColumn(c) ? 1u : 0u;
        if (column < first) continue;
        if (cut && column >= first + kWidth) break;
        // Other control characters would move the caret, or worse, the terminal's.
        shown += c == '\t' || u8(c) >= ' ' ? c : ' ';
        if (column < target && startsColumn(c)) caret += c == '\t' ? '\t' : ' ';
    }
    if (cut && columns >= first + kWidth) shown += "...";
    return shown + '\n' + caret + '^';
}

} // namespace helio::cga
