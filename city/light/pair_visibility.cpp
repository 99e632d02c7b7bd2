// SPDX-License-Identifier: Apache-2.0
#include "city/light/pair_visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <queue>

#include "city/light/convex_view.h"
#include "city/model/triangulate.h"

namespace helio {
namespace {

/// Beyond these the receiver is not cut along the planes where the view changes in kind.
constexpr size_t kMaxPlanes = 256, kMaxCells = 1024;
constexpr u32 kFirstHalvings = 3;

bool isConvex(const Ring3& ring, const glm::dvec3& normal)
{
    const size_t n = ring.size();
    for (size_t k = 0; k < n; ++k) {
        const glm::dvec3 in = ring[(k + 1) % n] - ring[k], out = ring[(k + 2) % n] - ring[(k + 1) % n];
        if (glm::dot(glm::cross(in, out), normal) < 0.0) return false;
    }
    return true;
}

/// A ring relative to an origin, as convex pieces.
std::vector<Convex> convexPieces(const Ring3& ring, const glm::dvec3& origin)
{
    Polygon3 polygon;
    for (const glm::dvec3& corner : ring) polygon.outer.push_back(corner - origin);
    const glm::dvec3 normal = unitNormal(polygon);
    // Left turns alone make a ring convex as long as it does not cross itself.
    if (isConvex(polygon.outer, normal)) return {polygon.outer};
    std::vector<Convex> pieces;
    for (const auto& [i, j, k] : triangulate(polygon))
        pieces.push_back({polygon.outer[i], polygon.outer[j], polygon.outer[k]});
    return pieces;
}

void clipAll(std::vector<Convex>& polygons, const HalfSpace& half, double tolerance)
{
    for (Convex& polygon : polygons) polygon = clipConvex(polygon, half, tolerance);
    std::erase_if(polygons, [](const Convex& polygon) { return polygon.empty(); });
}

HalfSpace planeOf(const Ring3& ring, const glm::dvec3& origin)
{
    Ring3 relative;
    for (const glm::dvec3& corner : ring) relative.push_back(corner - origin);
    const glm::dvec3 normal = glm::normalize(vectorArea(relative));
    return {normal, glm::dot(normal, relative[0])};
}

/// Visible and blocked part of an integral over the receiver.
struct Split
{
    double visible = 0.0, blocked = 0.0;
};

struct Triangle
{
    glm::dvec3 a, b, c;
};

std::array<Triangle, 4> quarter(const Triangle& t)
{
    const glm::dvec3 ab = 0.5 * (t.a + t.b), bc = 0.5 * (t.b + t.c), ca = 0.5 * (t.c + t.a);
    return {Triangle{t.a, ab, ca}, {ab, t.b, bc}, {ca, bc, t.c}, {ab, bc, ca}};
}

/// The pair relative to the receiver's first corner, each part before the planes of the others.
class View
{
public:
    View(const OccludedPair& pair, u64 workLimit) : workLimit_(workLimit)
    {
        const glm::dvec3 origin = pair.receiver[0];
        receiver_ = planeOf(pair.receiver, origin);
        sender_ = planeOf(pair.sender, origin);
        receivers_ = convexPieces(pair.receiver, origin);
        senders_ = convexPieces(pair.sender, origin);
        clipAll(receivers_, sender_, pair.tolerance);
        clipAll(senders_, receiver_, pair.tolerance);
        glm::dvec3 low(1e300), high(-1e300);
        for (const std::vector<Convex>* side : {&receivers_, &senders_}) {
            for (const Convex& polygon : *side) {
                for (const glm::dvec3& p : polygon) {
                    low = glm::min(low, p);
                    high = glm::max(high, p);
                }
            }
        }
        for (const Ring3& ring : pair.occluders) {
            if (glm::length(vectorArea(ring)) <= 0.0) continue;
            std::vector<Convex> pieces = convexPieces(ring, origin);
            // Only what lies between blocks: before both planes and within the box of both polygons.
            clipAll(pieces, sender_, pair.tolerance);
            clipAll(pieces, receiver_, pair.tolerance);
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 unit(0.0);
                unit[axis] = 1.0;
                std::erase_if(pieces, [&](const Convex& p) {
                    const auto in = [&](const glm::dvec3& q) { return q[axis]; };
                    return std::ranges::max(p, {}, in)[axis] < low[axis] ||
                           std::ranges::min(p, {}, in)[axis] > high[axis];
                });
            }
            for (Convex& piece : pieces) occluders_.push_back(std::move(piece));
        }
    }

