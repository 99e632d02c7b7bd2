// SPDX-License-Identifier: Apache-2.0
#include "city/geometry/roof_base.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "city/geometry/clip.h"

namespace helio {

namespace {

using ClipperLib::IntPoint;
using ClipperLib::Path;
using ClipperLib::Paths;

constexpr double kLeastArea = 1e-2; ///< m2
constexpr double kMiterLimit = 4.0;
constexpr double kNeedle = 1e-3; ///< of needles and edges without use, m
constexpr double kLoosen = 5e-4; ///< m
/// Half of what the grid takes, so that what grows out of a base stays on it, m.
constexpr double kLargestBase = kGridLimit / 2;

int orientation(const IntPoint& a, const IntPoint& b, const IntPoint& c)
{
    const __int128 value = __int128(b.X - a.X) * (c.Y - a.Y) - __int128(b.Y - a.Y) * (c.X - a.X);
    return value > 0 ? 1 : (value < 0 ? -1 : 0);
}

bool touch(const IntPoint& a, const IntPoint& b, const IntPoint& c, const IntPoint& d)
{
    if (std::max(a.X, b.X) < std::min(c.X, d.X) || std::max(c.X, d.X) < std::min(a.X, b.X)) return false;
    if (std::max(a.Y, b.Y) < std::min(c.Y, d.Y) || std::max(c.Y, d.Y) < std::min(a.Y, b.Y)) return false;
    return orientation(a, b, c) * orientation(a, b, d) <= 0 && orientation(c, d, a) * orientation(c, d, b) <= 0;
}

bool simplePaths(const Paths& paths)
{
    struct Edge
    {
        IntPoint a, b;
        std::size_t index, next;
    };
    std::vector<Edge> edges;
    for (const Path& path : paths) {
        const std::size_t first = edges.size();
        for (std::size_t i = 0; i < path.size(); ++i)
            edges.push_back({path[i], path[(i + 1) % path.size()], first + i, first + (i + 1) % path.size()});
    }
    for (const Edge& e : edges)
        if (e.a == e.b) return false;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Edge& e = edges[i];
        const Edge& after = edges[e.next];
        // Neighbours share their corner; more than that when one turns back over the other.
        if (orientation(e.a, e.b, after.b) == 0 &&
            (e.b.X - e.a.X) * (after.b.X - after.a.X) + (e.b.Y - e.a.Y) * (after.b.Y - after.a.Y) < 0)
            return false;
        for (std::size_t j = i + 1; j < edges.size(); ++j) {
            if (e.next == j || edges[j].next == i) continue;
            if (touch(e.a, e.b, edges[j].a, edges[j].b)) return false;
        }
    }
    return true;
}

/// True if the corner `at` is the one before it but for kNeedle, or the tip of a needle narrower than kNeedle.
bool isNeedle(const IntPoint& before, const IntPoint& at, const IntPoint& after)
{
    const glm::dvec2 back(double(before.X - at.X), double(before.Y - at.Y));
    const glm::dvec2 on(double(after.X - at.X), double(after.Y - at.Y));
    const double a = glm::length(back), b = glm::length(on);
    if (a < kNeedle * kGridPerMetre || b == 0.0) return true;
    if (glm::dot(back, on) < 0.999 * a * b) return false;
    return std::abs(cross(back, on)) / std::max(a, b) < kNeedle * kGridPerMetre;
}

/// Takes corners that are there twice, within kNeedle, and tips of needles out of a ring, with the edges that start at
/// them.
void dropNeedles(Path& path, std::vector<u32>& edges)
{
    for (std::size_t i = 0, kept = 0; path.size() >= 3 && kept < path.size();) {
        const std::size_t n = path.size();
        i %= n;
        if (!isNeedle(path[(i + n - 1) % n], path[i], path[(i + 1) % n])) {
            ++i;
            ++kept;
            continue;
        }
        path.erase(path.begin() + std::ptrdiff_t(i));
        edges.erase(edges.begin() + std::ptrdiff_t(i));
        // What is now next to each other may be a needle too.
        i = (i + n - 2) % (n - 1);
        kept = 0;
    }
}

Polygon2 moved(const Polygon2& polygon, const glm::dvec2& by)
{
    Polygon2 result = polygon;
    for (glm::dvec2& p : result.outer) p += by;
    for (Ring2& hole : result.holes)
        for (glm::dvec2& p : hole) p += by;
    return result;
}

/// Whole metres: corners that were on the grid stay where they are.
glm::dvec2 localOrigin(const Polygon2& polygon)
{
    return {std::floor(polygon.outer[0].x), std::floor(polygon.outer[0].y)};
}

/// For each edge of `polygon` the nearest edge of `from` of about its direction.
std::vector<u32> nearestEdges(const Polygon2& polygon, const Polygon2& from, std::span<const u32> names)
{
    const auto candidates = edgesOf(from);
    std::vector<u32> result;
    for (const auto& [a, b] : edgesOf(polygon)) {
        const glm::dvec2 middle = 0.5 * (a + b), along = glm::normalize(b - a);
        double best = 1e300;
        u32 name = kNoIndex;
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            const glm::dvec2 ab = candidates[i].second - candidates[i].first;
            const double length = glm::length(ab);
            if (length <= 0.0) continue;
            const double s = std::clamp(glm::dot(middle - candidates[i].first, ab) / (length * length), 0.0, 1.0);
            // An edge of another direction is as good as one 10 m further away.
            const double away =
                glm::distance(middle, candidates[i].first + s * ab) + 5.0 * (1.0 - glm::dot(along, ab) / length);
            if (away < best) {
                best = away;
                name = names.empty() ? u32(i) : names[i];
            }
        }
        result.push_back(name);
    }
    return result;
}

