// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <optional>
#include <string_view>

namespace helio {

/// Diffuse reflectance (linear Rec.709 r, g, b and broadband solar, 0..1) of a material by its name in rules, assets
/// and ground areas ("limestone", "glass", "asphalt", "street", ...); none for an unknown name.
std::optional<glm::dvec4> findMaterial(std::string_view name);

} // namespace helio
