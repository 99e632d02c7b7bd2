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

/// A piece of land between streets: its border is where the facades stand.
struct CityBlock
{
    Ring2 outline; ///< counter-clockwise, convex corners or slight bends
    bool isSquare = false;
};

/// Plans `columns` x `rows` blocks around the origin on about `size` metres: a warped and turned lattice of bent
/// streets 8 to 14 m wide with one avenue of 20 m, some corners cut; one inner block is the square.
std::vector<CityBlock> planBlocks(Random& random, u32 columns, u32 rows, double size);

/// Rounds to 1 mm, so that corners compare equal and do not depend on the last bit of the machine's sine.
glm::dvec2 onMillimetre(const glm::dvec2& point);

/// Where the lines p + s d and q + t e meet; they must not be parallel.
glm::dvec2 lineCrossing(const glm::dvec2& p, const glm::dvec2& d, const glm::dvec2& q, const glm::dvec2& e);

/// The unit normal to the left of the direction from a to b.
glm::dvec2 leftNormal(const glm::dvec2& a, const glm::dvec2& b);

} // namespace helio
