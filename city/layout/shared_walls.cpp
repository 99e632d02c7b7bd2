// SPDX-License-Identifier: Apache-2.0
#include "city/layout/shared_walls.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <set>

#include "city/layout/box_grid.h"

namespace helio {

namespace {

constexpr double kWallGap = 0.3;              // m
constexpr double kAntiparallel = -0.98480775; // cos of 170 degrees
constexpr double kSeam = 0.01;                // m

struct Wall
{
    glm::dvec2 a, b;
    u32 footprint;
};

// The stretch of `wall` that `other` stands against, m along it; empty (to <= from) if there is none.
CoveredSpan stretchOf(const Wall& wall, const Wall& other)
{
    const glm::dvec2 along = wall.b - wall.a, against = other.b - other.a;
    const double length = glm::length(along), otherLength = glm::length(against);
    if (length <= 0.0 || otherLength <= 0.0) return {};
    if (glm::dot(along, against) > kAntiparallel * length * otherLength) return {};
    const auto position = [&](const glm::dvec2& p) { return glm::dot(p - wall.a, along) / length; };
    const auto distance = [&](const glm::dvec2& p) { return cross(along, p - wall.a) / length; };
    const double start = position(other.b), end = position(other.a); // antiparallel: b comes first
    const double first = distance(other.b), last = distance(other.a);
    CoveredSpan span{std::max(0.0, start), std::min(length, end), 0.0};
    // The distance runs linearly from `first` to `last`: keep where it is within the gap.
    const double slope = (last - first) / (end - start);
    for (const double side : {1.0, -1.0}) {
        const double atBegin = side * (first + slope * (span.begin - start));
        const double atEnd = side * (first + slope * (span.end - start));
        if (atBegin > kWallGap && atEnd > kWallGap) return {};
        const double crossing = start + (side * kWallGap - first) / slope;
        if (atBegin > kWallGap) span.begin = crossing;
        if (atEnd > kWallGap) span.end = crossing;
    }
    return span;
}

// The stretches made disjoint, each with the largest height there, tidied at the ends and seams.
std::vector<CoveredSpan> mergeSpans(const std::vector<CoveredSpan>& spans, double length)
{
    struct Event
    {
        double at;
        bool isBegin;
        double height;
    };
    std::vector<Event> events;
    for (const CoveredSpan& span : spans) {
        events.push_back({span.begin < kSeam ? 0.0 : span.begin, true, span.height});
        events.push_back({span.end > length - kSeam ? length : span.end, false, span.height});
    }
    std::sort(events.begin(), events.end(),
              [](const Event& a, const Event& b) { return a.at != b.at ? a.at < b.at : a.isBegin > b.isBegin; });
    std::vector<CoveredSpan> merged;
    std::multiset<double> heights;
    double at = 0.0;
    for (const Event& event : events) {
        if (!heights.empty() && event.at - at >= kSeam) {
            const double height = *heights.rbegin();
            if (!merged.empty() && at - merged.back().end < kSeam) {
                at = merged.back().end;
                if (merged.back().height == height) {
                    merged.back().end = event.at;
                    at = event.at;
                }
            }
            if (event.at > at) merged.push_back({at, event.at, height});
            at = event.at;
        } else if (heights.empty()) {
            at = event.at;
        }
        if (event.isBegin)
            heights.insert(event.height);
        else
            heights.erase(heights.find(event.height));
    }
    return merged;
}

template <class Visit> void forEachEdge(const Polygon2& outline, Visit&& visit)
{
    const auto walk = [&](const Ring2& ring) {
        for (size_t i = 0; i < ring.size(); ++i) visit(ring[i], ring[(i + 1) % ring.size()]);
    };
    walk(outline.outer);
    for (const Ring2& hole : outline.holes) walk(hole);
}

} // namespace

void findSharedWalls(Layout& layout)
{
    std::vector<Wall> walls;
    BoxGrid grid(16.0);
    for (u32 f = 0; f < layout.footprints.size(); ++f) {
        forEachEdge(layout.footprints[f].outline, [&](const glm::dvec2& a, const glm::dvec2& b) {
            grid.insert(boxOf(a, b), u32(walls.size()));
            walls.push_back({a, b, f});
        });
    }
    for (Footprint& footprint : layout.footprints) footprint.covered.clear();
    for (const Wall& wall : walls) {
        Footprint& own = layout.footprints[wall.footprint];
        std::vector<CoveredSpan> spans;
        for (const u32 candidate : grid.touching(boxOf(wall.a, wall.b).grown(kWallGap))) {
            const Wall& other = walls[candidate];
            if (other.footprint == wall.footprint) continue;
            CoveredSpan span = stretchOf(wall, other);
            const Footprint& neighbour = layout.footprints[other.footprint];
            span.height = neighbour.base + neighbour.height - own.base;
            if (span.end > span.begin && span.height > 0.0) spans.push_back(span);
        }
        own.covered.push_back(mergeSpans(spans, glm::distance(wall.a, wall.b)));
    }
}

double coveredHalf(std::span<const CoveredSpan> spans, double length)
{
    std::vector<CoveredSpan> byHeight(spans.begin(), spans.end());
    std::stable_sort(byHeight.begin(), byHeight.end(),
                     [](const auto& a, const auto& b) { return a.height > b.height; });
    double covered = 0.0;
    for (const CoveredSpan& span : byHeight) {
        covered += span.end - span.begin;
        if (covered >= (0.5 - 1e-9) * length) return span.height;
    }
    return 0.0;
}

} // namespace helio
