// SPDX-License-Identifier: Apache-2.0
#include "city/layout/city_lots.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace helio {

namespace {

// One corner of the block, or the two of a cut corner: the house that stands around it.
struct CornerHouse
{
    std::vector<glm::dvec2> street; // its corners on the block's border
    glm::dvec2 in, out;             // directions of the edges before and behind
    double depth = 0.0;
    double back = 0.0, ahead = 0.0; // m of the edge before and of the edge behind
};

// A party wall: stands on the street at `foot`, runs along `inward`.
struct PartyWall
{
    glm::dvec2 foot, inward;
    double depthBefore = 0.0, depthBehind = 0.0; // of the houses on both sides; 0 = none
    glm::dvec2 at(double depth) const { return onMillimetre(foot + depth * inward); }
};

// A house between two party walls, or a gap.
struct RowHouse
{
    double width = 0.0, depth = 0.0;
    double wing = 0.0; // m into the court behind the house, 0 = none
    bool wingAtStart = false, isGap = false;
};

constexpr double kWingWidth = 5.5;

// The corners of a wall from the street to depth `own`, with the neighbour's back corner on it.
Ring2 wallCorners(const PartyWall& wall, double own, double neighbour)
{
    Ring2 corners{wall.at(0.0)};
    if (neighbour > 0.0 && neighbour < own - 1e-6) corners.push_back(wall.at(neighbour));
    corners.push_back(wall.at(own));
    return corners;
}

double roundedDepth(Random& random)
{
    return std::round(range(random, 10.0, 14.0) * 2.0) / 2.0;
}

std::vector<CornerHouse> findCorners(Random& random, const Ring2& ring)
{
    const size_t n = ring.size();
    const auto at = [&](size_t i) { return ring[i % n]; };
    const auto isCut = [&](size_t i) { return glm::distance(at(i), at(i + 1)) < 8.0; };
    std::vector<CornerHouse> houses;
    const size_t first = isCut(n - 1) ? 1 : 0;
    for (size_t i = first; i < first + n; ++i) {
        CornerHouse house;
        house.street = {at(i)};
        house.in = glm::normalize(at(i) - at(i + n - 1));
        if (isCut(i)) house.street.push_back(at(++i));
        house.out = glm::normalize(at(i + 1) - at(i));
        house.depth = roundedDepth(random);
        // So much of each edge that the court's corner and a bit of wall beside it lie behind the house.
        const double angle = std::atan2(cross(house.in, house.out), glm::dot(house.in, house.out));
        const double reach = house.depth * std::tan(0.5 * std::abs(angle));
        const double cut = house.street.size() == 2 ? glm::distance(house.street[0], house.street[1]) * 0.7 : 0.0;
        house.back = std::max(5.0, reach - cut) + range(random, 3.0, 6.0);
        house.ahead = std::max(5.0, reach - cut) + range(random, 3.0, 6.0);
        houses.push_back(std::move(house));
    }
    return houses;
}

std::vector<RowHouse> planRow(Random& random, double length)
{
    const u32 count = std::max(1u, u32(std::lround(length / range(random, 13.0, 19.0))));
    std::vector<RowHouse> row(count);
    double sum = 0.0;
    for (RowHouse& house : row) {
        house.width = range(random, 0.7, 1.3);
        house.depth = roundedDepth(random);
        house.isGap = count > 2 && chance(random, 0.04);
        if (chance(random, 0.35)) house.wing = std::round(range(random, 5.0, 9.0));
        house.wingAtStart = chance(random, 0.5);
        sum += house.width;
    }
    for (RowHouse& house : row) house.width *= length / sum;
    return row;
}

// A wing must end well in the middle of the court: 25 m from every other edge of the block.
bool wingFits(const Ring2& outline, const glm::dvec2& tip, const glm::dvec2& edgeDirection)
{
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec2 a = outline[i], b = outline[(i + 1) % outline.size()];
        const glm::dvec2 along = glm::normalize(b - a);
        const bool isOwnEdge = glm::dot(along, edgeDirection) > 0.97;
        if (!isOwnEdge && cross(along, tip - a) < 25.0) return false;
    }
    return true;
}

