// SPDX-License-Identifier: Apache-2.0
// Each edge claims the part of the polygon within its width, up to the mitre lines at its ends. Where claims of edges
// that are not neighbours overlap, every point goes to the edge to which it is nearest in units of the edge's width:
// the bisector of the two edges, weighted by their widths. Equal widths that consume the polygon so give the faces of
// a hip roof over a convex one.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>

#include "city/base/check.h"
#include "city/geometry/assemble.h"
#include "city/geometry/grid_fit.h"
#include "city/geometry/offset.h"

namespace helio {

namespace {

using ClipperLib::IntPoint;
using ClipperLib::Path;
using ClipperLib::Paths;

constexpr double kStep = 1.0 / kGridPerMetre;
/// A strip runs around a reflex corner at most this far beyond the edge's end, in units of its width.
constexpr double kReach = 2.0;
/// Farther mitres between edges that are nearly one line end the strip square instead.
constexpr double kFarMitre = 4.0;
/// What lies this near to an edge lies on it.
constexpr double kOnEdge = 2.0 * kStep;

/// The points p with normal . p <= limit.
struct HalfPlane
{
    glm::dvec2 normal;
    double limit;
};

struct Edge
{
    glm::dvec2 a, b, along, inward;
    double width = 0.0;
    u32 before = 0, after = 0; ///< its neighbours in the ring