bool finite(const Polygon2& polygon, const glm::dvec2& origin)
{
    const auto near = [&](const glm::dvec2& p) {
        return std::abs(p.x - origin.x) <= kLargestBase && std::abs(p.y - origin.y) <= kLargestBase;
    };
    return std::all_of(polygon.outer.begin(), polygon.outer.end(), near) &&
           std::all_of(polygon.holes.begin(), polygon.holes.end(),
                       [&](const Ring2& hole) { return std::all_of(hole.begin(), hole.end(), near); });
}

/// The only polygon of the offset paths; nothing if there are several.
std::optional<RoofBase> offsetBase(const RoofBase& base, double distance)
{
    const glm::dvec2 origin = localOrigin(base.polygon);
    const Paths grown = offset(toPaths(moved(base.polygon, -origin)), distance);
    std::vector<Polygon2> pieces = subtractToPolygons(grown, {});
    std::erase_if(pieces, [](const Polygon2& piece) { return area(piece) < kLeastArea; });
    if (pieces.size() != 1) return std::nullopt;
    RoofBase result{moved(pieces[0], origin), {}};
    result.edge = nearestEdges(result.polygon, base.polygon, base.edge);
    return result;
}

} // namespace

u32 edgeCount(const Polygon2& polygon)
{
    std::size_t count = polygon.outer.size();
    for (const Ring2& hole : polygon.holes) count += hole.size();
    return u32(count);
}

std::vector<std::pair<glm::dvec2, glm::dvec2>> edgesOf(const Polygon2& polygon)
{
    std::vector<std::pair<glm::dvec2, glm::dvec2>> edges;
    edges.reserve(edgeCount(polygon));
    const auto add = [&](const Ring2& ring) {
        for (std::size_t i = 0; i < ring.size(); ++i) edges.push_back({ring[i], ring[(i + 1) % ring.size()]});
    };
    add(polygon.outer);
    for (const Ring2& hole : polygon.holes) add(hole);
    return edges;
}

bool isSimpleOnGrid(const Polygon2& polygon)
{
    Paths paths{toGrid(polygon.outer)};
    for (const Ring2& hole : polygon.holes) paths.push_back(toGrid(hole));
    return simplePaths(paths);
}

