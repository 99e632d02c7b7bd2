// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/geometry/clip.h"

// Internal to city/geometry.
namespace helio {

/// Smallest and largest coordinates, m.
struct GridBounds
{
    glm::dvec2 low{0.0}, high{0.0};

    glm::dvec2 size() const { return high - low; }
};
GridBounds gridBounds(const Polygon2& polygon);

/// Brings polygons of any finite size onto Clipper's grid. What lies within kGridLimit stays as it is (steps of
/// 0.1 mm); anything larger or farther away is moved to the origin and divided by a power of two.
class GridFit
{
public:
    explicit GridFit(const GridBounds& bounds);

    Polygon2 toLocal(const Polygon2& polygon) const;
    Polygon2 fromLocal(const Polygon2& polygon) const;
    /// Metres of the polygon in units of the local frame.
    double toLocal(double length) const { return length / unit_; }

private:
    glm::dvec2 centre_{0.0};
    double unit_ = 1.0;
};

} // namespace helio
