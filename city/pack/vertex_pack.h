// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

#include "city/base/types.h"

namespace helio {

/// A unit vector as A2B10G10R10_SNORM: x in the lowest ten bits, two's complement, 511 = 1.
inline u32 packNormal(const glm::dvec3& normal)
{
    const auto ten = [](double x) { return u32(i32(std::lround(std::clamp(x, -1.0, 1.0) * 511.0))) & 1023u; };
    return ten(normal.x) | ten(normal.y) << 10 | ten(normal.z) << 20;
}

/// A linear colour as R8G8B8A8_UNORM, clamped to 0..1; alpha 0 for glass, else 255.
inline u32 packAlbedo(const glm::dvec3& rgb, bool glass = false)
{
    const auto eight = [](double x) { return u32(std::lround(std::clamp(x, 0.0, 1.0) * 255.0)); };
    return eight(rgb.r) | eight(rgb.g) << 8 | eight(rgb.b) << 16 | (glass ? 0u : 255u << 24);
}

} // namespace helio
