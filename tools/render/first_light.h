// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "city/base/result.h"
#include "city/format/pack.h"
#include "engine/view/light_state.h"

namespace helio {

/// E_sun and E_sky of every patch from a table with a row a patch, as heliopolis-render --table and heliopolis-bake
/// reference write them: columns patch, area, E_sun_r .. E_sun_solar and E_sky_r .. E_sky_solar; others are ignored.
/// Errors name file and row: not such a table, not of this pack (another number of rows, another order, areas that
/// differ by more than 1e-4), a negative irradiance.
Result<FirstLight> readFirstLight(const std::filesystem::path& path, const Pack& pack);

} // namespace helio
