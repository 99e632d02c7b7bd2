// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/layout/city_blocks.h"

// Row-houses of the built-in city. Internal to city/layout.
namespace helio {

struct RowHouseLot
{
    Polygon2 outline; ///< first edge = the front
    u32 storeys = 2;
};

/// Rows along the southern and northern side of a block: houses 6 m wide and 9 to 10 m deep, up to eight in a row that
/// share party walls, a front garden of 3 to 4.5 m before each row, passages of 2.5 m between the rows, gardens behind.
std::vector<RowHouseLot> divideIntoRows(Random& random, const CityBlock& block);

} // namespace helio
