// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/geometry/roof_solid.h"

namespace helio {

/// Levels the ridges that end on gables: a ridge between two gables at the mean height of its ends, any other at the
/// height of its inner end. Slopes that are no longer plane are cut into triangles. A mesh in which that would need a
/// triangle of less than 1e-5 m2 in plan, or a face of more than 48 corners, stays as it is.
void levelRidges(RoofMesh& mesh);

} // namespace helio
