// SPDX-License-Identifier: Apache-2.0
#include "city/model/materials.h"

#include <algorithm>
#include <iterator>

namespace helio {

namespace {

struct Entry
{
    std::string_view name;
    double r, g, b, solar;
};

// Solar reflectances lie in the ranges of Oke, "Boundary Layer Climates", 2nd ed. 1987, table 8.1 (urban materials:
// asphalt 0.05-0.20, concrete 0.10-0.35, brick 0.20-0.40, stone 0.20-0.35, slate 0.10, tiles 0.10-0.35, white paint
// 0.50-0.90, other paint 0.20-0.35; grass 0.16-0.26, its table 1.1); clean facade stone and plaster lie between its
// stone and its white paint. Glass is 0.12 in every channel: what a window with a dark room behind it sends back
// diffusely. Colours are typical hues scaled to about these values.
constexpr Entry kMaterials[] = {
    {"alu", 0.45, 0.46, 0.47, 0.46},
    {"asphalt", 0.10, 0.10, 0.10, 0.12},
    {"brick", 0.36, 0.17, 0.11, 0.30},
    {"brick_red", 0.36, 0.17, 0.11, 0.30},
    {"clay_tiles", 0.33, 0.17, 0.11, 0.28},
    {"concrete", 0.31, 0.30, 0.28, 0.30},
    {"concrete_paving", 0.34, 0.32, 0.29, 0.32},
    {"court", 0.27, 0.25, 0.22, 0.25},
    {"glass", 0.12, 0.12, 0.12, 0.12},
    {"grass", 0.07, 0.12, 0.04, 0.22},
    {"gravel", 0.25, 0.23, 0.20, 0.24},
    {"green", 0.10, 0.16, 0.07, 0.22},
    {"iron_black", 0.04, 0.04, 0.045, 0.05},
    {"lime_plaster", 0.68, 0.65, 0.58, 0.62},
    {"limestone", 0.55, 0.50, 0.41, 0.50},
    {"metal", 0.25, 0.26, 0.27, 0.26},
    {"paint_white", 0.72, 0.71, 0.68, 0.70},
    {"pavement", 0.30, 0.30, 0.30, 0.30},
    {"render", 0.56, 0.52, 0.44, 0.50},
    {"roof_bitumen", 0.14, 0.14, 0.14, 0.14},
    {"roof_gravel", 0.28, 0.27, 0.25, 0.26},
    {"rough_render", 0.44, 0.41, 0.36, 0.40},
    {"sandstone", 0.45, 0.37, 0.27, 0.38},
    {"slate", 0.10, 0.11, 0.12, 0.11},
    {"square", 0.34, 0.32, 0.29, 0.32},
    {"stone", 0.50, 0.46, 0.38, 0.46},
    {"street", 0.12, 0.12, 0.12, 0.12},
    {"water", 0.04, 0.05, 0.06, 0.06},
    {"wood_dark", 0.09, 0.05, 0.03, 0.18},
    {"wood_green", 0.03, 0.07, 0.05, 0.14},
    {"zinc", 0.34, 0.36, 0.37, 0.35},
};

} // namespace

std::optional<glm::dvec4> findMaterial(std::string_view name)
{
    const auto* found = std::find_if(std::begin(kMaterials), std::end(kMaterials),
                                     [&](const Entry& entry) { return entry.name == name; });
    if (found == std::end(kMaterials)) return {};
    return glm::dvec4(found->r, found->g, found->b, found->solar);
}

} // namespace helio
