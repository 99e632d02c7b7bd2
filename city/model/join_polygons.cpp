// SPDX-License-Identifier: Apache-2.0
#include "city/model/join_polygons.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "city/base/check.h"

namespace helio {
namespace {

constexpr double kSameCorner = 1e-6; // m
constexpr double kAreaKept = 1e-6;   // relative
constexpr double kNoArea = 1e-9;     // m2: rings below enclose nothing
constexpr size_t kMaxCorners = 4096;

struct Edge
{
    u32 from, to;
    friend auto operator<=>(const Edge&, const Edge&) = default;
};

/// Rings by corner number, from edges of which the shared ones cancel.
class RingChainer
{
public:
    RingChainer(std::span<const Polygon3> polygons, const glm::dvec3& normal) : frame_(planeFrame(normal))
    {
        origin_ = polygons[0].outer[0];
        for (const Polygon3& polygon : polygons) {
            addRing(polygon.outer);
            for (const Ring3& hole : polygon.holes) addRing(hole);
        }
    }

    /// False if the edges do not close.
    bool run()
    {
        splitEdges();
        return cancelEdges() && chain();
    }

    std::vector<Polygon3> polygons() const
    {
        std::vector<u32> outers, holes;
        for (u32 r = 0; r < rings_.size(); ++r) {
            const double a = ringArea(rings_[r]);
            if (a > kNoArea) outers.push_back(r);
            if (a < -kNoArea) holes.push_back(r);
        }
        std::vector<Polygon3> result;
        for (const u32 r : outers) result.push_back({inSpace(rings_[r]), {}});
        for (const u32 h : holes) {
            u32 best = kNoIndex;
            double bestArea = std::numeric_limits<double>::max();
            for (u32 k = 0; k < outers.size(); ++k) {
                const double a = ringArea(rings_[outers[k]]);
                if (a < bestArea && (outers.size() == 1 || holds(rings_[outers[k]], rings_[h]))) {
                    best = k;
                    bestArea = a;
                }
            }
            if (best == kNoIndex) return {};
            result[best].holes.push_back(inSpace(rings_[h]));
        }
        return result;
    }

private:
    void addRing(const Ring3& ring)
    {
        std::vector<u32> ids;
        for (const glm::dvec3& q : ring) {
            const glm::dvec2 p(glm::dot(q - origin_, frame_.u), glm::dot(q - origin_, frame_.v));
            u32 id = 0;
            while (id < flat_.size() && glm::dot(flat_[id] - p, flat_[id] - p) > kSameCorner * kSameCorner) ++id;
            if (id == flat_.size()) {
                flat_.push_back(p);
                space_.push_back(q);
            }
            ids.push_back(id);
        }
        for (size_t i = 0; i < ids.size(); ++i)
            if (const u32 next = ids[(i + 1) % ids.size()]; next != ids[i]) edges_.push_back({ids[i], next});
    }

    /// Edges end at every corner that lies on them, so that what two polygons share is the same edge in both.
    void splitEdges()
    {
        std::vector<Edge> pieces;
        std::vector<std::pair<double, u32>> on;
        for (const Edge& edge : edges_) {
            const glm::dvec2 a = flat_[edge.from], d = flat_[edge.to] - a;
            const double length = glm::length(d);
            on.clear();
            for (u32 v = 0; v < flat_.size(); ++v) {
                if (v == edge.from || v == edge.to) continue;
                const double along = glm::dot(flat_[v] - a, d) / length;
                if (along > 0.0 && along < length && std::abs(cross(d, flat_[v] - a)) < kSameCorner * length)
                    on.emplace_back(along, v);
            }
            std::sort(on.begin(), on.end());
            u32 from = edge.from;
            for (const auto& [along, v] : on) {
                pieces.push_back({from, v});
                from = v;
            }
            pieces.push_back({from, edge.to});
        }
        edges_ = std::move(pieces);
    }

    /// False if an edge is left twice: there the polygons overlap.
    bool cancelEdges()
    {
        std::sort(edges_.begin(), edges_.end());
        std::vector<Edge> kept;
        for (size_t i = 0; i < edges_.size();) {
            const Edge edge = edges_[i], back{edge.to, edge.from};
            size_t n = 0;
            for (; i < edges_.size() && edges_[i] == edge; ++i) ++n;
            const auto [low, high] = std::equal_range(edges_.begin(), edges_.end(), back);
            const size_t opposite = size_t(high - low);
            if (n > opposite + 1) return false;
            if (n > opposite) kept.push_back(edge);
        }
        edges_ = std::move(kept);
        return true;
    }

    bool chain()
    {
        std::vector<char> used(edges_.size(), 0);
        for (size_t first = 0; first < edges_.size(); ++first) {
            if (used[first] != 0) continue;
            std::vector<u32> ring;
            size_t at = first;
            while (true) {
                used[at] = 1;
                ring.push_back(edges_[at].from);
                if (edges_[at].to == edges_[first].from) break;
                at = nextEdge(edges_[at], used);
                if (at == edges_.size()) return false;
            }
            dropCollinear(ring);
            if (ring.size() >= 3) rings_.push_back(std::move(ring));
        }
        return true;
    }

    /// The unused edge that leaves where `edge` ends; where several do, the one that turns farthest to the left, so
    /// that parts which touch in a corner stay apart.
    size_t nextEdge(const Edge& edge, const std::vector<char>& used) const
    {
        const glm::dvec2 d = flat_[edge.to] - flat_[edge.from];
        size_t best = edges_.size();
        double bestAngle = -10.0;
        auto k = size_t(std::lower_bound(edges_.begin(), edges_.end(), Edge{edge.to, 0}) - edges_.begin());
        for (; k < edges_.size() && edges_[k].from == edge.to; ++k) {
            if (used[k] != 0) continue;
            const glm::dvec2 e = flat_[edges_[k].to] - flat_[edges_[k].from];
            const double angle = std::atan2(cross(d, e), glm::dot(d, e));
            if (angle <= bestAngle) continue;
            bestAngle = angle;
            best = k;
        }
        return best;
    }

