// SPDX-License-Identifier: Apache-2.0
#include "city/geometry/assemble.h"

#include <algorithm>
#include <cmath>

namespace helio {

namespace {

using ClipperLib::IntPoint;
using ClipperLib::Path;

constexpr double kThin = 2.0; ///< grid steps

double distance(const IntPoint& a, const IntPoint& b)
{
    return std::hypot(double(a.X - b.X), double(a.Y - b.Y));
}

/// True if the way a, b, c turns back on itself within kThin, or b adds nothing to a.
bool isSpike(const IntPoint& a, const IntPoint& b, const IntPoint& c)
{
    const double px = double(a.X - b.X), py = double(a.Y - b.Y), qx = double(c.X - b.X), qy = double(c.Y - b.Y);
    const double longer = std::max(std::hypot(px, py), std::hypot(qx, qy));
    if (std::min(std::hypot(px, py), std::hypot(qx, qy)) < 1.0) return true;
    return px * qx + py * qy > 0.0 && std::abs(px * qy - py * qx) < kThin * longer;
}

Path withoutSpikes(const Path& path)
{
    Path kept;
    for (const IntPoint& p : path) {
        kept.push_back(p);
        while (kept.size() >= 3 && isSpike(kept[kept.size() - 3], kept[kept.size() - 2], kept.back()))
            kept.erase(kept.end() - 2);
        if (kept.size() == 2 && kept[0] == kept[1]) kept.pop_back();
    }
    // Where the ring closes.
    for (bool changed = true; changed && kept.size() >= 3;) {
        changed = false;
        if (isSpike(kept[kept.size() - 2], kept.back(), kept[0])) {
            kept.pop_back();
            changed = true;
        } else if (isSpike(kept.back(), kept[0], kept[1])) {
            kept.erase(kept.begin());
            changed = true;
        }
    }
    return kept;
}

double perimeter(const Path& path)
{
    double sum = 0.0;
    for (size_t i = 0; i < path.size(); ++i) sum += distance(path[i], path[(i + 1) % path.size()]);
    return sum;
}

/// Corners of the hole in the ring less those outside of it.
long cornersInside(const Path& hole, const Path& ring)
{
    long count = 0;
    for (const IntPoint& p : hole) {
        const int where = ClipperLib::PointInPolygon(p, ring);
        count += where > 0 ? 1 : where == 0 ? -1 : 0;
    }
    return count;
}

} // namespace

std::vector<Polygon2> assemble(const ClipperLib::Paths& paths)
{
    struct Piece
    {
        Path outer;
        std::vector<Path> holes;
        double area = 0.0, border = 0.0;
    };
    std::vector<Piece> pieces;
    std::vector<Path> holes;
    for (const Path& raw : paths) {
        Path path = withoutSpikes(raw);
        if (path.size() < 3) continue;
        const double area = ClipperLib::Area(path), border = perimeter(path);
        if (std::abs(area) < 0.5 * kThin * border) continue;
        if (area > 0.0)
            pieces.push_back({std::move(path), {}, area, border});
        else
            holes.push_back(std::move(path));
    }
    std::vector<double> outerArea;
    for (const Piece& piece : pieces) outerArea.push_back(piece.area);
    for (Path& hole : holes) {
        size_t owner = pieces.size();
        for (size_t k = 0; k < pieces.size(); ++k)
            if ((owner == pieces.size() || outerArea[k] < outerArea[owner]) &&
                outerArea[k] >= -ClipperLib::Area(hole) && cornersInside(hole, pieces[k].outer) >= 0)
                owner = k;
        if (owner == pieces.size()) continue;
        pieces[owner].area += ClipperLib::Area(hole);
        pieces[owner].border += perimeter(hole);
        pieces[owner].holes.push_back(std::move(hole));
    }
    std::vector<Polygon2> polygons;
    for (const Piece& piece : pieces) {
        if (piece.area < 0.5 * kThin * piece.border) continue;
        Polygon2 polygon{fromGrid(piece.outer), {}};
        for (const Path& hole : piece.holes) polygon.holes.push_back(fromGrid(hole));
        polygons.push_back(std::move(polygon));
    }
    return polygons;
}

} // namespace helio
