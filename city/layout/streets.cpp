// SPDX-License-Identifier: Apache-2.0
#include "city/layout/streets.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "city/layout/box_grid.h"

namespace helio {

namespace {

constexpr double kReach = 30.0;   // m
constexpr double kFacing = 0.5;   // cosine of 60 degrees
constexpr double kInFront = 0.02; // m: views start off the wall, so that it does not stop them itself
constexpr size_t kMaxLooks = 16;  // street segments tried per point: a view to the nearest ones decides
constexpr double kNone = std::numeric_limits<double>::infinity();

struct Segment
{
    glm::dvec2 a, b;
};

class SegmentIndex
{
public:
    void add(const glm::dvec2& a, const glm::dvec2& b)
    {
        grid_.insert(boxOf(a, b), u32(segments_.size()));
        segments_.push_back({a, b});
    }
    std::vector<u32> near(const Box2& box) const { return grid_.touching(box); }
    const Segment& operator[](u32 i) const { return segments_[i]; }

private:
    BoxGrid grid_{16.0};
    std::vector<Segment> segments_;
};

bool cross(const Segment& s, const Segment& t)
{
    const double a = helio::cross(s.a, s.b, t.a), b = helio::cross(s.a, s.b, t.b);
    const double c = helio::cross(t.a, t.b, s.a), d = helio::cross(t.a, t.b, s.b);
    return !((a > 0 && b > 0) || (a < 0 && b < 0) || (c > 0 && d > 0) || (c < 0 && d < 0));
}

class StreetView
{
public:
    explicit StreetView(const Layout& layout)
    {
        for (const Ring2& line : layout.streets)
            for (size_t i = 0; i + 1 < line.size(); ++i) streets_.add(line[i], line[i + 1]);
        for (const Footprint& footprint : layout.footprints) {
            addWalls(footprint.outline.outer);
            for (const Ring2& hole : footprint.outline.holes) addWalls(hole);
        }
    }

    double ofEdge(const glm::dvec2& a, const glm::dvec2& b) const
    {
        const double length = glm::distance(a, b);
        if (length <= 0.0) return kNone;
        const glm::dvec2 outward = glm::dvec2(b.y - a.y, a.x - b.x) / length;
        std::vector<double> seen;
        for (const double t : {0.25, 0.5, 0.75}) seen.push_back(from(a + t * (b - a) + kInFront * outward, outward));
        std::sort(seen.begin(), seen.end());
        return seen[1] < kNone ? seen[0] : kNone;
    }

private:
    void addWalls(const Ring2& ring)
    {
        for (size_t i = 0; i < ring.size(); ++i) walls_.add(ring[i], ring[(i + 1) % ring.size()]);
    }

    double from(const glm::dvec2& eye, const glm::dvec2& outward) const
    {
        std::vector<std::pair<double, glm::dvec2>> targets;
        for (const u32 s : streets_.near(Box2{eye, eye}.grown(kReach))) {
            const glm::dvec2 point = nearestOnSegment(streets_[s].a, streets_[s].b, eye);
            const double distance = glm::distance(point, eye);
            if (distance <= kReach && glm::dot(point - eye, outward) > kFacing * distance)
                targets.emplace_back(distance, point);
        }
        std::stable_sort(targets.begin(), targets.end(),
                         [](const auto& s, const auto& t) { return s.first < t.first; });
        for (size_t i = 0; i < std::min(targets.size(), kMaxLooks); ++i)
            if (isFree({eye, targets[i].second})) return targets[i].first;
        return kNone;
    }

    bool isFree(const Segment& view) const
    {
        const std::vector<u32> near = walls_.near(boxOf(view.a, view.b));
        return std::none_of(near.begin(), near.end(), [&](u32 wall) { return cross(view, walls_[wall]); });
    }

    SegmentIndex streets_, walls_;
};

} // namespace

std::vector<std::vector<double>> streetDistances(const Layout& layout)
{
    const StreetView view(layout);
    std::vector<std::vector<double>> distances;
    for (const Footprint& footprint : layout.footprints) {
        const Ring2& ring = footprint.outline.outer;
        std::vector<double>& own = distances.emplace_back();
        for (size_t i = 0; i < ring.size(); ++i) own.push_back(view.ofEdge(ring[i], ring[(i + 1) % ring.size()]));
    }
    return distances;
}

void markStreets(Layout& layout)
{
    for (Footprint& footprint : layout.footprints) footprint.onStreet.clear();
    if (layout.streets.empty()) return;
    const std::vector<std::vector<double>> distances = streetDistances(layout);
    for (size_t f = 0; f < distances.size(); ++f)
        for (const double distance : distances[f]) layout.footprints[f].onStreet.push_back(distance < kNone);
}

} // namespace helio