    void dropCollinear(std::vector<u32>& ring) const
    {
        for (size_t i = 0; i < ring.size() && ring.size() > 2;) {
            const glm::dvec2 a = flat_[ring[(i + ring.size() - 1) % ring.size()]], b = flat_[ring[i]],
                             c = flat_[ring[(i + 1) % ring.size()]];
            const double length = glm::length(c - a);
            if (std::abs(cross(a, b, c)) <= kSameCorner * length && glm::dot(b - a, c - b) >= 0.0)
                ring.erase(ring.begin() + std::ptrdiff_t(i));
            else
                ++i;
        }
    }

    Ring2 inPlane(const std::vector<u32>& ring) const
    {
        Ring2 result;
        for (const u32 v : ring) result.push_back(flat_[v]);
        return result;
    }
    double ringArea(const std::vector<u32>& ring) const { return signedArea(inPlane(ring)); }
    Ring3 inSpace(const std::vector<u32>& ring) const
    {
        Ring3 result;
        for (const u32 v : ring) result.push_back(space_[v]);
        return result;
    }

    /// True if a hole lies in a ring; corners that both have say nothing.
    bool holds(const std::vector<u32>& ring, const std::vector<u32>& hole) const
    {
        for (const u32 v : hole)
            if (std::find(ring.begin(), ring.end(), v) == ring.end()) return contains(inPlane(ring), flat_[v]);
        return true;
    }

    PlaneFrame frame_;
    glm::dvec3 origin_{0.0};
    std::vector<glm::dvec2> flat_;
    std::vector<glm::dvec3> space_;
    std::vector<Edge> edges_;
    std::vector<std::vector<u32>> rings_;
};

double areaAlong(std::span<const Polygon3> polygons, const glm::dvec3& normal)
{
    double sum = 0.0;
    for (const Polygon3& polygon : polygons) sum += glm::dot(vectorArea(polygon), normal);
    return sum;
}

/// Sutherland and Hodgman: parts that fall asunder stay joined by edges on the cut that run there and back.
Ring3 clipRing(const Ring3& ring, const glm::dvec3& cut, double offset)
{
    const auto height = [&](const glm::dvec3& p) {
        const double h = glm::dot(cut, p) - offset;
        return std::abs(h) < kSameCorner ? 0.0 : h;
    };
    Ring3 result;
    for (size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec3 &a = ring[i], &b = ring[(i + 1) % ring.size()];
        const double ha = height(a), hb = height(b);
        if (ha >= 0.0) result.push_back(a);
        // From the upper to the lower end, so that both sides of the cut get the same corner.
        if (ha > 0.0 && hb < 0.0) result.push_back(a + ha / (ha - hb) * (b - a));
        if (ha < 0.0 && hb > 0.0) result.push_back(b + hb / (hb - ha) * (a - b));
    }
    return result;
}

} // namespace

std::vector<Polygon3> joinPolygons(std::span<const Polygon3> polygons, const glm::dvec3& normal)
{
    std::vector<Polygon3> same(polygons.begin(), polygons.end());
    size_t corners = 0;
    for (const Polygon3& polygon : polygons) {
        corners += polygon.outer.size();
        for (const Ring3& hole : polygon.holes) corners += hole.size();
    }
    if (corners < 3 || corners > kMaxCorners) return same;
    RingChainer chainer(polygons, normal);
    if (!chainer.run()) return same;
    std::vector<Polygon3> joined = chainer.polygons();
    const double before = areaAlong(polygons, normal), after = areaAlong(joined, normal);
    return std::abs(after - before) <= kAreaKept * before ? joined : same;
}

std::vector<Polygon3> clipPolygon(const Polygon3& polygon, const glm::dvec3& cut, double offset)
{
    Polygon3 part{clipRing(polygon.outer, cut, offset), {}};
    if (part.outer.size() < 3) return {};
    for (const Ring3& hole : polygon.holes)
        if (Ring3 ring = clipRing(hole, cut, offset); ring.size() >= 3) part.holes.push_back(std::move(ring));
    std::vector<Polygon3> parts = joinPolygons(std::span(&part, 1), unitNormal(polygon));
    std::erase_if(parts, [](const Polygon3& p) { return area(p) < kNoArea; });
    return parts;
}

std::vector<std::vector<Polygon3>> cutIntoStrips(std::span<const Polygon3> polygons, const glm::dvec3& axis, u32 count)
{
    HELIO_CHECK(count >= 1, "count = ", count);
    double low = std::numeric_limits<double>::max(), high = -low;
    for (const Polygon3& polygon : polygons)
        for (const glm::dvec3& q : polygon.outer) {
            low = std::min(low, glm::dot(axis, q));
            high = std::max(high, glm::dot(axis, q));
        }
    std::vector<std::vector<Polygon3>> strips(count);
    std::vector<Polygon3> rest(polygons.begin(), polygons.end());
    for (u32 k = 0; k + 1 < count; ++k) {
        const double offset = low + (high - low) * double(k + 1) / double(count);
        std::vector<Polygon3> above;
        for (const Polygon3& polygon : rest) {
            for (Polygon3& part : clipPolygon(polygon, -axis, -offset)) strips[k].push_back(std::move(part));
            for (Polygon3& part : clipPolygon(polygon, axis, offset)) above.push_back(std::move(part));
        }
        rest = std::move(above);
    }
    strips.back() = std::move(rest);
    return strips;
}

} // namespace helio
