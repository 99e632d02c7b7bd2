// SPDX-License-Identifier: Apache-2.0
#include "engine/view/legend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <map>

namespace helio {

namespace {

constexpr u32 kGlyphWidth = 3, kGlyphHeight = 5, kScale = 2; // pixels, and display pixels a pixel of a glyph
constexpr u32 kBarWidth = 128, kBarHeight = 10, kMargin = 8;

/// Glyphs of 3 x 5 pixels: a row of three bits each, the upper one first.
const std::map<char, std::array<u8, kGlyphHeight>>& glyphs()
{
    static const std::map<char, std::array<u8, kGlyphHeight>> map{
        {'0', {7, 5, 5, 5, 7}}, {'1', {2, 6, 2, 2, 7}}, {'2', {7, 1, 7, 4, 7}}, {'3', {7, 1, 7, 1, 7}},
        {'4', {5, 5, 7, 1, 1}}, {'5', {7, 4, 7, 1, 7}}, {'6', {7, 4, 7, 5, 7}}, {'7', {7, 1, 2, 2, 2}},
        {'8', {7, 5, 7, 5, 7}}, {'9', {7, 5, 7, 1, 7}}, {'.', {0, 0, 0, 0, 2}}, {'-', {0, 0, 7, 0, 0}},
        {'/', {1, 1, 2, 4, 4}}, {'W', {5, 5, 5, 7, 5}}, {'m', {0, 0, 7, 7, 5}}, {'e', {0, 7, 7, 4, 7}},
        {'l', {2, 2, 2, 2, 3}}, {'v', {0, 5, 5, 5, 2}}, {'s', {0, 3, 6, 3, 6}}};
    return map;
}

double encoded(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

/// See falseColour in shaders/tone.comp.
std::array<u8, 3> falseColour(double x)
{
    const std::array<glm::dvec3, 5> stops{
        {{0.02, 0.02, 0.12}, {0.17, 0.03, 0.34}, {0.60, 0.09, 0.20}, {0.93, 0.42, 0.06}, {0.98, 0.93, 0.55}}};
    const double at = std::clamp(x, 0.0, 1.0) * 4.0;
    const size_t k = std::min<size_t>(size_t(at), 3);
    const glm::dvec3 linear = glm::mix(stops[k], stops[k + 1], at - double(k));
    const auto byte = [](double v) { return u8(std::lround(255.0 * encoded(v))); };
    return {byte(linear.r), byte(linear.g), byte(linear.b)};
}

void put(Picture& picture, u32 x, u32 y, const std::array<u8, 3>& colour)
{
    if (x >= picture.width || y >= picture.height) return;
    std::copy(colour.begin(), colour.end(), picture.display.begin() + long((size_t(y) * picture.width + x) * 4));
}

void write(Picture& picture, u32 x, u32 y, const std::string& text)
{
    for (const char c : text) {
        if (const auto glyph = glyphs().find(c); glyph != glyphs().end())
            for (u32 row = 0; row < kGlyphHeight * kScale; ++row)
                for (u32 column = 0; column < kGlyphWidth * kScale; ++column)
                    if (glyph->second[row / kScale] >> (kGlyphWidth - 1 - column / kScale) & 1)
                        put(picture, x + column, y + row, {255, 255, 255});
        x += (kGlyphWidth + 1) * kScale;
    }
}

} // namespace

void drawLegend(Picture& picture, double largest, const std::string& unit)
{
    char text[48];
    std::snprintf(text, sizeof(text), "%.3g %s", largest, unit.c_str());
    const u32 textWidth = u32(std::char_traits<char>::length(text)) * (kGlyphWidth + 1) * kScale;
    const u32 zero = (kGlyphWidth + 1) * kScale + 4;
    const u32 width = zero + kBarWidth + 6 + textWidth, height = std::max(kBarHeight, kGlyphHeight * kScale);
    if (picture.width < width + 2 * kMargin || picture.height < height + 2 * kMargin) return;
    for (u32 y = kMargin - 4; y < kMargin + height + 4; ++y)
        for (u32 x = kMargin - 4; x < kMargin + width + 4; ++x) put(picture, x, y, {0, 0, 0});
    write(picture, kMargin, kMargin, "0");
    for (u32 y = 0; y < kBarHeight; ++y)
        for (u32 x = 0; x < kBarWidth; ++x)
            put(picture, kMargin + zero + x, kMargin + y, falseColour((x + 0.5) / kBarWidth));
    write(picture, kMargin + zero + kBarWidth + 6, kMargin, text);
}

} // namespace helio
