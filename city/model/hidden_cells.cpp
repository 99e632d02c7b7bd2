// SPDX-License-Identifier: Apache-2.0
#include "city/model/hidden_cells.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "city/model/join_polygons.h"
#include "city/model/plane_groups.h"
#include "city/model/triangulate.h"

namespace helio {
namespace {

constexpr double kHiddenShare = 0.9;
constexpr double kStraight = -1e-9; // m2: a corner that turns no further in than this is convex
// Any direction that walls and roofs hardly ever stand across: it tells the two sides of a plane apart.
const glm::dvec3 kAside(0.3826834, 0.5411961, 0.7487563);

/// A cell in the plane of its group.
struct Flat
{
    glm::dvec2 low{1e300}, high{-1e300};
    u32 cell = 0;
    bool front = false;  // looks to the side that kAside points to
    double hidden = 0.0; // m2; what several cells hide counts several times
    std::vector<u32> by; // flat cells that hide parts of it
};

bool isConvex(const Polygon3& polygon, const glm::dvec3& normal)
{
    if (!polygon.holes.empty()) return false;
    const Ring3& ring = polygon.outer;
    for (size_t i = 0, n = ring.size(); i < n; ++i) {
        const glm::dvec3 a = ring[(i + 1) % n] - ring[i], b = ring[(i + 2) % n] - ring[(i + 1) % n];
        if (glm::dot(glm::cross(a, b), normal) < kStraight) return false;
    }
    return true;
}

/// The parts of coplanar polygons inside the convex ring; `normal` is the ring's own. What lies outside goes to
/// `outside`, if there is one.
std::vector<Polygon3> clipInside(std::vector<Polygon3> parts, std::span<const glm::dvec3> ring,
                                 const glm::dvec3& normal, std::vector<Polygon3>* outside)
{
    const auto append = [](std::vector<Polygon3>& to, std::vector<Polygon3> from) {
        for (Polygon3& polygon : from) to.push_back(std::move(polygon));
    };
    for (size_t i = 0; i < ring.size() && !parts.empty(); ++i) {
        const glm::dvec3 edge = ring[(i + 1) % ring.size()] - ring[i];
        const double length = glm::length(edge);
        if (length < 1e-9) continue;
        const glm::dvec3 inwards = glm::cross(normal, edge / length);
        const double offset = glm::dot(inwards, ring[i]);
        std::vector<Polygon3> kept;
        for (const Polygon3& part : parts) {
            append(kept, clipPolygon(part, inwards, offset));
            if (outside != nullptr) append(*outside, clipPolygon(part, -inwards, -offset));
        }
        parts = std::move(kept);
    }
    return parts;
}

double sumOfAreas(std::span<const Polygon3> polygons)
{
    double sum = 0.0;
    for (const Polygon3& polygon : polygons) sum += area(polygon);
    return sum;
}

/// What is left of coplanar polygons without the convex ring.
std::vector<Polygon3> without(const std::vector<Polygon3>& polygons, std::span<const glm::dvec3> ring,
                              const glm::dvec3& normal)
{
    std::vector<Polygon3> left;
    for (const Polygon3& polygon : polygons) {
        std::vector<Polygon3> outside;
        if (clipInside({polygon}, ring, normal, &outside).empty())
            left.push_back(polygon); // whole, not in the pieces that the ring's edges cut
        else
            for (Polygon3& part : outside) left.push_back(std::move(part));
    }
    return left;
}

class HiddenSearch
{
public:
    HiddenSearch(const ShapeTree& shapes, const PatchCells& cells) : shapes_(shapes), cells_(cells) {}

    std::vector<u32> run()
    {
        const u32 count = u32(cells_.cells.size());
        for (u32 begin = 0, end = 0; begin < count; begin = end) {
            for (end = begin + 1; end < count && buildingOf(end) == buildingOf(begin);) ++end;
            if (buildingOf(begin) != kNoIndex) searchBuilding(begin, end);
        }
        std::sort(hidden_.begin(), hidden_.end());
        return std::move(hidden_);
    }

private:
    const Shape& shapeOf(u32 cell) const { return shapes_.shapes[cells_.pieces[cell].shape]; } // Cell c is of piece c.
    u32 buildingOf(u32 cell) const { return shapeOf(cell).building; }
    const Polygon3& polygonOf(u32 cell, u32 k) const
    {
        return cells_.polygon(shapes_, cells_.polygonRefs[cells_.pieces[cell].polygonBegin + k]);
    }

