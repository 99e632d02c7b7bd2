// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/model/footprint.h"

namespace helio {

/// Fills Footprint::coveredHeight: for every edge the largest height up to which walls of other footprints,
/// antiparallel within 10 degrees and 0.3 m away at most, cover at least half of its length; 0 where there is none.
void findSharedWalls(Layout& layout);

/// Rotates every outer ring (and its coveredHeight) so that the front comes first: the longest free edge on the street;
/// else the longest free edge on a court; else the edge with most wall above its neighbours; else the longest.
void chooseFronts(Layout& layout);

} // namespace helio
