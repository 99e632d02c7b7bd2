// SPDX-License-Identifier: Apache-2.0
#include "city/layout/cityjson_building.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "city/base/check.h"
#include "city/geometry/clip.h"
#include "city/model/triangulate.h"

namespace helio {

namespace {

constexpr double kSmallestFace = 1e-4;   // m2
constexpr double kPlaneTolerance = 0.01; // m
constexpr double kLevel = 0.7;           // |z| of the normal: steeper is no floor
constexpr double kVertical = 0.05;       // |z| of the normal: below, nothing is seen from above
constexpr double kSoffitHeight = 0.3;    // m above the ground, from which light gets under a floor
constexpr size_t kMostCorners = 10000;   // of the surfaces that are united; crossings may grow with the square

struct Extent
{
    double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
    void add(const CitySurface& surface)
    {
        for (const glm::dvec3& corner : surface.polygon.outer) {
            low = std::min(low, corner.z);
            high = std::max(high, corner.z);
        }
    }
};

Extent extentOf(const CitySurface& surface)
{
    Extent extent;
    extent.add(surface);
    return extent;
}

Ring2 fromAbove(const Ring3& ring, bool reversed)
{
    Ring2 flat;
    for (const glm::dvec3& corner : ring) flat.emplace_back(corner);
    if (reversed) std::reverse(flat.begin(), flat.end());
    return flat;
}

Polygon2 fromAbove(const CitySurface& surface)
{
    const bool looksDown = vectorArea(surface.polygon.outer).z < 0.0;
    Polygon2 polygon{fromAbove(surface.polygon.outer, looksDown), {}};
    for (const Ring3& hole : surface.polygon.holes) polygon.holes.push_back(fromAbove(hole, looksDown));
    return polygon;
}

using Surfaces = std::vector<const CitySurface*>;

double areaFromAbove(const Surfaces& surfaces)
{
    double sum = 0.0;
    for (const CitySurface* surface : surfaces) sum += std::abs(vectorArea(surface->polygon.outer).z);
    return sum;
}

// The floors that lie on the ground: not those of balconies and passages above it.
Surfaces lowestFloors(const Surfaces& floors, const Extent& building)
{
    double lowest = std::numeric_limits<double>::max();
    for (const CitySurface* floor : floors) lowest = std::min(lowest, extentOf(*floor).low);
    const double limit = lowest + std::max(1.0, 0.25 * (building.high - lowest));
    Surfaces result;
    for (const CitySurface* floor : floors)
        if (extentOf(*floor).low <= limit) result.push_back(floor);
    return result;
}

std::vector<Polygon2> united(const Surfaces& surfaces)
{
    if (surfaces.size() == 1) return {fromAbove(*surfaces[0])};
    ClipperLib::Paths paths;
    for (const CitySurface* surface : surfaces) appendRings(paths, fromAbove(*surface));
    // In two steps: asked for simple polygons at once, Clipper cuts a mesh of triangles into pieces that touch.
    return subtractToPolygons(unite(paths), {});
}

double distanceToPlane(const Polygon3& polygon, const glm::dvec3& normal)
{
    const glm::dvec3 middle = centroid(polygon);
    double largest = 0.0;
    const auto measure = [&](const Ring3& ring) {
        for (const glm::dvec3& corner : ring) largest = std::max(largest, std::abs(glm::dot(corner - middle, normal)));
    };
    measure(polygon.outer);
    for (const Ring3& hole : polygon.holes) measure(hole);
    return largest;
}

void turn(Polygon3& polygon)
{
    std::reverse(polygon.outer.begin(), polygon.outer.end());
    for (Ring3& hole : polygon.holes) std::reverse(hole.begin(), hole.end());
}

// Holes run against the outer ring; those without area go.
void cleanHoles(Polygon3& polygon)
{
    const glm::dvec3 normal = vectorArea(polygon.outer);
    std::erase_if(polygon.holes, [](const Ring3& hole) { return glm::length(vectorArea(hole)) < kSmallestFace; });
    for (Ring3& hole : polygon.holes)
        if (glm::dot(vectorArea(hole), normal) > 0.0) std::reverse(hole.begin(), hole.end());
}

std::vector<Polygon3> trianglesOf(const Polygon3& polygon)
{
    std::vector<glm::dvec3> corners = polygon.outer;
    for (const Ring3& hole : polygon.holes) corners.insert(corners.end(), hole.begin(), hole.end());
    std::vector<Polygon3> result;
    for (const std::array<u32, 3>& triangle : triangulate(polygon))
        result.push_back({{corners[triangle[0]], corners[triangle[1]], corners[triangle[2]]}, {}});
    return result;
}

// Counts the edges of outer rings by direction. Two faces that look to the same side of a skin pass their common edge
// in opposite directions.
class EdgeDirections
{
public:
    explicit EdgeDirections(const std::vector<CitySurface>& surfaces)
    {
        for (const CitySurface& surface : surfaces)
            forEachEdge(surface, [&](u64 edge, u64) { edges_.push_back(edge); });
        std::sort(edges_.begin(), edges_.end());
    }
    /// True if more neighbours of the surface look to its other side than to its own.
    bool isAgainstNeighbours(const CitySurface& surface) const
    {
        size_t along = 0, against = 0;
        forEachEdge(surface, [&](u64 edge, u64 reversed) {
            against += count(edge) - 1;
            along += count(reversed);
        });
        return against > along;
    }

private:
    template <class Visit> static void forEachEdge(const CitySurface& surface, const Visit& visit)
    {
        for (size_t i = 0; i < surface.corners.size(); ++i) {
            const u64 a = surface.corners[i], b = surface.corners[(i + 1) % surface.corners.size()];
            if (a != b) visit(a << 32 | b, b << 32 | a);
        }
    }
    size_t count(u64 edge) const
    {
        const auto [first, last] = std::equal_range(edges_.begin(), edges_.end(), edge);
        return size_t(last - first);
    }

