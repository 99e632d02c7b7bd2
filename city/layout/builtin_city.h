// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/model/footprint.h"

namespace helio {

/// The city that needs no data: a district of about 300 x 250 m and 100 to 180 buildings between an avenue of 20 to
/// 24 m, streets of 11 to 14 m and lanes of 7 to 8 m. Perimeter blocks (houses of 12 to 27 m, workshops of 4 to 8 m in
/// the courts) stand around a green square, two blocks hold row-houses between gardens, one two to four towers of 40 to
/// 70 m and perhaps a low hall. The attribute "use" says which: "house", "workshop", "rowhouse", "tower", "hall";
/// Footprint::rule names the start rule in city/rules/city.cga.
///
/// Every seed gives another city; one seed always gives the same bytes. Corners lie on a 1 mm grid, and walls of
/// neighbours share their corners. The first edge is the front; Layout::streets has the centre-lines, and covered walls
/// and edges on streets are marked. Layout::ground holds the land inside the blocks ("green", "court", "pavement"), the
/// strip in the middle of the avenue and the green around the town: call addGround for the streets and the grid.
Layout builtinCity(u64 seed);

} // namespace helio
