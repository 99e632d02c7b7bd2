// SPDX-License-Identifier: Apache-2.0
#include "city/sky/sky_dome.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "city/base/check.h"

namespace helio {
namespace {

/// Of the azimuth of a direction, counter-clockwise from +x, in [0, 1].
double turnOf(const glm::dvec3& direction)
{
    const double turn = std::atan2(direction.y, direction.x) / (2.0 * std::numbers::pi);
    return turn < 0.0 ? turn + 1.0 : turn;
}

} // namespace

SkyDome::SkyDome(u32 cells)
{
    HELIO_CHECK(cells >= 1 && cells <= kMaxCells, cells, " cells");
    // From the horizon up. Where k of n cells lie above a circle its zenith angle has the cosine 1 - k/n.
    const auto zenithAngle = [cells](u32 above) { return std::acos(1.0 - double(above) / cells); };
    const double side = std::sqrt(2.0 * std::numbers::pi / cells); // of a square cell, rad
    const double cap = zenithAngle(1), belowCap = std::numbers::pi / 2.0 - cap;
    const u32 rings = std::max(cells > 1 ? 1u : 0u, u32(std::lround(belowCap / side)));
    firstOfRing_ = {cells};
    for (u32 ring = 1; ring <= rings; ++ring) {
        const double angle = cap + belowCap * (rings - ring) / rings;
        firstOfRing_.push_back(std::max(1u, u32(std::lround(cells * (1.0 - std::cos(angle))))));
    }
    firstOfRing_.push_back(0);
    std::reverse(firstOfRing_.begin(), firstOfRing_.end());
}

double SkyDome::solidAngle() const
{
    return 2.0 * std::numbers::pi / cellCount();
}

u32 SkyDome::ringOf(u32 cell) const
{
    return u32(std::upper_bound(firstOfRing_.begin(), firstOfRing_.end(), cell) - firstOfRing_.begin()) - 1;
}

double SkyDome::cosineAbove(u32 ring) const
{
    return 1.0 - double(firstOfRing_[ring]) / cellCount();
}

u32 SkyDome::cellAt(double turn, double z) const
{
    const u32 last = cellCount() - 1;
    const u32 ring = ringOf(std::min(u32(std::max(0.0, (1.0 - z) * cellCount())), last));
    const u32 first = firstOfRing_[ring], count = firstOfRing_[ring + 1] - first;
    return first + std::min(u32(turn * count), count - 1);
}

u32 SkyDome::cellOf(const glm::dvec3& direction) const
{
    return cellAt(turnOf(direction), direction.z);
}

glm::dvec3 SkyDome::pointOf(u32 cell, double u, double v) const
{
    HELIO_CHECK(cell < cellCount(), "cell ", cell, " of ", cellCount());
    const u32 ring = ringOf(cell), first = firstOfRing_[ring], count = firstOfRing_[ring + 1] - first;
    const double z = cosineAbove(ring) + v * (cosineAbove(ring + 1) - cosineAbove(ring));
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z)), phi = 2.0 * std::numbers::pi * (cell - first + u) / count;
    return {r * std::cos(phi), r * std::sin(phi), z};
}

glm::dvec3 SkyDome::centreOf(u32 cell) const
{
    return cell == 0 ? glm::dvec3(0.0, 0.0, 1.0) : pointOf(cell, 0.5, 0.5);
}

glm::dvec2 SkyDome::placeAt(u32 cell, double turn, const glm::dvec3& direction) const
{
    HELIO_CHECK(cell < cellCount(), "cell ", cell, " of ", cellCount());
    const u32 ring = ringOf(cell), first = firstOfRing_[ring], count = firstOfRing_[ring + 1] - first;
    const double top = cosineAbove(ring), bottom = cosineAbove(ring + 1);
    const auto inside = [](double x) { return std::clamp(x, -0.5, 0.5); };
    if (cell == 0) {
        const double width = 2.0 * std::sqrt(1.0 - bottom * bottom);
        return {inside(direction.x / width), inside(direction.y / width)};
    }
    return {inside(turn * count - (cell - first) - 0.5), inside((direction.z - top) / (bottom - top) - 0.5)};
}

glm::dvec2 SkyDome::placeIn(u32 cell, const glm::dvec3& direction) const
{
    return placeAt(cell, turnOf(direction), direction);
}

SkyDome::Place SkyDome::placeOf(const glm::dvec3& direction) const
{
    const double turn = turnOf(direction);
    const u32 cell = cellAt(turn, direction.z);
    return {cell, placeAt(cell, turn, direction)};
}

double SkyDome::projectedHeight(u32 cell) const
{
    HELIO_CHECK(cell < cellCount(), "cell ", cell, " of ", cellCount());
    const u32 ring = ringOf(cell);
    return cell == 0 ? 0.0 : solidAngle() * (cosineAbove(ring + 1) - cosineAbove(ring)) / 12.0;
}

double SkyDome::projectedSolidAngle(u32 cell) const
{
    HELIO_CHECK(cell < cellCount(), "cell ", cell, " of ", cellCount());
    const u32 ring = ringOf(cell);
    return solidAngle() * 0.5 * (cosineAbove(ring) + cosineAbove(ring + 1));
}

} // namespace helio