    std::vector<u64> edges_;
};

// Nothing for the building's floor and for what is inside.
std::optional<GivenKind> kindOf(const CitySurface& surface, double normalZ, double ground)
{
    switch (surface.kind) {
    case SurfaceKind::Inside:
    case SurfaceKind::Ground:
        return std::nullopt;
    case SurfaceKind::Wall:
        return GivenKind::Wall;
    case SurfaceKind::Roof:
        return GivenKind::Roof;
    case SurfaceKind::Unknown:
        break;
    }
    if (normalZ < -kLevel) {
        if (extentOf(surface).low < ground + kSoffitHeight) return std::nullopt;
        return GivenKind::Roof;
    }
    return std::abs(normalZ) < 0.2 || normalZ < 0.0 ? GivenKind::Wall : GivenKind::Roof;
}

// Negative if the surfaces look inward. A floor that is missing lies in the plane of the reference point and adds
// nothing.
double volumeAbove(double ground, const std::vector<CitySurface>& surfaces)
{
    double volume = 0.0;
    for (const CitySurface& surface : surfaces)
        if (surface.kind != SurfaceKind::Inside)
            volume += glm::dot(centroid(surface.polygon) - glm::dvec3(0.0, 0.0, ground), vectorArea(surface.polygon));
    return volume / 3.0;
}

} // namespace

GroundOutline groundOutline(const SurfaceSet& set)
{
    Surfaces byName, floors, roofs, seen;
    Extent all;
    for (const CitySurface& surface : set.surfaces) {
        if (surface.kind == SurfaceKind::Inside) continue;
        all.add(surface);
        const glm::dvec3 vector = vectorArea(surface.polygon.outer);
        const double size = glm::length(vector);
        if (size < kSmallestFace || std::abs(vector.z) < kVertical * size) continue;
        seen.push_back(&surface);
        if (surface.kind == SurfaceKind::Ground) byName.push_back(&surface);
        if (surface.kind == SurfaceKind::Unknown && vector.z < -kLevel * size) floors.push_back(&surface);
        if (vector.z > 0.0) roofs.push_back(&surface);
    }
    GroundOutline outline;
    if (seen.empty()) {
        outline.trouble = set.trouble.empty() ? "no surface has an area seen from above" : set.trouble;
        return outline;
    }
    Surfaces chosen = byName;
    if (chosen.empty()) {
        chosen = lowestFloors(floors, all);
        if (areaFromAbove(chosen) < 0.5 * areaFromAbove(roofs)) chosen.clear();
    }
    Extent ground;
    for (const CitySurface* surface : chosen) ground.add(*surface);
    if (chosen.empty()) {
        chosen = roofs.empty() ? seen : roofs;
        ground = all;
        outline.fromRoof = true;
    }
    outline.ground = ground.low;
    outline.top = all.high;
    size_t corners = 0;
    for (const CitySurface* surface : chosen) {
        corners += surface->polygon.outer.size();
        for (const Ring3& hole : surface->polygon.holes) corners += hole.size();
    }
    if (corners > kMostCorners && chosen.size() > 1) {
        outline.trouble = concat("ground surfaces of ", corners, " corners, ", kMostCorners, " are the most");
        return outline;
    }
    outline.polygons = united(chosen);
    if (outline.polygons.empty()) outline.trouble = "the ground surfaces have no area";
    return outline;
}

std::vector<GivenFace> facesOf(const SurfaceSet& set, const GroundOutline& outline, FaceReport& report)
{
    report.degenerate += set.degenerate;
    std::vector<GivenFace> faces;
    const bool insideOut = volumeAbove(outline.ground, set.surfaces) < 0.0;
    const EdgeDirections directions(set.surfaces);
    const glm::dvec3 shift(set.anchor.x, set.anchor.y, -outline.ground);
    for (const CitySurface& surface : set.surfaces) {
        Polygon3 polygon = surface.polygon;
        cleanHoles(polygon);
        const glm::dvec3 vector = vectorArea(polygon);
        if (glm::length(vector) < kSmallestFace) {
            ++report.degenerate;
            continue;
        }
        glm::dvec3 normal = glm::normalize(vector);
        if (insideOut != directions.isAgainstNeighbours(surface)) {
            turn(polygon);
            normal = -normal;
            ++report.turned;
        }
        const std::optional<GivenKind> kind = kindOf(surface, normal.z, outline.ground);
        if (!kind) continue;
        std::vector<Polygon3> pieces;
        if (distanceToPlane(polygon, normal) <= kPlaneTolerance) {
            pieces.push_back(std::move(polygon));
        } else {
            ++report.split;
            pieces = trianglesOf(polygon);
        }
        for (Polygon3& piece : pieces) {
            if (area(piece) < kSmallestFace) continue;
            for (glm::dvec3& corner : piece.outer) corner += shift;
            for (Ring3& hole : piece.holes)
                for (glm::dvec3& corner : hole) corner += shift;
            faces.push_back({std::move(piece), *kind});
        }
    }
    return faces;
}

} // namespace helio
