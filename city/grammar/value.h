// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "city/model/footprint.h"

namespace helio::cga {

/// A value of the language: number, truth value or text.
using Value = Attribute;

/// "a number", "true or false" or "text", for messages.
std::string_view kindOf(const Value& value);
/// A value as text: numbers in the shortest form that reads back the same, without a decimal point where they are
/// whole.
std::string toText(const Value& value);
/// The whole text as a finite number, or nothing.
std::optional<double> toNumber(std::string_view text);

/// Reads "#rrggbb" (a trailing alpha pair is ignored) as sRGB 0..1.
std::optional<glm::dvec3> parseColor(std::string_view text);
/// sRGB 0..1 as "#rrggbb"; values are clamped.
std::string formatColor(const glm::dvec3& srgb);
/// sRGB 0..1 to linear Rec.709 (IEC 61966-2-1).
glm::dvec3 linearFromSrgb(const glm::dvec3& srgb);

} // namespace helio::cga