    double depth(const glm::dvec2& p) const { return glm::dot(inward, p - a); }
};

/// What an edge holds of the polygon.
struct Claim
{
    u32 edge = 0;
    Paths paths;
    ClipperLib::IntRect box{};
    std::vector<u32> rivals; ///< claims whose boxes meet this one's
};

/// Corners on the grid: then the claims' edges are exactly those of the polygon.
Polygon2 onGrid(Polygon2 polygon)
{
    polygon.outer = fromGrid(toGrid(polygon.outer));
    for (Ring2& hole : polygon.holes) hole = fromGrid(toGrid(hole));
    return polygon;
}

Ring2 clipConvex(const Ring2& ring, const HalfPlane& plane)
{
    Ring2 kept;
    const auto excess = [&](const glm::dvec2& p) { return glm::dot(plane.normal, p) - plane.limit; };
    for (size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 &p = ring[i], &q = ring[(i + 1) % ring.size()];
        const double d = excess(p), e = excess(q);
        if (d <= 0.0) kept.push_back(p);
        if ((d < 0.0 && e > 0.0) || (d > 0.0 && e < 0.0)) kept.push_back(p + (q - p) * (d / (d - e)));
    }
    return kept;
}

HalfPlane planeThrough(const glm::dvec2& point, const glm::dvec2& outward)
{
    return {outward, glm::dot(outward, point)};
}

/// Points nearer to `edge` than to `other`, in units of their widths. Neither width may be 0.
HalfPlane nearerTo(const Edge& edge, const Edge& other)
{
    const glm::dvec2 normal = edge.inward / edge.width - other.inward / other.width;
    return {normal, glm::dot(edge.inward, edge.a) / edge.width - glm::dot(other.inward, other.a) / other.width};
}

/// Where the strip of `edge` ends at the corner that it shares with `other`. `atEnd`: that corner is the edge's b.
HalfPlane mitre(const Edge& edge, const Edge& other, bool atEnd)
{
    const glm::dvec2 corner = atEnd ? edge.b : edge.a;
    const double turn = atEnd ? cross(edge.along, other.along) : cross(other.along, edge.along);
    const double straight = glm::dot(edge.along, other.along);
    const HalfPlane square = planeThrough(corner, atEnd ? edge.along : -edge.along);
    // How far before the corner the inner borders of the strips meet.
    const double meet = turn == 0.0 ? 0.0 : (other.width - edge.width * straight) / turn;
    if (straight > 0.0 && std::hypot(meet, edge.width) > kFarMitre * std::max(edge.width, other.width)) return square;
    if (std::abs(turn) < 1e-9) return square;
    if (other.width <= 0.0) return turn > 0.0 ? planeThrough(corner, -other.inward) : square;
    HalfPlane plane = nearerTo(edge, other);
    // Around a reflex corner the fronts of both edges move apart: there the farther one leads.
    if (turn < 0.0) plane = {-plane.normal, -plane.limit};
    return plane;
}

std::vector<Edge> edgesOf(const Polygon2& polygon, std::span<const double> widths, const GridFit& fit)
{
    std::vector<Edge> edges;
    const auto add = [&](const Ring2& ring) {
        const size_t first = edges.size();
        for (size_t k = 0; k < ring.size(); ++k) {
            Edge edge;
            edge.a = ring[k];
            edge.b = ring[(k + 1) % ring.size()];
            const double length = glm::distance(edge.a, edge.b);
            if (length > 0.0) edge.along = (edge.b - edge.a) / length;
            edge.inward = {-edge.along.y, edge.along.x};
            edge.before = u32(first + (k + ring.size() - 1) % ring.size());
            edge.after = u32(first + (k + 1) % ring.size());
            const double width = widths[edges.size()];
            HELIO_CHECK(width >= 0.0, width);
            edge.width = length > 0.0 ? fit.toLocal(width) : 0.0;
            edges.push_back(edge);
        }
    };
    add(polygon.outer);
    for (const Ring2& hole : polygon.holes) add(hole);
    return edges;
}

/// The side of the ring with the longest part on the edge.
std::optional<size_t> sideOn(const Edge& edge, const Ring2& ring)
{
    std::optional<size_t> best;
    double longest = kOnEdge;
    for (size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 &p = ring[i], &q = ring[(i + 1) % ring.size()];
        if (std::abs(edge.depth(p)) > kOnEdge || std::abs(edge.depth(q)) > kOnEdge) continue;
        const double begin = std::max(0.0, glm::dot(edge.along, p - edge.a));
        const double end = std::min(glm::distance(edge.a, edge.b), glm::dot(edge.along, q - edge.a));
        if (end - begin <= longest) continue;
        longest = end - begin;
        best = i;
    }
    return best;
}

ClipperLib::IntRect boxOf(const Paths& paths)
{
    ClipperLib::IntRect box{paths[0][0].X, paths[0][0].Y, paths[0][0].X, paths[0][0].Y};
    for (const Path& path : paths)
        for (const IntPoint& p : path) {
            box.left = std::min(box.left, p.X);
            box.right = std::max(box.right, p.X);
            box.top = std::min(box.top, p.Y);
            box.bottom = std::max(box.bottom, p.Y);
        }
    return box;
}

bool overlap(const ClipperLib::IntRect& a, const ClipperLib::IntRect& b)
{
    return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

/// All that the edge could take if it were alone with its neighbours.
Paths claimOf(const Edge& edge, const Edge& before, const Edge& after, const Paths& polygon, const Ring2& frame)
{
    const HalfPlane planes[] = {planeThrough(edge.a, -edge.inward),
                                planeThrough(edge.a + edge.width * edge.inward, edge.inward),
                                mitre(edge, before, false),
                                mitre(edge, after, true),
                                planeThrough(edge.a - kReach * edge.width * edge.along, -edge.along),
                                planeThrough(edge.b + kReach * edge.width * edge.along, edge.along)};
    Ring2 region = frame;
    for (const HalfPlane& plane : planes) region = clipConvex(region, plane);
    if (region.size() < 3) return {};
    Paths claim;
    // What the band meets behind a bay of the border belongs to other edges.
    for (const Polygon2& piece : assemble(intersect(polygon, {toGrid(region)})))
        if (sideOn(edge, piece.outer) ||
            std::any_of(piece.holes.begin(), piece.holes.end(), [&](const Ring2& hole) { return sideOn(edge, hole); }))
            appendRings(claim, piece);
    return claim;
}

/// Pairs of claims whose boxes meet, by a sweep along x.
void findRivals(std::vector<Claim>& claims)
{
    std::vector<u32> order(claims.size()), open;
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](u32 a, u32 b) { return claims[a].box.left < claims[b].box.left; });
    for (const u32 i : order) {
        std::erase_if(open, [&](u32 k) { return claims[k].box.right <= claims[i].box.left; });
        for (const u32 k : open)
            if (overlap(claims[i].box, claims[k].box)) {
                claims[i].rivals.push_back(k);
                claims[k].rivals.push_back(i);
            }
        open.push_back(i);
    }
    for (Claim& claim : claims) std::sort(claim.rivals.begin(), claim.rivals.end());
}

/// The claim without what lies nearer to other edges that claim it too.
Paths settled(const Claim& claim, const std::vector<Claim>& claims, const std::vector<Edge>& edges, const Ring2& frame)
{
    const Edge& edge = edges[claim.edge];
    Paths lost;
    for (const u32 k : claim.rivals) {
        const u32 other = claims[k].edge;
        if (other == edge.before || other == edge.after) continue; // the mitre has divided them
        const HalfPlane plane = nearerTo(edges[other], edge);
        // Parts of one line tie everywhere: the order of the edges decides.
        if (glm::length(plane.normal) * edge.width < 1e-9 && std::abs(plane.limit) < 1e-9) continue;
        const Ring2 nearer = clipConvex(frame, plane);
        if (nearer.size() < 3) continue;
        const Paths part = intersect(claims[k].paths, {toGrid(nearer)});
        lost.insert(lost.end(), part.begin(), part.end());
    }
    return lost.empty() ? claim.paths : subtract(claim.paths, lost);
}

/// Corners of the given polygon come back as they were, not rounded to the grid.
class CornerTable
{
public:
    CornerTable(const Polygon2& polygon, const GridFit& fit) : fit_(fit)
    {
        const Polygon2 local = fit.toLocal(polygon);
        const auto add = [&](const Ring2& from, const Ring2& to) {
            for (size_t k = 0; k < from.size(); ++k) corners_.push_back({toGrid(from[k]), to[k]});
        };
        add(local.outer, polygon.outer);
        for (size_t h = 0; h < polygon.holes.size(); ++h) add(local.holes[h], polygon.holes[h]);
        std::stable_sort(corners_.begin(), corners_.end(),
                         [](const Corner& a, const Corner& b) { return isBefore(a.grid, b.grid); });
    }

