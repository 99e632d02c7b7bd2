// SPDX-License-Identifier: Apache-2.0
#include "city/layout/validity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>

#include "city/layout/box_grid.h"

namespace helio {

namespace {

struct Edge
{
    glm::dvec2 a, b;
    u32 ring;
    u32 next; ///< the edge that follows on the ring
};

struct Meeting
{
    bool isCrossing = false;         ///< interiors cross, or the edges share a stretch
    std::optional<glm::dvec2> point; ///< where they touch otherwise: a corner of one of them
};

bool isOnBox(const glm::dvec2& point, const Edge& edge)
{
    return boxOf(edge.a, edge.b).touches({point, point});
}

Meeting meet(const Edge& s, const Edge& t)
{
    const int sa = orientation(t.a, t.b, s.a), sb = orientation(t.a, t.b, s.b);
    const int ta = orientation(s.a, s.b, t.a), tb = orientation(s.a, s.b, t.b);
    Meeting meeting;
    if (sa * sb > 0 || ta * tb > 0) return meeting;
    if (sa != 0 && sb != 0 && ta != 0 && tb != 0) {
        meeting.isCrossing = true;
        return meeting;
    }
    const bool isParallel = sa == 0 && sb == 0;
    const auto touch = [&](int side, const glm::dvec2& point, const Edge& other) {
        if (side != 0 || !isOnBox(point, other) || meeting.point == point) return;
        if (meeting.point && isParallel) meeting.isCrossing = true; // two points in common on one line
        meeting.point = point;
    };
    touch(sa, s.a, t);
    touch(sb, s.b, t);
    touch(ta, t.a, s);
    touch(tb, t.b, s);
    return meeting;
}

// Two rings, both through `point`, cross there if the edges of one lie on different sides of the other's corner.
bool lieOnBothSides(const glm::dvec2& point, const glm::dvec2& before, const glm::dvec2& after, const glm::dvec2& p,
                    const glm::dvec2& q)
{
    const auto isInside = [&](const glm::dvec2& x) { // within the angle from `after` to `before`, counter-clockwise
        const bool leftOfAfter = orientation(point, after, x) > 0, rightOfBefore = orientation(point, before, x) < 0;
        return orientation(point, after, before) >= 0 ? leftOfAfter && rightOfBefore : leftOfAfter || rightOfBefore;
    };
    return isInside(p) != isInside(q);
}

class Checker
{
public:
    explicit Checker(u32 maxMeetings) : maxMeetings_(maxMeetings) {}

    PolygonFindings run(const Polygon2& polygon)
    {
        const char* defect = addRings(polygon);
        if (!defect) defect = checkMeetings();
        if (!defect) defect = checkNesting();
        if (!defect && isDisconnected()) defect = "Interior is disconnected";
        return {defect, meetings_};
    }

private:
    static constexpr const char* kTooFew = "Too few points in geometry component";
    static constexpr const char* kCrossing = "Self-intersection";

    const char* addRings(const Polygon2& polygon)
    {
        bool areRings = addRing(polygon.outer);
        for (const Ring2& hole : polygon.holes) areRings = areRings && addRing(hole);
        return areRings ? nullptr : kTooFew;
    }

    bool addRing(const Ring2& ring)
    {
        Ring2 corners;
        for (const glm::dvec2& corner : ring)
            if (corners.empty() || corners.back() != corner) corners.push_back(corner);
        while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
        if (corners.size() < 3) return false;
        const u32 first = u32(edges_.size()), n = u32(corners.size());
        for (u32 i = 0; i < n; ++i)
            edges_.push_back({corners[i], corners[(i + 1) % n], u32(rings_.size()), first + (i + 1) % n});
        rings_.push_back(std::move(corners));
        return true;
    }

    double cellSize() const
    {
        double sum = 0.0;
        for (const Edge& edge : edges_) sum += glm::distance(edge.a, edge.b);
        return std::max(2.0 * sum / double(edges_.size()), 1e-9);
    }

    const char* checkMeetings()
    {
        BoxGrid grid(cellSize());
        const char* found = nullptr;
        for (u32 e = 0; e < edges_.size(); ++e) {
            const Edge& edge = edges_[e];
            const Box2 box = boxOf(edge.a, edge.b);
            for (const u32 o : grid.touching(box)) {
                const Edge& other = edges_[o];
                const Meeting meeting = meet(edge, other);
                const bool isSameRing = edge.ring == other.ring;
                const bool areNeighbours = isSameRing && (edge.next == o || other.next == e);
                if (!meeting.isCrossing && (!meeting.point || areNeighbours)) continue;
                if (++meetings_ > maxMeetings_) return kCrossing;
                if (meeting.isCrossing || (!isSameRing && crossAt(*meeting.point, e, o))) {
                    found = kCrossing;
                } else if (isSameRing) {
                    if (!found) found = "Ring Self-intersection";
                } else {
                    touches_.emplace_back(edge.ring, *meeting.point);
                    touches_.emplace_back(other.ring, *meeting.point);
                }
            }
            grid.insert(box, e);
        }
        return found;
    }

