// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/value.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace helio::cga {

std::string_view kindOf(const Value& value)
{
    static constexpr std::string_view kKinds[] = {"a number", "true or false", "text"};
    return kKinds[value.index()];
}

std::string toText(const Value& value)
{
    if (const bool* truth = std::get_if<bool>(&value)) return *truth ? "true" : "false";
    if (const std::string* text = std::get_if<std::string>(&value)) return *text;
    char buffer[40];
    const auto result = std::to_chars(buffer, buffer + sizeof buffer, std::get<double>(value));
    return std::string(buffer, result.ptr);
}

std::optional<double> toNumber(std::string_view text)
{
    while (!text.empty() && (text.front() == ' ' || text.front() == '+')) text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    double number = 0.0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
    if (result.ec != std::errc() || result.ptr != text.data() + text.size() || !std::isfinite(number)) return {};
    return number;
}

std::optional<glm::dvec3> parseColor(std::string_view text)
{
    if ((text.size() != 7 && text.size() != 9) || text[0] != '#') return {};
    glm::dvec3 color(0.0);
    for (size_t k = 0; k + 1 < text.size(); k += 2) {
        unsigned byte = 0;
        const char* begin = text.data() + 1 + k;
        const auto result = std::from_chars(begin, begin + 2, byte, 16);
        if (result.ec != std::errc() || result.ptr != begin + 2) return {};
        if (k < 6) color[int(k / 2)] = double(byte) / 255.0;
    }
    return color;
}

std::string formatColor(const glm::dvec3& srgb)
{
    static constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text = "#";
    for (int k = 0; k < 3; ++k) {
        const auto byte = unsigned(std::lround(std::clamp(srgb[k], 0.0, 1.0) * 255.0));
        text += kDigits[byte >> 4];
        text += kDigits[byte & 15];
    }
    return text;
}

glm::dvec3 linearFromSrgb(const glm::dvec3& srgb)
{
    glm::dvec3 linear;
    for (int k = 0; k < 3; ++k)
        linear[k] = srgb[k] <= 0.04045 ? srgb[k] / 12.92 : std::pow((srgb[k] + 0.055) / 1.055, 2.4);
    return linear;
}

} // namespace helio::cga