    void searchBuilding(u32 begin, u32 end)
    {
        std::vector<PlaneItem> planes;
        for (u32 c = begin; c < end; ++c) {
            const PatchCell& cell = cells_.cells[c];
            const bool given = shapeOf(c).op == ShapeOp::Group || shapeOf(c).sourceFace != kNoIndex;
            planes.push_back({isFront(c) ? cell.normal : -cell.normal, cell.point, given, 0});
        }
        for (std::vector<u32>& group : groupByPlane(planes)) {
            for (u32& member : group) member += begin;
            const auto front = [&](u32 c) { return isFront(c); };
            if (std::any_of(group.begin(), group.end(), front) && !std::all_of(group.begin(), group.end(), front))
                searchPlane(group);
        }
    }

    bool isFront(u32 c) const { return glm::dot(cells_.cells[c].normal, kAside) > 0.0; }

    void searchPlane(const std::vector<u32>& group)
    {
        const PlaneFrame frame = planeFrame(cells_.cells[group[0]].normal);
        const glm::dvec3 origin = cells_.cells[group[0]].point;
        std::vector<Flat> flats;
        for (const u32 c : group) {
            Flat flat;
            flat.cell = c;
            flat.front = isFront(c);
            for (u32 k = 0; k < cells_.pieces[c].polygonCount; ++k)
                for (const glm::dvec3& q : polygonOf(c, k).outer) {
                    const glm::dvec2 p(glm::dot(q - origin, frame.u), glm::dot(q - origin, frame.v));
                    flat.low = glm::min(flat.low, p);
                    flat.high = glm::max(flat.high, p);
                }
            flats.push_back(flat);
        }
        std::sort(flats.begin(), flats.end(), [](const Flat& a, const Flat& b) {
            return a.low.x != b.low.x ? a.low.x < b.low.x : a.cell < b.cell;
        });
        // A sweep: the faces of the other side that the line still crosses.
        std::vector<u32> open[2];
        for (u32 i = 0; i < flats.size(); ++i) {
            Flat& flat = flats[i];
            std::vector<u32>& others = open[flat.front ? 0 : 1];
            std::erase_if(others, [&](u32 k) { return flats[k].high.x <= flat.low.x; });
            for (const u32 k : others)
                if (flats[k].low.y < flat.high.y && flats[k].high.y > flat.low.y) meet(flats, i, k);
            open[flat.front ? 1 : 0].push_back(i);
        }
        for (const Flat& flat : flats)
            if (isHidden(flat, flats)) hidden_.push_back(flat.cell);
    }

    bool isHidden(const Flat& flat, std::span<const Flat> flats) const
    {
        const double total = cells_.cells[flat.cell].area;
        if (flat.hidden < kHiddenShare * total) return false;
        if (flat.by.size() == 1) return true;
        std::vector<Polygon3> left;
        for (u32 k = 0; k < cells_.pieces[flat.cell].polygonCount; ++k) left.push_back(polygonOf(flat.cell, k));
        for (const u32 other : flat.by) {
            const u32 c = flats[other].cell;
            for (u32 k = 0; k < cells_.pieces[c].polygonCount; ++k) {
                const Polygon3& polygon = polygonOf(c, k);
                if (isConvex(polygon, cells_.cells[c].normal)) {
                    left = without(left, polygon.outer, cells_.cells[c].normal);
                    continue;
                }
                Ring3 corners = polygon.outer;
                for (const Ring3& hole : polygon.holes) corners.insert(corners.end(), hole.begin(), hole.end());
                for (const auto& [x, y, z] : triangulate(polygon))
                    left = without(left, Ring3{corners[x], corners[y], corners[z]}, cells_.cells[c].normal);
            }
            if (sumOfAreas(left) <= (1.0 - kHiddenShare) * total) return true;
        }
        return false;
    }

    /// Adds what each of two hides of the other; both are numbers in `flats`.
    void meet(std::vector<Flat>& flats, u32 first, u32 second) const
    {
        Flat &a = flats[first], &b = flats[second];
        double sum = 0.0;
        for (u32 i = 0; i < cells_.pieces[a.cell].polygonCount; ++i)
            for (u32 k = 0; k < cells_.pieces[b.cell].polygonCount; ++k) {
                const Polygon3 &p = polygonOf(a.cell, i), &q = polygonOf(b.cell, k);
                const glm::dvec3 &n = cells_.cells[a.cell].normal, &m = cells_.cells[b.cell].normal;
                if (isConvex(p, n))
                    sum += sumOfAreas(clipInside({q}, p.outer, n, nullptr));
                else if (isConvex(q, m))
                    sum += sumOfAreas(clipInside({p}, q.outer, m, nullptr));
            }
        if (sum <= 0.0) return;
        a.hidden += sum;
        b.hidden += sum;
        a.by.push_back(second);
        b.by.push_back(first);
    }

    const ShapeTree& shapes_;
    const PatchCells& cells_;
    std::vector<u32> hidden_;
};

} // namespace

std::vector<u32> hiddenCells(const ShapeTree& shapes, const PatchCells& cells)
{
    return HiddenSearch(shapes, cells).run();
}

} // namespace helio
