// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/layout/city_blocks.h"

// The towers of the built-in city. Internal to city/layout.
namespace helio {

struct TowerPlace
{
    std::vector<Polygon2> towers; ///< two to four lots of 18 to 22 m, first edge = the front, 15 m and more apart
    std::vector<Polygon2> halls;  ///< at most one low hall between them
};

/// Stands towers on a block, each along one of its streets and 5 m behind it, and a low hall where 10 m are left around
/// it.
TowerPlace placeTowers(Random& random, const CityBlock& block);

} // namespace helio