    // The corners before and after a point on a ring, of which an edge is given that holds the point.
    std::pair<glm::dvec2, glm::dvec2> around(const glm::dvec2& point, u32 edge) const
    {
        const Edge& own = edges_[edge];
        if (point == own.b) return {own.a, edges_[own.next].b};
        if (point != own.a) return {own.a, own.b};
        const Ring2& ring = rings_[own.ring];
        const size_t i = size_t(std::find(ring.begin(), ring.end(), own.a) - ring.begin());
        return {ring[(i + ring.size() - 1) % ring.size()], own.b};
    }
    bool crossAt(const glm::dvec2& point, u32 e, u32 o) const
    {
        const auto [before, after] = around(point, e);
        const auto [p, q] = around(point, o);
        return lieOnBothSides(point, before, after, p, q);
    }

    // A corner of the ring that no other ring touches; they lie on one side of each other, so that one corner tells.
    glm::dvec2 freeCorner(u32 ring) const
    {
        for (const glm::dvec2& corner : rings_[ring])
            if (std::none_of(touches_.begin(), touches_.end(),
                             [&](const auto& touch) { return touch.second == corner; }))
                return corner;
        return rings_[ring][0];
    }

    const char* checkNesting() const
    {
        BoxGrid grid(std::max(cellSize() * 8.0, 1e-9));
        for (u32 r = 1; r < rings_.size(); ++r) grid.insert(boxOf(rings_[r]), r);
        for (u32 r = 1; r < rings_.size(); ++r) {
            const glm::dvec2 corner = freeCorner(r);
            if (!contains(rings_[0], corner)) return "Hole lies outside shell";
            for (const u32 other : grid.touching({corner, corner}))
                if (other != r && contains(rings_[other], corner)) return "Holes are nested";
        }
        return nullptr;
    }

    // Rings that touch in points make a graph of rings and points; a circle in it cuts off a part of the inside.
    bool isDisconnected()
    {
        const auto byPlace = [](const auto& s, const auto& t) {
            return std::tuple(s.second.x, s.second.y, s.first) < std::tuple(t.second.x, t.second.y, t.first);
        };
        std::sort(touches_.begin(), touches_.end(), byPlace);
        touches_.erase(std::unique(touches_.begin(), touches_.end()), touches_.end());
        std::vector<u32> parent(rings_.size() + touches_.size());
        std::iota(parent.begin(), parent.end(), 0u);
        const auto root = [&](u32 i) {
            while (parent[i] != i) i = parent[i] = parent[parent[i]];
            return i;
        };
        u32 place = u32(rings_.size());
        for (size_t i = 0; i < touches_.size(); ++i) {
            if (i > 0 && touches_[i].second != touches_[i - 1].second) ++place;
            const u32 a = root(touches_[i].first), b = root(place);
            if (a == b) return true;
            parent[a] = b;
        }
        return false;
    }

    u32 maxMeetings_;
    u32 meetings_ = 0;
    std::vector<Ring2> rings_;
    std::vector<Edge> edges_;
    std::vector<std::pair<u32, glm::dvec2>> touches_; ///< ring and point
};

} // namespace

int orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c)
{
    const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
    const double det = left - right;
    // Shewchuk's bound for the plain determinant, (3 + 16 eps) eps.
    if (std::abs(det) > 3.3306690738754716e-16 * (std::abs(left) + std::abs(right))) return det > 0.0 ? 1 : -1;
    const double factors[6][2] = {{a.x, b.y}, {-a.x, c.y}, {-c.x, b.y}, {-a.y, b.x}, {a.y, c.x}, {c.y, b.x}};
    std::array<double, 12> sum{};
    size_t terms = 0;
    const auto grow = [&](double value) {
        size_t kept = 0;
        for (size_t i = 0; i < terms; ++i) {
            const double total = value + sum[i];
            const double virtualPart = total - value;
            const double rest = (value - (total - virtualPart)) + (sum[i] - virtualPart);
            value = total;
            if (rest != 0.0) sum[kept++] = rest;
        }
        if (value != 0.0 || kept == 0) sum[kept++] = value;
        terms = kept;
    };
    for (const auto& [x, y] : factors) {
        const double product = x * y;
        grow(std::fma(x, y, -product));
        grow(product);
    }
    const double largest = sum[terms - 1];
    return largest > 0.0 ? 1 : largest < 0.0 ? -1 : 0;
}

PolygonFindings polygonFindings(const Polygon2& polygon, u32 maxMeetings)
{
    return Checker(maxMeetings).run(polygon);
}

} // namespace helio
