// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "city/model/patch_cells.h"

namespace helio {

/// Cells, in rising order, that faces of the same building hide: polygons that lie in their plane, look the other way
/// and cover at least nine tenths of them, what several cover counted once (backs of sills on their wall, ends of fins
/// of two floors, mitred ends of parapets). Of solids, both sides of such a place are inside the building. Two sheets
/// without a thickness that stand back to back count as hidden too. Faces of given scenes and the ground never do. Call
/// before any cell is merged. A pair counts where one of the two has convex polygons without holes. O(n log n) but
/// where very many faces of one plane lie above each other.
std::vector<u32> hiddenCells(const ShapeTree& shapes, const PatchCells& cells);

} // namespace helio