std::vector<RoofBase> cleanBase(const Polygon2& base)
{
    if (base.outer.size() < 3) return {};
    const glm::dvec2 origin = localOrigin(base);
    if (!finite(base, origin)) return {};
    const Polygon2 local = moved(base, -origin);
    Paths paths;
    std::vector<u32> names;
    u32 name = 0;
    const auto add = [&](const Ring2& ring) {
        Path path = toGrid(ring);
        std::vector<u32> edges(path.size());
        for (u32& edge : edges) edge = name++;
        dropNeedles(path, edges);
        if (path.size() < 3) return;
        paths.push_back(std::move(path));
        names.insert(names.end(), edges.begin(), edges.end());
    };
    add(local.outer);
    if (paths.empty()) return {};
    for (const Ring2& hole : local.holes) add(hole);
    const bool directed =
        Orientation(paths[0]) && std::none_of(paths.begin() + 1, paths.end(), ClipperLib::Orientation);
    if (directed && simplePaths(paths) && areaOf(paths) >= kLeastArea) {
        RoofBase result{{}, names};
        result.polygon.outer = fromGrid(paths[0]);
        for (std::size_t i = 1; i < paths.size(); ++i) result.polygon.holes.push_back(fromGrid(paths[i]));
        result.polygon = moved(result.polygon, origin);
        return {result};
    }
    std::vector<RoofBase> pieces;
    const auto take = [&](const Polygon2& piece) {
        if (area(piece) >= kLeastArea) pieces.push_back({moved(piece, origin), nearestEdges(piece, local, {})});
    };
    const std::vector<Polygon2> united = subtractToPolygons(toPaths(local), {});
    if (united.size() == 1 && isSimpleOnGrid(united[0])) {
        take(united[0]);
        return pieces;
    }
    // Rings and polygons that touch in a point come apart.
    for (const Polygon2& piece : united)
        for (const Polygon2& loose : subtractToPolygons(offset(toPaths(piece), -kLoosen), {})) take(loose);
    return pieces;
}

std::optional<RoofBase> growBase(const RoofBase& base, std::span<const double> distances)
{
    const double largest = *std::max_element(distances.begin(), distances.end());
    if (largest <= 0.0) return base;
    RoofBase result = base;
    bool sound = true;
    std::size_t first = 0;
    const auto grow = [&](const Ring2& ring, Ring2& target) {
        const std::size_t n = ring.size();
        for (std::size_t i = 0; i < n; ++i) {
            const glm::dvec2 a = glm::normalize(ring[i] - ring[(i + n - 1) % n]);
            const glm::dvec2 b = glm::normalize(ring[(i + 1) % n] - ring[i]);
            const glm::dvec2 outA(a.y, -a.x), outB(b.y, -b.x);
            const double da = distances[first + (i + n - 1) % n], db = distances[first + i];
            glm::dvec2 by(0.0);
            const double sine = cross(a, b), cosine = glm::dot(a, b);
            if (da == db && cosine > -0.99)
                by = (outA + outB) * (da / (1.0 + cosine));
            else if (std::abs(sine) > 0.1)
                by = (b * da - a * db) / -sine;
            else
                sound = false;
            if (glm::length(by) > kMiterLimit * largest) sound = false;
            target[i] = ring[i] + by;
        }
        for (std::size_t i = 0; i < n; ++i)
            if (glm::dot(target[(i + 1) % n] - target[i], ring[(i + 1) % n] - ring[i]) <= 0.0) sound = false;
        first += n;
    };
    grow(base.polygon.outer, result.polygon.outer);
    for (std::size_t h = 0; h < base.polygon.holes.size(); ++h) grow(base.polygon.holes[h], result.polygon.holes[h]);
    const glm::dvec2 origin = localOrigin(base.polygon);
    if (sound && finite(result.polygon, origin) && isSimpleOnGrid(moved(result.polygon, -origin))) return result;
    return offsetBase(base, largest);
}

std::optional<RoofBase> loosenBase(const RoofBase& base)
{
    return offsetBase(base, -kLoosen);
}

} // namespace helio
