// SPDX-License-Identifier: Apache-2.0
#include "city/geometry/offset.h"

#include <algorithm>
#include <cmath>

#include "city/base/check.h"
#include "city/geometry/assemble.h"
#include "city/geometry/grid_fit.h"

namespace helio {

namespace {

constexpr double kMiterLimit = 4.0; // times the distance: corners down to 29 degrees stay sharp
/// Largest growth, m: the result stays within Clipper's range.
constexpr double kMaxGrowth = kGridLimit;

} // namespace

std::vector<Polygon2> offsetPolygon(const Polygon2& polygon, double distance)
{
    HELIO_CHECK(std::isfinite(distance), distance);
    const GridBounds bounds = gridBounds(polygon);
    const glm::dvec2 size = bounds.size();
    if (polygon.outer.size() < 3 || distance <= -0.5 * std::min(size.x, size.y)) return {};
    const GridFit fit(bounds);
    const double step = std::min(fit.toLocal(distance), kMaxGrowth) * kGridPerMetre;

    // The union first: rings that the grid makes touch would be offset against each other.
    ClipperLib::ClipperOffset clipper(kMiterLimit);
    clipper.AddPaths(unite(toPaths(fit.toLocal(polygon))), ClipperLib::jtMiter, ClipperLib::etClosedPolygon);
    ClipperLib::Paths paths;
    clipper.Execute(paths, step);
    std::vector<Polygon2> result = assemble(paths);
    for (Polygon2& piece : result) piece = fit.fromLocal(piece);
    return result;
}

} // namespace helio