    bool isFree() const { return occluders_.empty(); }
    /// Edges of occluders tried against pieces of the sender so far.
    u64 work() const { return work_; }
    /// True if some point had to be left unseen.
    bool isExhausted() const { return work_ > workLimit_; }

    /// Factors from a point of the receiver.
    Split at(const glm::dvec3& point)
    {
        std::vector<Convex> visible = senders_, hidden;
        // What lies behind the point needs no cutting off: its pyramid opens away from the sender.
        for (const Convex& occluder : occluders_) {
            work_ += visible.size() * occluder.size();
            if (isExhausted()) return {};
            hideBehind(point, occluder, visible, hidden);
        }
        Split sum;
        for (const Convex& piece : visible) sum.visible += convexFactor(point, receiver_.normal, piece);
        for (const Convex& piece : hidden) sum.blocked += convexFactor(point, receiver_.normal, piece);
        return sum;
    }

    /// The receiver in triangles, cut where the view changes in kind.
    std::vector<Triangle> cells(double tolerance) const
    {
        std::vector<Convex> cells = receivers_;
        if (const std::vector<HalfSpace> planes = eventPlanes(); planes.size() <= kMaxPlanes) {
            for (const HalfSpace& plane : planes) {
                const size_t count = cells.size();
                if (count > kMaxCells) break;
                for (size_t k = 0; k < count; ++k) {
                    Convex above = clipConvex(cells[k], plane, tolerance);
                    Convex below = clipConvex(cells[k], {-plane.normal, -plane.offset}, tolerance);
                    if (above.empty() || below.empty()) continue;
                    cells[k] = std::move(above);
                    cells.push_back(std::move(below));
                }
            }
            return trianglesOf(cells, 0);
        }
        // Too many kinds of view: small cells at first, so that few shadows fall between the points.
        return trianglesOf(cells, kFirstHalvings);
    }

private:
    static std::vector<Triangle> trianglesOf(const std::vector<Convex>& cells, u32 halvings)
    {
        std::vector<Triangle> triangles;
        for (const Convex& cell : cells)
            for (size_t k = 1; k + 1 < cell.size(); ++k) triangles.push_back({cell[0], cell[k], cell[k + 1]});
        for (u32 round = 0; round < halvings; ++round) {
            std::vector<Triangle> finer;
            for (const Triangle& triangle : triangles)
                for (const Triangle& child : quarter(triangle)) finer.push_back(child);
            triangles = std::move(finer);
        }
        return triangles;
    }

    /// Planes through an edge of one and a corner of the other of sender and occluder, and the occluders' own.
    std::vector<HalfSpace> eventPlanes() const
    {
        std::vector<HalfSpace> planes;
        const auto addPlane = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
            const glm::dvec3 n = glm::cross(b - a, c - a);
            const double length = glm::length(n);
            if (length > 1e-12 * glm::length(b - a) * glm::length(c - a))
                planes.push_back({n / length, glm::dot(n, a) / length});
        };
        const auto addAll = [&](const Convex& edges, const Convex& corners) {
            for (size_t k = 0; k < edges.size() && planes.size() <= kMaxPlanes; ++k)
                for (const glm::dvec3& corner : corners) addPlane(edges[k], edges[(k + 1) % edges.size()], corner);
        };
        for (const Convex& occluder : occluders_) {
            addPlane(occluder[0], occluder[1], occluder[2]);
            for (const Convex& sender : senders_) {
                addAll(occluder, sender);
                addAll(sender, occluder);
            }
            if (planes.size() > kMaxPlanes) break;
        }
        return planes;
    }

    HalfSpace receiver_, sender_;
    std::vector<Convex> receivers_, senders_, occluders_;
    u64 work_ = 0, workLimit_;
};