    Polygon2 restore(const Polygon2& local) const
    {
        Polygon2 polygon = fit_.fromLocal(local);
        const auto snap = [&](const Ring2& from, Ring2& to) {
            for (size_t k = 0; k < from.size(); ++k) {
                const IntPoint grid = toGrid(from[k]);
                const auto found =
                    std::lower_bound(corners_.begin(), corners_.end(), grid,
                                     [](const Corner& corner, const IntPoint& p) { return isBefore(corner.grid, p); });
                if (found != corners_.end() && found->grid == grid) to[k] = found->exact;
            }
        };
        snap(local.outer, polygon.outer);
        for (size_t h = 0; h < local.holes.size(); ++h) snap(local.holes[h], polygon.holes[h]);
        return polygon;
    }

private:
    struct Corner
    {
        IntPoint grid;
        glm::dvec2 exact;
    };
    static bool isBefore(const IntPoint& a, const IntPoint& b) { return a.X != b.X ? a.X < b.X : a.Y < b.Y; }

    const GridFit& fit_;
    std::vector<Corner> corners_;
};

} // namespace

Setback setback(const Polygon2& polygon, std::span<const double> widths)
{
    size_t count = polygon.outer.size();
    for (const Ring2& hole : polygon.holes) count += hole.size();
    HELIO_CHECK(widths.size() == count, widths.size(), " widths for ", count, " edges");

    const GridBounds bounds = gridBounds(polygon);
    const GridFit fit(bounds);
    const Polygon2 local = onGrid(fit.toLocal(polygon));
    const Paths whole = unite(toPaths(local));
    const GridBounds box = gridBounds(local);
    const glm::dvec2 low = box.low - 1e-3, high = box.high + 1e-3;
    const Ring2 frame{low, {high.x, low.y}, high, {low.x, high.y}};

    std::vector<Edge> edges = edgesOf(local, widths, fit);
    std::vector<Claim> claims;
    for (u32 i = 0; i < edges.size(); ++i) {
        if (edges[i].width < kStep) continue;
        Claim claim{i, claimOf(edges[i], edges[edges[i].before], edges[edges[i].after], whole, frame), {}, {}};
        if (claim.paths.empty()) continue;
        claim.box = boxOf(claim.paths);
        claims.push_back(std::move(claim));
    }
    findRivals(claims);

    Setback result;
    const CornerTable corners(polygon, fit);
    std::vector<Paths> held(claims.size());
    Paths taken;
    for (u32 i = 0; i < claims.size(); ++i) {
        Paths earlier;
        for (const u32 k : claims[i].rivals)
            if (k < i) earlier.insert(earlier.end(), held[k].begin(), held[k].end());
        const Edge& edge = edges[claims[i].edge];
        for (Polygon2& piece : assemble(subtract(settled(claims[i], claims, edges, frame), earlier))) {
            appendRings(held[i], piece);
            if (const auto side = sideOn(edge, piece.outer))
                std::rotate(piece.outer.begin(), piece.outer.begin() + long(*side), piece.outer.end());
            result.strips.push_back({claims[i].edge, corners.restore(piece)});
        }
        taken.insert(taken.end(), held[i].begin(), held[i].end());
    }
    for (const Polygon2& piece : assemble(subtract(whole, unite(taken))))
        result.remainder.push_back(corners.restore(piece));
    return result;
}

} // namespace helio
