// SPDX-License-Identifier: Apache-2.0
#include "city/model/materials.h"

#include <algorithm>
#include <iterator>

namespace helio {

namespace {

// Where a range of solar reflectance comes from: T. R. Oke, "Boundary Layer Climates", 2nd ed., 1987.
constexpr std::string_view kUrban = "Oke 1987, table 8.1 (urban materials)";
constexpr std::string_view kNatural = "Oke 1987, table 1.1 (natural materials)";
// A clear pane in front of a dark room: 0.08 near the normal, more at grazing angles; what the room sends back comes on
// top.
constexpr std::string_view kPane = "Oke 1987, table 8.1 (clear glass, up to 80 degrees from the normal)";
// Clean, light facade stone, plaster and render.
constexpr std::string_view kLightStone = "between stone (0.20-0.35) and white paint (0.50-0.90) of Oke 1987, table 8.1";
// Metal sheets, weathered to matt.
constexpr std::string_view kSheet =
    "between corrugated iron (0.10-0.16) and white paint (0.50-0.90) of Oke 1987, table 8.1";
// Floors of courts and squares, gravel: concrete, stone and asphalt side by side.
constexpr std::string_view kPaved = "between asphalt (0.05-0.20) and concrete (0.10-0.35) of Oke 1987, table 8.1";

constexpr glm::dvec4 kDark(0.0);

// Emission from a luminous exitance M, lm/m2: r, g, b carry W/m2 of daylight of the same luminance, at 105 lm/W (the
// efficacy of global daylight: P. J. Littlefair, "The luminous efficacy of daylight: a review", 1985), in the lamp's
// colour; the fourth channel is radiant power at 300 lm/W (a white light-emitting diode's radiation, no infrared).
// A room at 300 lx (EN 12464-1 asks for 300-500 lx in offices) with a mean reflectance of 0.5 behind a pane that lets
// 0.8 through: M = 300 * 0.5 * 0.8 = 120 lm/m2; a shop at 1,000 lx: 400 lm/m2; a frosted lamp of 1 cd/cm2: M = pi *
// 10,000 lm/m2.
constexpr glm::dvec4 warm(double exitance)
{
    // Chromaticity of a black body of 3000 K (CIE x = 0.4369, y = 0.4041) in linear Rec.709, of luminance 1.
    return {1.770 * exitance / 105.0, 0.845 * exitance / 105.0, 0.272 * exitance / 105.0, exitance / 300.0};
}

// Colours are typical hues scaled so that they agree with the solar value; vegetation reflects far more infrared than
// light, dark painted wood somewhat more. Sorted by name.
constexpr Material kMaterials[] = {
    {"alu", {0.45, 0.46, 0.47, 0.46}, 0.10, 0.90, kSheet, kDark},
    {"asphalt", {0.10, 0.10, 0.10, 0.12}, 0.05, 0.20, kUrban, kDark},
    {"brick", {0.36, 0.17, 0.11, 0.30}, 0.20, 0.40, kUrban, kDark},
    {"brick_red", {0.36, 0.17, 0.11, 0.30}, 0.20, 0.40, kUrban, kDark},
    {"brick_yellow", {0.46, 0.36, 0.22, 0.38}, 0.20, 0.40, kUrban, kDark},
    {"clay_tiles", {0.33, 0.17, 0.11, 0.28}, 0.10, 0.35, kUrban, kDark},
    {"concrete", {0.31, 0.30, 0.28, 0.30}, 0.10, 0.35, kUrban, kDark},
    {"concrete_paving", {0.34, 0.32, 0.29, 0.32}, 0.10, 0.35, kUrban, kDark},
    {"court", {0.27, 0.25, 0.22, 0.25}, 0.05, 0.35, kPaved, kDark},
    {"glass", {0.12, 0.12, 0.12, 0.12}, 0.08, 0.52, kPane, kDark},
    {"granite", {0.28, 0.27, 0.26, 0.27}, 0.20, 0.35, kUrban, kDark},
    {"grass", {0.07, 0.12, 0.04, 0.22}, 0.16, 0.26, kNatural, kDark},
    {"gravel", {0.25, 0.23, 0.20, 0.24}, 0.05, 0.35, kPaved, kDark},
    {"green", {0.10, 0.16, 0.07, 0.22}, 0.16, 0.26, kNatural, kDark},
    {"hedge", {0.04, 0.08, 0.03, 0.18}, 0.15, 0.20, kNatural, kDark},
    {"iron_black", {0.04, 0.04, 0.045, 0.05}, 0.02, 0.15, kUrban, kDark},
    {"lamp", {0.70, 0.70, 0.68, 0.70}, 0.50, 0.90, kUrban, warm(31416.0)},
    {"lime_plaster", {0.68, 0.65, 0.58, 0.62}, 0.35, 0.90, kLightStone, kDark},
    {"limestone", {0.55, 0.50, 0.41, 0.50}, 0.20, 0.90, kLightStone, kDark},
    {"lit_shop", {0.12, 0.12, 0.12, 0.12}, 0.08, 0.52, kPane, warm(400.0)},
    {"lit_window", {0.12, 0.12, 0.12, 0.12}, 0.08, 0.52, kPane, warm(120.0)},
    {"metal", {0.25, 0.26, 0.27, 0.26}, 0.10, 0.90, kSheet, kDark},
    {"paint_white", {0.72, 0.71, 0.68, 0.70}, 0.50, 0.90, kUrban, kDark},
    {"pavement", {0.30, 0.30, 0.30, 0.30}, 0.10, 0.35, kUrban, kDark},
    {"render", {0.56, 0.52, 0.44, 0.50}, 0.20, 0.90, kLightStone, kDark},
    {"roof_bitumen", {0.14, 0.14, 0.14, 0.14}, 0.08, 0.18, kUrban, kDark},
    {"roof_gravel", {0.28, 0.27, 0.25, 0.26}, 0.08, 0.35, kPaved, kDark},
    {"rough_render", {0.44, 0.41, 0.36, 0.40}, 0.20, 0.90, kLightStone, kDark},
    {"sandstone", {0.45, 0.37, 0.27, 0.38}, 0.20, 0.90, kLightStone, kDark},
    {"slate", {0.10, 0.11, 0.12, 0.11}, 0.08, 0.14, kUrban, kDark},
    {"square", {0.34, 0.32, 0.29, 0.32}, 0.10, 0.35, kUrban, kDark},
    {"stone", {0.50, 0.46, 0.38, 0.46}, 0.20, 0.90, kLightStone, kDark},
    {"street", {0.12, 0.12, 0.12, 0.12}, 0.05, 0.20, kUrban, kDark},
    {"water", {0.04, 0.05, 0.06, 0.06}, 0.03, 0.10, kNatural, kDark},
    {"wood_dark", {0.09, 0.05, 0.03, 0.18}, 0.02, 0.35, kUrban, kDark},
    {"wood_green", {0.03, 0.07, 0.05, 0.14}, 0.02, 0.35, kUrban, kDark},
    {"zinc", {0.34, 0.36, 0.37, 0.35}, 0.10, 0.90, kSheet, kDark},
};

} // namespace

std::span<const Material> materials()
{
    return kMaterials;
}

const Material* materialNamed(std::string_view name)
{
    const auto* found =
        std::lower_bound(std::begin(kMaterials), std::end(kMaterials), name,
                         [](const Material& material, std::string_view n) { return material.name < n; });
    return found != std::end(kMaterials) && found->name == name ? found : nullptr;
}

std::optional<glm::dvec4> findMaterial(std::string_view name)
{
    const Material* material = materialNamed(name);
    if (material == nullptr) return {};
    return material->rho;
}

} // namespace helio
