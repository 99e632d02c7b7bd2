// SPDX-License-Identifier: Apache-2.0
#include "city/layout/census.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "city/base/check.h"
#include "city/layout/box_grid.h"
#include "city/layout/overlaps.h"
#include "city/layout/validity.h"

namespace helio {

namespace {

constexpr double kSameCorner = 1e-3;                             // m
constexpr double kShortEdge = 0.25;                              // m
constexpr double kStraightAngle = 0.01;                          // rad
constexpr double kSpikeAngle = 179.0 * std::numbers::pi / 180.0; // rad
constexpr double kWallGap = 0.05;                                // m
constexpr double kWallLength = 0.5;                              // m
constexpr double kWallAngle = 0.01745;                           // sine of 1 degree

double perimeter(const Ring2& ring)
{
    double sum = 0.0;
    for (size_t i = 0; i < ring.size(); ++i) sum += glm::distance(ring[i], ring[(i + 1) % ring.size()]);
    return sum;
}

// Andrew's monotone chain.
double hullArea(Ring2 points)
{
    std::sort(points.begin(), points.end(),
              [](const auto& p, const auto& q) { return p.x < q.x || (p.x == q.x && p.y < q.y); });
    Ring2 hull;
    for (int pass = 0; pass < 2; ++pass) {
        const size_t first = hull.size();
        for (const glm::dvec2& point : points) {
            while (hull.size() >= first + 2 && cross(hull[hull.size() - 2], hull.back(), point) <= 0.0) hull.pop_back();
            hull.push_back(point);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return signedArea(hull);
}

double angleAt(const glm::dvec2& before, const glm::dvec2& corner, const glm::dvec2& after)
{
    return std::abs(std::atan2(cross(corner - before, after - corner), glm::dot(corner - before, after - corner)));
}

struct RingFindings
{
    bool hasRepeat = false, hasShortEdge = false, hasStraightCorner = false;
    u32 spikes = 0;
};

void look(const Ring2& ring, RingFindings& findings)
{
    const size_t n = ring.size();
    Ring2 corners; // without repeats, between which there is no angle
    for (size_t i = 0; i < n; ++i) {
        const double length = glm::distance(ring[i], ring[(i + 1) % n]);
        if (length >= kSameCorner) corners.push_back(ring[i]);
        if (length < kSameCorner)
            findings.hasRepeat = true;
        else if (length < kShortEdge)
            findings.hasShortEdge = true;
    }
    for (size_t i = 0; corners.size() >= 3 && i < corners.size(); ++i) {
        const size_t m = corners.size();
        const double angle = angleAt(corners[(i + m - 1) % m], corners[i], corners[(i + 1) % m]);
        if (angle < kStraightAngle) findings.hasStraightCorner = true;
        if (angle > kSpikeAngle) ++findings.spikes;
    }
}

struct Wall
{
    glm::dvec2 a, b;
    u32 polygon;
};

// Length of `wall` along which `other` runs.
double commonLength(const Wall& wall, const Wall& other)
{
    const double length = glm::distance(wall.a, wall.b), otherLength = glm::distance(other.a, other.b);
    if (length < kWallLength || otherLength < kWallLength) return 0.0;
    const glm::dvec2 along = (wall.b - wall.a) / length;
    if (std::abs(cross(along, other.b - other.a)) > kWallAngle * otherLength) return 0.0;
    if (std::abs(cross(along, other.a - wall.a)) > kWallGap || std::abs(cross(along, other.b - wall.a)) > kWallGap)
        return 0.0;
    const double s = glm::dot(other.a - wall.a, along), t = glm::dot(other.b - wall.a, along);
    return std::min(length, std::max(s, t)) - std::max(0.0, std::min(s, t));
}

u32 countInSharedWalls(std::span<const Polygon2> polygons)
{
    std::vector<Wall> walls;
    BoxGrid grid(16.0);
    const auto add = [&](const Ring2& ring, u32 polygon) {
        for (size_t i = 0; i < ring.size(); ++i) {
            const Wall wall{ring[i], ring[(i + 1) % ring.size()], polygon};
            grid.insert(boxOf(wall.a, wall.b), u32(walls.size()));
            walls.push_back(wall);
        }
    };
    for (u32 p = 0; p < polygons.size(); ++p) {
        add(polygons[p].outer, p);
        for (const Ring2& hole : polygons[p].holes) add(hole, p);
    }
    std::vector<bool> isShared(polygons.size(), false);
    for (const Wall& wall : walls) {
        if (isShared[wall.polygon]) continue;
        for (const u32 other : grid.touching(boxOf(wall.a, wall.b).grown(kWallGap)))
            if (walls[other].polygon != wall.polygon && commonLength(wall, walls[other]) > kWallLength)
                isShared[wall.polygon] = true;
    }
    return u32(std::count(isShared.begin(), isShared.end(), true));
}

class Census
{
public:
    void add(const Polygon2& polygon)
    {
        ++counts_["polygons"];
        const u32 holes = u32(polygon.holes.size());
        counts_["holes"] += holes;
        counts_["with_holes"] += holes > 0;
        RingFindings findings;
        look(polygon.outer, findings);
        counts_["vertices"] += u32(polygon.outer.size());
        counts_["has_collinear_vertex"] += findings.hasStraightCorner;
        for (const Ring2& hole : polygon.holes) {
            look(hole, findings);
            counts_["vertices"] += u32(hole.size());
        }
        counts_["has_duplicate_vertex(<1mm)"] += findings.hasRepeat;
        counts_["has_short_edge(1mm..0.25m)"] += findings.hasShortEdge;
        counts_["spike_vertices"] += findings.spikes;
        const double outer = signedArea(polygon.outer);
        double covered = std::abs(outer);
        for (const Ring2& hole : polygon.holes) covered -= std::abs(signedArea(hole));
        counts_["clockwise_outer"] += outer < 0.0;
        counts_["non_convex(<95% hull)"] += std::abs(outer) < 0.95 * hullArea(polygon.outer);
        const double around = perimeter(polygon.outer);
        counts_["slivers(compactness<0.12)"] += 4.0 * std::numbers::pi * std::abs(outer) < 0.12 * around * around;
        counts_["tiny(<4m2)"] += covered < 4.0;
        const PolygonFindings validity = polygonFindings(polygon);
        counts_["invalid"] += validity.defect != nullptr;
        if (validity.defect) ++counts_[concat("invalid_kinds.", validity.defect)];
    }
    std::map<std::string, u32>& counts() { return counts_; }

private:
    std::map<std::string, u32> counts_;
};

} // namespace

std::map<std::string, u32> censusOf(std::span<const GeoFeature> features)
{
    Census census;
    std::vector<Polygon2> polygons;
    u32 openRings = 0, missing = 0;
    for (const GeoFeature& feature : features) {
        openRings += feature.openRings;
        if (!feature.height) missing += u32(feature.polygons.size());
        for (const Polygon2& polygon : feature.polygons) {
            census.add(polygon);
            polygons.push_back(polygon);
        }
    }
    std::map<std::string, u32> counts = std::move(census.counts());
    counts["rings_not_closed"] = openRings;
    counts["missing_height"] = missing;
    counts["overlapping_pairs(>0.5m2)"] = u32(overlappingPairs(polygons).size());
    const std::vector<u32> first = firstEqual(polygons);
    u32 duplicates = 0;
    for (u32 p = 0; p < first.size(); ++p) duplicates += first[p] != p;
    counts["duplicate_footprints"] = duplicates;
    counts["in_shared_wall(>0.5m)"] = countInSharedWalls(polygons);
    return counts;
}

} // namespace helio
