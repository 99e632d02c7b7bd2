// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tools/bench/case_list.h"

namespace helio {

/// Stages 1 and 4 on a made-up city of a million triangles: the sun raster at 2048^2 with and without what shows the
/// sun its back; the forward pass at 1280 x 720 with all its light and with albedo alone.
void addRasterCases(CaseList& cases);

} // namespace helio
