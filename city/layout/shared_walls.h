// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/model/footprint.h"

namespace helio {

/// Fills Footprint::covered: per edge the stretches along which walls of other footprints stand, antiparallel within 10
/// degrees and 0.3 m away at most, disjoint and in order, each with the height of the highest neighbour there. Gaps and
/// stretches below 1 cm are closed and dropped. Edges are found by a grid over their boxes: about n log n for a city.
void findSharedWalls(Layout& layout);

/// The largest height, m, up to which at least half of an edge of `length` metres is covered; 0 if it is free.
double coveredHalf(std::span<const CoveredSpan> spans, double length);

} // namespace helio
