// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/model/footprint.h"

namespace helio {

/// The city that needs no data: perimeter blocks with courts around a green square, streets of different width, about
/// 60-120 buildings on 250 x 250 m, heights 12-26 m, workshops of 4-8 m in the courts and a few towers. Every seed
/// gives another city; one seed always gives the same bytes. Corners lie on a 1 mm grid, and walls of neighbours share
/// their corners. Layout::ground holds the land inside the blocks alone ("green", "court", and "pavement" on the
/// square): call addGround for the streets and the grid.
Layout builtinCity(u64 seed);

} // namespace helio
