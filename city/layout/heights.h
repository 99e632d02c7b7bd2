// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/layout/import.h"
#include "city/layout/import_notes.h"

// Heights of footprints. Internal to city/layout.
namespace helio {

/// Gives every footprint of height 0 the median of the known ones within ImportOptions::neighbourRadius, between
/// centres (of an even number the upper one), else the default; counts them as "height.neighbours", "height.default".
void fillMissingHeights(std::vector<Footprint>& footprints, const ImportOptions& options, ImportNotes& notes);

} // namespace helio
