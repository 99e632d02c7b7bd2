// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/format/tile_reader.h"

namespace helio {

/// Checks the values of a tile: counts that belong together, rows that rise, indices inside their tables, parents above
/// their children, factors in [0, 1.0001], positive finite areas, draw ranges. After it a reader may index without
/// looking. The error names file, section and byte.
Status validateTile(const TileView& tile, const PackIndex& index, const SectionPlaces& places);

} // namespace helio
