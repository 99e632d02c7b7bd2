// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "city/base/result.h"
#include "city/format/pack.h"
#include "engine/view/renderer.h"

namespace helio {

/// What one row of a table stands for.
enum class TableRows
{
    Patch,
    Face
};

/// The light of a pack as CSV: a comment line (units, note), a header line, one row a patch in the order of the ids or
/// one row a face of the OBJ in its order (area-weighted means over the patches made from it; area 0 and zeros where
/// there is none). Columns: patch (or face), building (-1 = ground), area in m2, then E_sun, E_sky, E_indirect and B,
/// each as _r, _g, _b, _solar in W/m2; where the pack knows it, E_indirect_error: what E_indirect_solar of the
/// patch, before it was cut, is expected to err by, rms, W/m2 (expectedErrors). Error: faces of a pack that was not
/// made from an OBJ.
Result<std::string> tableText(const Pack& pack, const LightTables& light, TableRows rows, const std::string& note);

} // namespace helio
