// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/cap.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <optional>

#include "city/model/half_space.h"

namespace helio::cga {

namespace {

constexpr double kSame = 1e-6; ///< m: corners closer than this are one corner of the cut
constexpr double kGap = 1e-3;  ///< m: a loop may be closed over a gap up to this

/// The corners of a cut, each once.
class Corners
{
public:
    /// Number of the corner at this place. Sorted by x, so that only close ones are compared.
    u32 add(const glm::dvec3& p)
    {
        for (auto it = byX_.lower_bound(p.x - kSame); it != byX_.end() && it->first <= p.x + kSame; ++it)
            if (glm::distance(places_[it->second], p) <= kSame) return it->second;
        byX_.emplace(p.x, u32(places_.size()));
        places_.push_back(p);
        return u32(places_.size() - 1);
    }
    const std::vector<glm::dvec3>& places() const { return places_; }

    /// Corners that lie inside the edge a b, in its order.
    std::vector<glm::dvec3> on(const glm::dvec3& a, const glm::dvec3& b) const
    {
        const double size = glm::distance(a, b);
        if (size <= kSame) return {};
        const glm::dvec3 along = (b - a) / size;
        std::vector<std::pair<double, u32>> found;
        for (auto it = byX_.lower_bound(std::min(a.x, b.x) - kSame);
             it != byX_.end() && it->first <= std::max(a.x, b.x) + kSame; ++it) {
            const glm::dvec3& p = places_[it->second];
            const double at = glm::dot(p - a, along);
            if (at > kSame && at < size - kSame && glm::distance(a + along * at, p) <= kSame)
                found.emplace_back(at, it->second);
        }
        std::sort(found.begin(), found.end());
        std::vector<glm::dvec3> result;
        for (const auto& entry : found) result.push_back(places_[entry.second]);
        return result;
    }

private:
    std::multimap<double, u32> byX_;
    std::vector<glm::dvec3> places_;
};

/// Directed edges between corners of the cut, walked into loops.
class Seams
{
public:
    Seams(const std::vector<glm::dvec3>& corners, const glm::dvec3& normal) : corners_(corners), normal_(normal) {}

    /// Two edges in opposite directions have the solid on both sides: no cap ends there.
    void add(u32 from, u32 to)
    {
        if (from == to) return;
        const auto opposite = count_.find({to, from});
        if (opposite == count_.end() || opposite->second == 0)
            ++count_[{from, to}];
        else
            --opposite->second;
    }

    std::vector<Ring3> loops()
    {
        for (const auto& [edge, count] : count_)
            for (u32 k = 0; k < count; ++k) next_[edge.first].push_back(edge.second);
        std::vector<Ring3> result;
        for (auto& [start, ends] : next_)
            while (!ends.empty()) {
                const u32 second = ends.back();
                ends.pop_back();
                if (auto loop = walk(start, second)) result.push_back(std::move(*loop));
            }
        return result;
    }

private:
    /// Follows edges from `first` until it is reached again; none if the seams end on the way.
    std::optional<Ring3> walk(u32 first, u32 second)
    {
        Ring3 loop{corners_[first]};
        u32 before = first, at = second;
        while (at != first) {
            loop.push_back(corners_[at]);
            std::vector<u32>* ends = open(at);
            if (!ends) {
                if (glm::distance(corners_[at], corners_[first]) > kGap) return {};
                break;
            }
            // The sharpest turn to the left keeps loops that touch at a corner apart.
            const glm::dvec3 from = corners_[at] - corners_[before];
            auto best = ends->begin();
            for (auto it = ends->begin(); it != ends->end(); ++it)
                if (turn(from, corners_[*it] - corners_[at]) > turn(from, corners_[*best] - corners_[at])) best = it;
            before = at;
            at = *best;
            ends->erase(best);
        }
        return loop;
    }

    /// The edges that go on from a corner, or from another within kGap if it has none.
    std::vector<u32>* open(u32& at)
    {
        const auto found = next_.find(at);
        if (found != next_.end() && !found->second.empty()) return &found->second;
        std::vector<u32>* best = nullptr;
        double nearest = kGap;
        u32 place = at;
        for (auto& [corner, ends] : next_) {
            const double distance = glm::distance(corners_[corner], corners_[at]);
            if (ends.empty() || distance >= nearest) continue;
            nearest = distance;
            best = &ends;
            place = corner;
        }
        at = place;
        return best;
    }

    /// Angle from one direction to another about the normal, left positive.
    double turn(const glm::dvec3& from, const glm::dvec3& to) const
    {
        return std::atan2(glm::dot(glm::cross(from, to), normal_), glm::dot(from, to));
    }

    const std::vector<glm::dvec3>& corners_;
    glm::dvec3 normal_;
    std::map<std::pair<u32, u32>, u32> count_;
    std::map<u32, std::vector<u32>> next_;
};

} // namespace

void closeCut(Geometry& geometry, const std::function<bool(const glm::dvec3&)>& onPlane, const glm::dvec3& normal,
              const glm::dvec3& xAxis)
{
    Corners corners;
    std::vector<std::pair<Face*, Ring3*>> rings; // those with an edge on the plane
    const auto visit = [&](Face& face, Ring3& ring) {
        bool before = onPlane(ring.back()), edge = false;
        for (const glm::dvec3& p : ring) {
            const bool on = onPlane(p);
            if (on) corners.add(p);
            edge = edge || (on && before);
            before = on;
        }
        if (edge) rings.emplace_back(&face, &ring);
    };
    for (Face& face : geometry.faces) {
        visit(face, face.polygon.outer);
        for (Ring3& hole : face.polygon.holes) visit(face, hole);
    }
    Seams seams(corners.places(), normal);
    for (const auto& [face, ring] : rings) {
        Ring3 full;
        for (size_t k = 0; k < ring->size(); ++k) {
            const glm::dvec3 &a = (*ring)[k], &b = (*ring)[(k + 1) % ring->size()];
            full.push_back(a);
            if (!onPlane(a) || !onPlane(b)) continue;
            u32 from = corners.add(a);
            for (const glm::dvec3& p : corners.on(a, b)) {
                full.push_back(p);
                const u32 to = corners.add(p);
                seams.add(to, from); // the cap runs against the face
                from = to;
            }
            seams.add(corners.add(b), from);
        }
        if (full.size() == ring->size()) continue;
        face->edges.clear(); // they were one a corner
        *ring = std::move(full);
    }
    for (Polygon3& polygon : assembleLoops(seams.loops(), normal)) {
        Face cap;
        cap.polygon = std::move(polygon);
        cap.xAxis = xAxis;
        geometry.faces.push_back(std::move(cap));
    }
}

} // namespace helio::cga
