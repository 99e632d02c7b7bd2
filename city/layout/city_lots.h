// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/layout/city_blocks.h"

// The buildings along the border of one block of the built-in city. Internal to city/layout.
namespace helio {

struct Lot
{
    Polygon2 outline; ///< first edge on the street
    bool isCorner = false;
};

/// Divides the border of a block into lots of irregular width with buildings 10 to 14 m deep around the court: corner
/// houses around every corner and bend, between them houses that share party walls, some with a wing into the court, a
/// gap here and there. Neighbours share the corners of their common wall: the deeper one has the other's back corner as
/// a corner too.
std::vector<Lot> divideBlock(Random& random, const Ring2& outline);

} // namespace helio