/// Radon's rule of degree 5 for a triangle: the middle and two rings of three points.
Split integrate(View& view, const Triangle& t)
{
    const double root = std::sqrt(15.0);
    const std::array<std::array<double, 2>, 2> rings{
        {{(6.0 - root) / 21.0, (155.0 - root) / 1200.0}, {(6.0 + root) / 21.0, (155.0 + root) / 1200.0}}};
    const double area = 0.5 * glm::length(glm::cross(t.b - t.a, t.c - t.a));
    Split sum;
    const auto add = [&](const glm::dvec3& point, double weight) {
        const Split factor = view.at(point);
        sum.visible += weight * area * factor.visible;
        sum.blocked += weight * area * factor.blocked;
    };
    const glm::dvec3 whole = t.a + t.b + t.c;
    add(whole / 3.0, 9.0 / 40.0);
    for (const auto& [share, weight] : rings)
        for (const glm::dvec3& corner : {t.a, t.b, t.c}) add(share * whole + (1.0 - 3.0 * share) * corner, weight);
    return sum;
}

/// A triangle with the integrals over its four children.
struct Cell
{
    std::array<Triangle, 4> children;
    std::array<Split, 4> parts;
    Split value, error;
    double rank = 0.0;

    bool operator<(const Cell& other) const { return rank < other.rank; }
};

Cell makeCell(View& view, const Triangle& t, const Split& whole)
{
    Cell cell;
    cell.children = quarter(t);
    for (u32 k = 0; k < 4; ++k) {
        cell.parts[k] = integrate(view, cell.children[k]);
        cell.value.visible += cell.parts[k].visible;
        cell.value.blocked += cell.parts[k].blocked;
    }
    cell.error = {std::abs(cell.value.visible - whole.visible), std::abs(cell.value.blocked - whole.blocked)};
    return cell;
}

constexpr u64 kPointsPerRule = 7;

} // namespace

OccludedExchange occludedExchange(const OccludedPair& pair, double exchange, const PairAccuracy& accuracy)
{
    OccludedExchange result;
    View view(pair, 10 * accuracy.visibilityWork);
    if (view.isFree()) return result;

    std::vector<Cell> cells;
    Split sum, error;
    const auto take = [&](Cell cell, double sign) {
        sum.visible += sign * cell.value.visible;
        sum.blocked += sign * cell.value.blocked;
        error.visible += sign * cell.error.visible;
        error.blocked += sign * cell.error.blocked;
        return cell;
    };
    for (const Triangle& triangle : view.cells(pair.tolerance)) {
        cells.push_back(take(makeCell(view, triangle, integrate(view, triangle)), 1.0));
        result.points += 5 * kPointsPerRule;
    }
    const bool byVisible = sum.visible < sum.blocked;
    const auto rank = [&](const Cell& cell) { return byVisible ? cell.error.visible : cell.error.blocked; };
    for (Cell& cell : cells) cell.rank = rank(cell);
    std::priority_queue<Cell> queue(std::less<Cell>(), std::move(cells));

    const auto target = [&] {
        const double visible = byVisible ? sum.visible : exchange - sum.blocked;
        return accuracy.visibility * std::max(visible, 1e-4 * exchange);
    };
    while ((byVisible ? error.visible : error.blocked) > target() && view.work() < accuracy.visibilityWork) {
        const Cell worst = take(queue.top(), -1.0);
        queue.pop();
        if (worst.rank <= 0.0) break;
        for (u32 k = 0; k < 4; ++k) {
            Cell child = take(makeCell(view, worst.children[k], worst.parts[k]), 1.0);
            child.rank = rank(child);
            queue.push(std::move(child));
        }
        result.points += 4 * 4 * kPointsPerRule;
    }
    const double visibility = byVisible ? sum.visible / exchange : 1.0 - sum.blocked / exchange;
    result.visibility = std::clamp(visibility, 0.0, 1.0);
    result.error = view.isExhausted() ? 1.0 : std::abs(byVisible ? error.visible : error.blocked) / exchange;
    return result;
}

} // namespace helio
