// SPDX-License-Identifier: Apache-2.0
#include "tools/fly/script.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

namespace helio {
namespace {

constexpr double kLongestHold = 600.0; // s

struct HeldWord
{
    const char* word;
    double right, forward, up;
};
constexpr std::array<HeldWord, 7> kHeldWords{{
    {"forward", 0, 1, 0},
    {"back", 0, -1, 0},
    {"left", -1, 0, 0},
    {"right", 1, 0, 0},
    {"up", 0, 0, 1},
    {"down", 0, 0, -1},
    {"wait", 0, 0, 0},
}};

std::string_view trim(std::string_view text)
{
    constexpr std::string_view kSpace = " \t\r\n";
    const size_t begin = text.find_first_not_of(kSpace);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

std::optional<double> parseNumber(std::string_view text)
{
    text = trim(text);
    double value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<glm::dvec2> parsePair(std::string_view text)
{
    const size_t comma = text.find(',');
    if (comma == std::string_view::npos) return std::nullopt;
    const auto first = parseNumber(text.substr(0, comma)), second = parseNumber(text.substr(comma + 1));
    if (!first || !second) return std::nullopt;
    return glm::dvec2(*first, *second);
}

Result<ScriptStep> parseStep(std::string_view text)
{
    const size_t space = std::min(text.find_first_of(" \t"), text.size());
    const std::string_view word = text.substr(0, space), value = trim(text.substr(space));
    const auto refuse = [&](const char* expected) {
        return Error{concat("script step '", text, "': expected ", expected)};
    };
    ScriptStep step;
    for (const HeldWord& held : kHeldWords) {
        if (word != held.word) continue;
        const auto seconds = parseNumber(value);
        if (!seconds || *seconds < 0 || *seconds > kLongestHold) return refuse("a time between 0 and 600 seconds");
        step.input.move = {held.right, held.forward, held.up};
        step.frames = u32(std::lround(*seconds / kScriptStep));
        return step;
    }
    if (word == "turn" || word == "sun") {
        const auto pair = parsePair(value);
        if (!pair) return refuse("two angles in degrees, such as 180,30");
        if (word == "sun" && std::abs(pair->y) > 90) return refuse("an elevation between -90 and 90 degrees");
        step.kind = word == "sun" ? ScriptStep::Kind::Sun : ScriptStep::Kind::Turn;
        step.pair = *pair;
        return step;
    }
    if (word == "size") {
        const auto pair = parsePair(value);
        const auto fits = [](double side) { return side >= 16 && side <= 16384 && side == std::floor(side); };
        if (!pair || !fits(pair->x) || !fits(pair->y)) return refuse("width,height in pixels, 16 to 16384 each");
        step.kind = ScriptStep::Kind::Size;
        step.pair = *pair;
        return step;
    }
    if (word == "view") {
        const auto number = parseNumber(value);
        if (!number || *number < 1 || *number > 9 || *number != std::floor(*number))
            return refuse("a view from 1 to 9");
        step.kind = ScriptStep::Kind::View;
        step.number = u32(*number);
        return step;
    }
    if (word == "screenshot") {
        if (value.empty()) return refuse("a file name");
        step.kind = ScriptStep::Kind::Screenshot;
        step.path = value;
        return step;
    }
    return refuse("forward, back, left, right, up, down, wait, turn, sun, size, view or screenshot");
}

} // namespace

Result<std::vector<ScriptStep>> parseScript(std::string_view text)
{
    std::vector<ScriptStep> steps;
    while (!text.empty()) {
        const size_t end = std::min(text.find(';'), text.size());
        const std::string_view part = trim(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (part.empty()) continue;
        Result<ScriptStep> step = parseStep(part);
        if (!step) return step.error();
        steps.push_back(std::move(*step));
    }
    if (steps.empty()) return Error{"the script has no step"};
    return steps;
}

} // namespace helio
