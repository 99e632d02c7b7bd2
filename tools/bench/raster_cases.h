// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "engine/stages/sun_raster.h"
#include "tools/bench/box_city.h"
#include "tools/bench/case_list.h"

namespace helio {

/// What the sun sees of a made-up city.
struct SunScene
{
    TileTables tile;
    SunView sun;
    FacingLists everything, facing;
    Image ids, depth;
};
/// A city of so many triangles under one view of at most size^2 texels; nothing drawn yet.
std::shared_ptr<SunScene> makeSunScene(Context& context, const BoxCity& city, u32 size);

/// Stages 1 and 4 on a made-up city of a million triangles: the sun raster at 2048^2 with and without what shows the
/// sun its back; the forward pass at 1280 x 720 with all its light and with albedo alone.
void addRasterCases(CaseList& cases);

} // namespace helio
