// SPDX-License-Identifier: Apache-2.0
#include "city/layout/ground.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <map>

#include "city/base/check.h"
#include "city/geometry/clip.h"
#include "city/layout/box_grid.h"
#include "city/layout/courts.h"
#include "city/model/materials.h"

namespace helio {

namespace {

using ClipperLib::cInt;
using ClipperLib::Path;
using ClipperLib::Paths;

constexpr u32 kBlockCells = 16;
constexpr double kSmallPiece = 1e-3; // m2

/// Everything of one kind inside the current rectangle.
struct Region
{
    u32 kind;
    Paths paths;
};

/// A rectangle of grid cells: columns [x0, x1), rows [y0, y1).
struct CellRect
{
    u32 x0, x1, y0, y1;
    u32 width() const { return x1 - x0; }
    u32 height() const { return y1 - y0; }
};

struct Cutter
{
    std::vector<cInt> x, y; // grid lines
    std::vector<std::string> kinds;
    u32 blockColumns = 1;
    std::vector<GroundArea> areas;

    Path outlineOf(const CellRect& r) const
    {
        return {{x[r.x0], y[r.y0]}, {x[r.x1], y[r.y0]}, {x[r.x1], y[r.y1]}, {x[r.x0], y[r.y1]}};
    }

    void emit(const CellRect& r, u32 kind, const Polygon2& polygon)
    {
        if (area(polygon) < kSmallPiece) return;
        const auto lift = [](const Ring2& ring) {
            Ring3 lifted;
            for (const glm::dvec2& corner : ring) lifted.emplace_back(corner, 0.0);
            return lifted;
        };
        GroundArea piece;
        piece.kind = kinds[kind];
        piece.polygon.outer = lift(polygon.outer);
        for (const Ring2& hole : polygon.holes) piece.polygon.holes.push_back(lift(hole));
        piece.block = r.y0 / kBlockCells * blockColumns + r.x0 / kBlockCells;
        areas.push_back(std::move(piece));
    }

    void emitCells(const CellRect& r, u32 kind)
    {
        for (u32 row = r.y0; row < r.y1; ++row) {
            for (u32 column = r.x0; column < r.x1; ++column) {
                const CellRect cell{column, column + 1, row, row + 1};
                emit(cell, kind, {fromGrid(outlineOf(cell)), {}});
            }
        }
    }

    bool isFull(const CellRect& r, const Paths& paths) const
    {
        return paths.size() == 1 && ClipperLib::Area(paths[0]) == ClipperLib::Area(outlineOf(r));
    }

    // Halving instead of cutting cell by cell: every corner takes part in a few clippings, and plain ground in none.
    void cut(const CellRect& r, std::vector<Region> regions)
    {
        const Path outline = outlineOf(r);
        for (Region& region : regions) region.paths = clipped(region.paths, outline);
        std::erase_if(regions, [](const Region& region) { return region.paths.empty(); });
        if (regions.size() == 1 && isFull(r, regions[0].paths)) return emitCells(r, regions[0].kind);
        if (regions.empty()) return;
        if (r.width() == 1 && r.height() == 1) {
            // Clipping rounds each region's corners by itself: what two of them claim goes to the earlier one.
            Paths taken;
            for (const Region& region : regions) {
                for (const Polygon2& polygon : subtractToPolygons(region.paths, taken)) emit(r, region.kind, polygon);
                if (regions.size() > 1) taken.insert(taken.end(), region.paths.begin(), region.paths.end());
            }
            return;
        }
        CellRect low = r, high = r;
        // At the largest power of two below the size: cuts fall on the borders of blocks.
        if (r.width() >= r.height())
            low.x1 = high.x0 = r.x0 + std::bit_floor(r.width() - 1);
        else
            low.y1 = high.y0 = r.y0 + std::bit_floor(r.height() - 1);
        cut(low, regions);
        cut(high, std::move(regions));
    }

