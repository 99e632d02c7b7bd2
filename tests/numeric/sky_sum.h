// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>

#include "city/light/light_tables.h"
#include "city/sky/sky_model.h"

namespace helio::test {

/// E_sky of a patch as SkyTable says, W/m2, with its own reading of the packed offsets.
inline double skyIrradiance(const SkyTable& table, u32 patch, const std::vector<CellSky>& radiance)
{
    const auto offset = [](u32 bits) { return 0.5 * double(std::int16_t(bits & 0xFFFFu)) / 32767.0; };
    double sum = 0.0;
    for (u32 k = table.rowBegin[patch]; k < table.rowBegin[patch + 1]; ++k) {
        const CellSky& sky = radiance[table.column[k]];
        double seen = sky.mean;
        if (!table.offset.empty())
            seen += glm::dot(sky.slope, glm::dvec2(offset(table.offset[k]), offset(table.offset[k] >> 16)));
        sum += double(table.factor[k]) * seen;
    }
    return std::numbers::pi * sum;
}

} // namespace helio::test