Lot buildRowHouse(const RowHouse& house, const PartyWall& start, const PartyWall& end)
{
    const double startDepth = house.depth + (house.wingAtStart ? house.wing : 0.0);
    const double endDepth = house.depth + (house.wingAtStart ? 0.0 : house.wing);
    const glm::dvec2 along = glm::normalize(end.foot - start.foot);
    Lot lot;
    Ring2& ring = lot.outline.outer;
    ring = wallCorners(end, endDepth, end.depthBehind);
    ring.insert(ring.begin(), start.at(0.0));
    if (house.wing > 0.0) {
        const glm::dvec2 foot = house.wingAtStart ? start.foot + kWingWidth * along : end.foot - kWingWidth * along;
        const PartyWall inner{foot, start.inward, 0.0, 0.0};
        const double first = house.wingAtStart ? house.depth : endDepth;
        ring.push_back(inner.at(first));
        ring.push_back(inner.at(house.wingAtStart ? startDepth : house.depth));
    }
    Ring2 back = wallCorners(start, startDepth, start.depthBefore);
    ring.insert(ring.end(), back.rbegin(), back.rend() - 1);
    return lot;
}

Lot buildCornerHouse(const CornerHouse& house, const PartyWall& start, const PartyWall& end)
{
    Lot lot;
    lot.isCorner = true;
    Ring2& ring = lot.outline.outer;
    ring.push_back(start.at(0.0));
    ring.insert(ring.end(), house.street.begin(), house.street.end());
    const Ring2 far = wallCorners(end, house.depth, end.depthBehind);
    ring.insert(ring.end(), far.begin(), far.end());
    ring.push_back(onMillimetre(lineCrossing(start.at(house.depth), house.in, end.at(house.depth), house.out)));
    const Ring2 near = wallCorners(start, house.depth, start.depthBefore);
    ring.insert(ring.end(), near.rbegin(), near.rend() - 1);
    // The front is the longer side on the street.
    const double back = glm::distance(ring[0], ring[1]);
    const size_t last = house.street.size();
    if (glm::distance(ring[last], ring[last + 1]) > back)
        std::rotate(ring.begin(), ring.begin() + long(last), ring.end());
    return lot;
}

} // namespace

std::vector<Lot> divideBlock(Random& random, const Ring2& outline)
{
    std::vector<CornerHouse> corners = findCorners(random, outline);
    const size_t n = corners.size();
    std::vector<std::vector<RowHouse>> rows(n); // rows[i] stands between corner i and corner i + 1
    for (size_t i = 0; i < n; ++i) {
        CornerHouse &from = corners[i], &to = corners[(i + 1) % n];
        const double length = glm::distance(from.street.back(), to.street.front());
        const double rest = length - from.ahead - to.back;
        if (rest >= 9.0) {
            rows[i] = planRow(random, rest);
        } else {
            const double scale = length / (from.ahead + to.back);
            from.ahead *= scale;
            to.back = length - from.ahead;
        }
    }
    // All party walls, counter-clockwise, so that both sides of each know each other's depth.
    std::vector<PartyWall> walls;
    std::vector<size_t> firstWall(n);
    for (size_t i = 0; i < n; ++i) {
        const CornerHouse &from = corners[i], &to = corners[(i + 1) % n];
        const glm::dvec2 along = from.out, inward(-along.y, along.x);
        firstWall[i] = walls.size();
        double at = from.ahead, before = from.depth;
        for (RowHouse& house : rows[i]) {
            const glm::dvec2 foot = onMillimetre(from.street.back() + at * along);
            const glm::dvec2 wingFoot = foot + (house.wingAtStart ? 0.0 : house.width) * along;
            const bool roomy = house.width >= 2.2 * kWingWidth && !house.isGap;
            if (!roomy || !wingFits(outline, wingFoot + (house.depth + house.wing) * inward, along)) house.wing = 0.0;
            const double startDepth = house.isGap ? 0.0 : house.depth + (house.wingAtStart ? house.wing : 0.0);
            const double endDepth = house.isGap ? 0.0 : house.depth + (house.wingAtStart ? 0.0 : house.wing);
            walls.push_back({foot, inward, before, startDepth});
            before = endDepth;
            at += house.width;
        }
        const glm::dvec2 foot = onMillimetre(from.street.back() + at * along);
        walls.push_back({foot, inward, before, to.depth});
    }
    std::vector<Lot> lots;
    for (size_t i = 0; i < n; ++i) {
        const size_t last = i == 0 ? walls.size() - 1 : firstWall[i] - 1;
        lots.push_back(buildCornerHouse(corners[i], walls[last], walls[firstWall[i]]));
        for (size_t k = 0; k < rows[i].size(); ++k)
            if (!rows[i][k].isGap)
                lots.push_back(buildRowHouse(rows[i][k], walls[firstWall[i] + k], walls[firstWall[i] + k + 1]));
    }
    return lots;
}

} // namespace helio
