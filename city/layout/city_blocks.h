// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "city/base/hash.h"
#include "city/model/polygon.h"

// The street plan of the built-in city. Internal to city/layout.
namespace helio {

/// Draws from a random stream.
inline double range(Random& random, double low, double high)
{
    return low + (high - low) * random.uniform();
}
inline bool chance(Random& random, double probability)
{
    return random.uniform() < probability;
}
inline u32 below(Random& random, u32 count)
{
    return u32(random.uniform() * count);
}

enum class StreetKind : u8
{
    Avenue, ///< straight, 20 to 24 m between the facades
    Street, ///< 11 to 14 m
    Lane    ///< 7 to 8 m
};

struct CityStreet
{
    Ring2 line; ///< centre-line, open
    StreetKind kind = StreetKind::Street;
    double width = 0.0; ///< m between the blocks on both sides
};

enum class BlockUse : u8
{
    Perimeter, ///< houses around a court
    Rows,      ///< row-houses between gardens
    Towers,    ///< towers on a paved place
    Square     ///< green
};

/// A piece of land between streets: its border is where the facades of a perimeter block stand.
struct CityBlock
{
    Ring2 outline;         ///< counter-clockwise, convex corners or slight bends
    std::vector<u32> side; ///< per edge: 0 south, 1 east, 2 north, 3 west in the lattice; cut corners kNoIndex
    BlockUse use = BlockUse::Perimeter;
};

struct CityPlan
{
    std::vector<CityBlock> blocks;
    std::vector<CityStreet> streets; ///< one between two crossings
    Ring2 border;                    ///< the outermost centre-lines, counter-clockwise
};

/// Plans a district of about 300 x 250 m around the origin: a warped, fanned and turned lattice of four by three cells
/// with bent streets, one avenue, and lanes, some of which halve blocks; one row of cells is shallow. Two neighbours of
/// this row hold row-houses, an inner cell is the square, a deep one the place of the towers; the others are perimeter
/// blocks, with some corners cut.
CityPlan planCity(Random& random);

/// Rounds to 1 mm, so that corners compare equal and do not depend on the last bit of the machine's sine.
glm::dvec2 onMillimetre(const glm::dvec2& point);

/// Where the lines p + s d and q + t e meet; they must not be parallel.
glm::dvec2 lineCrossing(const glm::dvec2& p, const glm::dvec2& d, const glm::dvec2& q, const glm::dvec2& e);

/// The unit normal to the left of the direction from a to b.
glm::dvec2 leftNormal(const glm::dvec2& a, const glm::dvec2& b);

/// The rectangle from `corner`, `length` m along the unit vector `along` and `width` m to its left, on the millimetre.
Polygon2 orientedBox(const glm::dvec2& corner, const glm::dvec2& along, double length, double width);

} // namespace helio
