// SPDX-License-Identifier: Apache-2.0
#include "city/geometry/clip.h"

#include <algorithm>
#include <cmath>

#include "city/base/check.h"

namespace helio {

using namespace ClipperLib;

IntPoint toGrid(const glm::dvec2& point)
{
    HELIO_CHECK(std::abs(point.x) <= kGridLimit && std::abs(point.y) <= kGridLimit, point.x, " ", point.y);
    return {cInt(std::llround(point.x * kGridPerMetre)), cInt(std::llround(point.y * kGridPerMetre))};
}

glm::dvec2 fromGrid(const IntPoint& point)
{
    return {double(point.X) / kGridPerMetre, double(point.Y) / kGridPerMetre};
}

Path toGrid(std::span<const glm::dvec2> ring)
{
    Path path;
    path.reserve(ring.size());
    for (const glm::dvec2& corner : ring) path.push_back(toGrid(corner));
    return path;
}

Ring2 fromGrid(const Path& path)
{
    Ring2 ring;
    ring.reserve(path.size());
    for (const IntPoint& corner : path) ring.push_back(fromGrid(corner));
    return ring;
}

void appendRings(Paths& paths, const Polygon2& polygon)
{
    paths.push_back(toGrid(polygon.outer));
    if (!Orientation(paths.back())) ReversePath(paths.back());
    for (const Ring2& hole : polygon.holes) {
        paths.push_back(toGrid(hole));
        if (Orientation(paths.back())) ReversePath(paths.back());
    }
}

Paths toPaths(const Polygon2& polygon)
{
    Paths paths;
    appendRings(paths, polygon);
    return paths;
}

std::vector<Polygon2> toPolygons(const PolyTree& tree)
{
    std::vector<Polygon2> polygons;
    for (const PolyNode* node = tree.GetFirst(); node; node = node->GetNext()) {
        if (node->IsHole()) continue;
        Polygon2 polygon{fromGrid(node->Contour), {}};
        for (const PolyNode* hole : node->Childs) polygon.holes.push_back(fromGrid(hole->Contour));
        polygons.push_back(std::move(polygon));
    }
    return polygons;
}

namespace {

template <class Solution> Solution run(ClipType type, const Paths& subject, const Paths& clip, bool simple)
{
    Clipper clipper(simple ? ioPreserveCollinear | ioStrictlySimple : ioPreserveCollinear);
    clipper.AddPaths(subject, ptSubject, true);
    clipper.AddPaths(clip, ptClip, true);
    // Execute says no to input without any edge, and leaves the solution empty: which is the answer.
    Solution solution;
    clipper.Execute(type, solution, pftNonZero, pftNonZero);
    return solution;
}

} // namespace

Paths unite(const Paths& paths)
{
    return run<Paths>(ctUnion, paths, {}, false);
}
Paths subtract(const Paths& from, const Paths& what)
{
    return run<Paths>(ctDifference, from, what, false);
}
Paths intersect(const Paths& a, const Paths& b)
{
    return run<Paths>(ctIntersection, a, b, false);
}

std::vector<Polygon2> subtractToPolygons(const Paths& from, const Paths& what)
{
    return toPolygons(run<PolyTree>(ctDifference, from, what, true));
}

Paths offset(const Paths& paths, double distance)
{
    ClipperOffset clipper(2.0);
    clipper.AddPaths(paths, jtMiter, etClosedPolygon);
    Paths solution;
    clipper.Execute(solution, distance * kGridPerMetre);
    return solution;
}

double areaOf(const Paths& paths)
{
    double sum = 0.0;
    for (const Path& path : paths) sum += Area(path);
    return sum / (kGridPerMetre * kGridPerMetre);
}

} // namespace helio
