// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/model/footprint.h"

namespace helio {

/// Rotates every outer ring (with covered and onStreet) so that the front comes first: of the free edges that face a
/// street (markStreets) the nearest to it, of those within 1 m of that the longest; else the longest free edge towards
/// the street side; else on a court; else the edge with most wall above its neighbours; else the longest. The first
/// edge of the input with the edges in line with it counts as one wall, and they are joined; but where it is at least
/// half of the front wall, it stays an edge of its own and comes first.
void chooseFronts(Layout& layout);

} // namespace helio
