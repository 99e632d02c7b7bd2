// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <string_view>

namespace helio {

/// A named material: what `set(material.name, "limestone")` of a rule, a material of an asset or a ground area means to
/// the light.
struct Material
{
    std::string_view name;
    glm::dvec4 rho{0.0}; ///< diffuse reflectance, linear Rec.709 r, g, b and broadband solar, 0..1
    double solarLow = 0.0,
           solarHigh = 0.0;   ///< range of solar reflectance that the source gives for this kind of material
    std::string_view source;  ///< of the range
    glm::dvec4 emission{0.0}; ///< exitance, W/m2: r, g, b as daylight of equal luminance, then radiant
};

/// All named materials, by name.
std::span<const Material> materials();

/// Material of a name; nullptr for an unknown one.
const Material* materialNamed(std::string_view name);

/// Its reflectance; none for an unknown name.
std::optional<glm::dvec4> findMaterial(std::string_view name);

} // namespace helio
