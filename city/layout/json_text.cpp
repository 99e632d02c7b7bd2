// SPDX-License-Identifier: Apache-2.0
#include "city/layout/json_text.h"

#include <algorithm>

#include "city/base/json_depth.h"

namespace helio {

using nlohmann::json;

std::string jsonReason(const std::exception& failure)
{
    std::string text = failure.what();
    const size_t column = text.find(", column ");
    const size_t colon = text.find(": ", column == std::string::npos ? 0 : column);
    const size_t bracket = text.find("] ");
    if (column != std::string::npos && colon != std::string::npos)
        text = text.substr(colon + 2);
    else if (bracket != std::string::npos)
        text = text.substr(bracket + 2);
    return text.substr(0, 160);
}

Result<json> parseJson(std::string_view part, std::string_view whole, std::string_view name, std::string_view advice)
{
    const size_t begin = size_t(part.data() - whole.data());
    const auto failAt = [&](size_t byte, const std::string& what) {
        const size_t place = std::min(begin + byte, whole.size());
        const auto line = 1 + std::count(whole.begin(), whole.begin() + long(place), '\n');
        return Error{concat(name, ":", line, ": byte ", place, ": ", what, "; ", advice)};
    };
    if (const std::optional<size_t> deep = findDeepJson(part))
        return failAt(*deep, concat("nests deeper than ", kMaxJsonDepth, " levels"));
    try {
        return json::parse(part);
    } catch (const json::parse_error& failure) {
        // The library counts bytes from 1.
        return failAt(std::min(failure.byte - (failure.byte > 0), part.size()),
                      concat("not JSON (", jsonReason(failure), ")"));
    } catch (const json::exception& failure) { // a number beyond any double; the library names no place
        return failAt(0, jsonReason(failure));
    }
}

const json* findMember(const json& object, const char* key)
{
    if (!object.is_object()) return nullptr;
    const auto place = object.find(key);
    return place == object.end() ? nullptr : &*place;
}

const json* findArray(const json& object, const char* key)
{
    const json* value = findMember(object, key);
    return value && value->is_array() ? value : nullptr;
}

std::string findText(const json& object, const char* key)
{
    const json* value = findMember(object, key);
    return value && value->is_string() ? value->get<std::string>() : std::string();
}

} // namespace helio
