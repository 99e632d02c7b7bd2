// SPDX-License-Identifier: Apache-2.0
#include "city/model/hidden_cells.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "city/model/join_polygons.h"
#include "city/model/plane_groups.h"

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
    double hidden = 0.0; // m2
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

/// Area of what lies inside the convex polygon, m2; `normal` is its own.
double areaInside(const Polygon3& polygon, const Polygon3& convex, const glm::dvec3& normal)
{
    std::vector<Polygon3> parts{polygon};
    const Ring3& ring = convex.outer;
    for (size_t i = 0; i < ring.size() && !parts.empty(); ++i) {
        const glm::dvec3 edge = ring[(i + 1) % ring.size()] - ring[i];
        const double length = glm::length(edge);
        if (length < 1e-9) continue;
        const glm::dvec3 inwards = glm::cross(normal, edge / length);
        std::vector<Polygon3> kept;
        for (const Polygon3& part : parts)
            for (Polygon3& piece : clipPolygon(part, inwards, glm::dot(inwards, ring[i])))
                kept.push_back(std::move(piece));
        parts = std::move(kept);
    }
    double sum = 0.0;
    for (const Polygon3& part : parts) sum += area(part);
    return sum;
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
            planes.push_back({isFront(c) ? cell.normal : -cell.normal, cell.point, given || cell.covered, 0});
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
                if (flats[k].low.y < flat.high.y && flats[k].high.y > flat.low.y) meet(flat, flats[k]);
            open[flat.front ? 1 : 0].push_back(i);
        }
        for (const Flat& flat : flats)
            if (flat.hidden >= kHiddenShare * cells_.cells[flat.cell].area) hidden_.push_back(flat.cell);
    }

    void meet(Flat& a, Flat& b) const
    {
        for (u32 i = 0; i < cells_.pieces[a.cell].polygonCount; ++i)
            for (u32 k = 0; k < cells_.pieces[b.cell].polygonCount; ++k) {
                const Polygon3 &p = polygonOf(a.cell, i), &q = polygonOf(b.cell, k);
                const glm::dvec3 &n = cells_.cells[a.cell].normal, &m = cells_.cells[b.cell].normal;
                double shared = 0.0;
                if (isConvex(p, n))
                    shared = areaInside(q, p, n);
                else if (isConvex(q, m))
                    shared = areaInside(p, q, m);
                a.hidden += shared;
                b.hidden += shared;
            }
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