    static Paths clipped(const Paths& paths, const Path& outline)
    {
        const cInt x0 = outline[0].X, x1 = outline[2].X, y0 = outline[0].Y, y1 = outline[2].Y;
        Paths near;
        bool isInside = true;
        for (const Path& path : paths) {
            bool left = true, right = true, below = true, above = true, within = true;
            for (const auto& p : path) {
                left = left && p.X <= x0, right = right && p.X >= x1;
                below = below && p.Y <= y0, above = above && p.Y >= y1;
                within = within && p.X >= x0 && p.X <= x1 && p.Y >= y0 && p.Y <= y1;
            }
            if (left || right || below || above) continue;
            near.push_back(path);
            isInside = isInside && within;
        }
        return near.empty() || isInside ? near : intersect(near, {outline});
    }
};

// Grid lines from low to high, at most `size` apart, on Clipper's grid.
std::vector<cInt> gridLines(double low, double high, double size)
{
    const cInt first = cInt(std::floor(low * kGridPerMetre)), last = cInt(std::ceil(high * kGridPerMetre));
    const cInt count = std::max<cInt>(1, cInt(std::ceil(double(last - first) / (size * kGridPerMetre) - 1e-9)));
    std::vector<cInt> lines;
    for (cInt i = 0; i <= count; ++i) lines.push_back(first + (last - first) * i / count);
    return lines;
}

u32 kindIndex(std::vector<std::string>& kinds, const std::string& kind)
{
    const auto place = std::find(kinds.begin(), kinds.end(), kind);
    if (place == kinds.end()) kinds.push_back(kind);
    return u32(std::find(kinds.begin(), kinds.end(), kind) - kinds.begin());
}

// What the layout says already, one region a kind in order of first appearance.
std::vector<Region> givenRegions(const Layout& layout, std::vector<std::string>& kinds)
{
    std::vector<Region> regions;
    for (const GroundArea& given : layout.ground) {
        const u32 kind = kindIndex(kinds, given.kind);
        if (kind == regions.size()) regions.push_back({kind, {}});
        const auto flatten = [](const Ring3& ring) {
            Ring2 flat;
            for (const glm::dvec3& corner : ring) flat.emplace_back(corner);
            return flat;
        };
        Polygon2 polygon{flatten(given.polygon.outer), {}};
        for (const Ring3& hole : given.polygon.holes) polygon.holes.push_back(flatten(hole));
        appendRings(regions[kind].paths, polygon);
    }
    return regions;
}

u32 surfaceIndex(ShapeTree& tree, const Surface& surface)
{
    auto place = std::find(tree.surfaces.begin(), tree.surfaces.end(), surface);
    if (place == tree.surfaces.end()) place = tree.surfaces.insert(place, surface);
    return u32(place - tree.surfaces.begin());
}

} // namespace

void addGround(Layout& layout, const GroundOptions& options)
{
    HELIO_CHECK(options.cellSize > 0.0 && options.margin >= 0.0 && options.pavementWidth >= 0.0 && options.maxCells > 0,
                options.cellSize, " ", options.margin, " ", options.pavementWidth, " ", options.maxCells);
    if (layout.footprints.empty()) return;
    Box2 box = boxOf(layout.footprints[0].outline.outer);
    Paths buildings;
    for (const Footprint& footprint : layout.footprints) {
        const Box2 own = boxOf(footprint.outline.outer);
        box = {glm::min(box.low, own.low), glm::max(box.high, own.high)};
        appendRings(buildings, footprint.outline);
    }
    box = box.grown(options.margin);
    buildings = unite(buildings);

    double cell = options.cellSize;
    const auto cellCount = [&] {
        return std::ceil((box.high.x - box.low.x) / cell) * std::ceil((box.high.y - box.low.y) / cell);
    };
    while (cellCount() > double(options.maxCells)) cell *= 2.0;
    if (cell != options.cellSize)
        layout.notes.push_back(concat("ground: cells of ", cell, " m instead of ", options.cellSize, " m, to keep to ",
                                      options.maxCells, " cells"));
    Cutter cutter;
    cutter.x = gridLines(box.low.x, box.high.x, cell);
    cutter.y = gridLines(box.low.y, box.high.y, cell);
    const CellRect all{0, u32(cutter.x.size()) - 1, 0, u32(cutter.y.size()) - 1};
    cutter.blockColumns = (all.width() + kBlockCells - 1) / kBlockCells;

    std::vector<Region> regions = givenRegions(layout, cutter.kinds);
    Paths courts;
    for (const Polygon2& court : enclosedCourts(layout.footprints)) appendRings(courts, court);
    regions.push_back({kindIndex(cutter.kinds, "court"), std::move(courts)});
    Paths pavement;
    if (options.pavementWidth > 0.0) pavement = offset(buildings, options.pavementWidth);
    regions.push_back({kindIndex(cutter.kinds, "pavement"), std::move(pavement)});
    regions.push_back({kindIndex(cutter.kinds, kOuterGround), {cutter.outlineOf(all)}});
    // Earlier kinds win; each takes its share of what is left, so that the shares tile the ground.
    Paths rest = subtract({cutter.outlineOf(all)}, buildings);
    for (Region& region : regions) {
        region.paths = intersect(rest, region.paths);
        rest = subtract(rest, region.paths);
    }
    cutter.cut(all, std::move(regions));
    std::stable_sort(cutter.areas.begin(), cutter.areas.end(),
                     [](const GroundArea& a, const GroundArea& b) { return a.block < b.block; });
    layout.ground = std::move(cutter.areas);
}

Surface groundSurface(const std::string& kind)
{
    const std::optional<glm::dvec4> rho = findMaterial(kind);
    HELIO_CHECK(rho, "ground of the kind \"", kind, "\", which is no material");
    return {kind, *rho, glm::dvec4(0.0)};
}

void appendGround(ShapeTree& tree, const Layout& layout)
{
    if (layout.ground.empty()) return;
    const auto nameIndex = [&](const std::string& name) { return kindIndex(tree.names, name); };
    const auto addShape = [&](u32 parent, const std::string& name, ShapeOp op) {
        Shape shape;
        shape.parent = parent;
        shape.name = nameIndex(name);
        shape.op = op;
        tree.shapes.push_back(shape);
        return u32(tree.shapes.size()) - 1;
    };
    const u32 root = addShape(kNoIndex, "Ground", ShapeOp::Root);
    u32 group = kNoIndex, block = kNoIndex;
    std::map<std::string, u32> surfaceOf; // by kind
    for (size_t i = 0; i < layout.ground.size(); ++i) {
        const GroundArea& piece = layout.ground[i];
        if (i == 0 || piece.block != block) group = addShape(root, "Block", ShapeOp::Group);
        block = piece.block;
        Shape& leaf = tree.shapes[addShape(group, piece.kind, ShapeOp::Group)];
        const auto [known, isNew] = surfaceOf.try_emplace(piece.kind, 0);
        if (isNew) known->second = surfaceIndex(tree, groundSurface(piece.kind));
        leaf.surface = known->second;
        leaf.polygonBegin = u32(tree.polygons.size());
        leaf.polygonCount = 1;
        tree.polygons.push_back(piece.polygon);
    }
}

} // namespace helio
