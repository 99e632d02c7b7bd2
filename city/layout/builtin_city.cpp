// SPDX-License-Identifier: Apache-2.0
#include "city/layout/builtin_city.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "city/base/check.h"
#include "city/layout/city_lots.h"
#include "city/geometry/clip.h"
#include "city/layout/polygon_repair.h"
#include "city/layout/shared_walls.h"

namespace helio {

namespace {

constexpr double kSize = 250.0; // m
constexpr u32 kColumns = 3, kRows = 3;

// Ground floor, storeys, cornice; the eaves of neighbours differ by a hand's breadth even where the storeys agree.
double houseHeight(Random& random, u32 storeys)
{
    const double height = 4.2 + 3.3 * (storeys - 1) + 1.2 + range(random, 0.0, 0.7);
    return std::round(height * 10.0) / 10.0;
}

Polygon2 box(const glm::dvec2& centre, const glm::dvec2& along, double length, double width)
{
    const glm::dvec2 a = 0.5 * length * along, b = 0.5 * width * glm::dvec2(-along.y, along.x);
    Polygon2 polygon;
    for (const glm::dvec2& corner : {centre - a - b, centre + a - b, centre + a + b, centre - a + b})
        polygon.outer.push_back(onMillimetre(corner));
    return polygon;
}

void addFootprint(Layout& layout, std::string id, Polygon2 outline, double height, const char* use)
{
    Footprint footprint;
    footprint.id = std::move(id);
    footprint.outline = std::move(outline);
    footprint.height = height;
    footprint.attributes["use"] = std::string(use);
    layout.footprints.push_back(std::move(footprint));
}

// Adds the pieces of at least 20 m2 and returns them.
ClipperLib::Paths addGroundOf(Layout& layout, const char* kind, const ClipperLib::Paths& paths)
{
    ClipperLib::Paths added;
    for (const Polygon2& polygon : subtractToPolygons(paths, {})) {
        if (area(polygon) < 20.0) continue;
        appendRings(added, polygon);
        GroundArea ground;
        ground.kind = kind;
        for (const glm::dvec2& corner : polygon.outer) ground.polygon.outer.emplace_back(corner, 0.0);
        for (const Ring2& hole : polygon.holes) {
            ground.polygon.holes.emplace_back();
            for (const glm::dvec2& corner : hole) ground.polygon.holes.back().emplace_back(corner, 0.0);
        }
        layout.ground.push_back(std::move(ground));
    }
    return added;
}

glm::dvec2 middleOf(const Ring2& ring)
{
    glm::dvec2 sum(0.0);
    for (const glm::dvec2& corner : ring) sum += corner;
    return sum / double(ring.size());
}

// Every house simple and none in another.
bool isBuildable(const std::vector<Lot>& lots)
{
    ClipperLib::Paths houses;
    double sum = 0.0;
    for (const Lot& lot : lots) {
        if (signedArea(lot.outline.outer) <= 0.0 || !isSimple(lot.outline)) return false;
        sum += area(lot.outline);
        appendRings(houses, lot.outline);
    }
    return sum - areaOf(unite(houses)) < 0.05;
}

// Houses at a short or sharp side of a block may stand in each other's way: then the dice are thrown again.
std::vector<Lot> divideBuildably(Random& random, const Ring2& outline)
{
    for (u32 attempt = 0; attempt < 64; ++attempt) {
        std::vector<Lot> lots = divideBlock(random, outline);
        if (isBuildable(lots)) return lots;
    }
    return {};
}

void buildBlock(Layout& layout, Random& random, const CityBlock& block, u32 number)
{
    const u32 usual = 4 + below(random, 3);
    const std::vector<Lot> lots = divideBuildably(random, block.outline);
    ClipperLib::Paths houses;
    for (u32 i = 0; i < lots.size(); ++i) {
        const u32 most = lots[i].isCorner ? usual + 1 : usual;
        const u32 storeys = std::min(7u, most - 1 + below(random, 3));
        const bool isTall = lots[i].isCorner && chance(random, 0.05);
        addFootprint(layout, concat("b", number, "-", i + 1), lots[i].outline,
                     houseHeight(random, isTall ? 9 : storeys), "house");
        appendRings(houses, lots[i].outline);
    }
    // A workshop in the court where there is room for it.
    const glm::dvec2 along = glm::normalize(block.outline[1] - block.outline[0]);
    const Polygon2 shop = box(middleOf(block.outline), along, range(random, 11.0, 16.0), range(random, 7.0, 9.0));
    const bool wanted = chance(random, 0.4);
    const ClipperLib::Paths around = offset(toPaths(shop), 5.0);
    if (wanted && areaOf(intersect(around, houses)) == 0.0) {
        addFootprint(layout, concat("b", number, "-yard"), shop, std::round(range(random, 40.0, 75.0)) / 10.0,
                     "workshop");
        appendRings(houses, shop);
    }
    const ClipperLib::Path inside = toGrid(block.outline);
    ClipperLib::Paths court = subtract({inside}, houses);
    if (chance(random, 0.6)) {
        const ClipperLib::Paths lawn = subtract(offset({inside}, -16.0), offset(unite(houses), 2.5));
        court = subtract(court, addGroundOf(layout, "green", lawn));
    }
    // A court that opens through a gap in the row is still a court.
    addGroundOf(layout, "court", court);
}

// A church with its tower on a lawn with two paths across.
void buildSquare(Layout& layout, Random& random, const CityBlock& block)
{
    const glm::dvec2 along = glm::normalize(block.outline[1] - block.outline[0]), across(-along.y, along.x);
    const glm::dvec2 centre = middleOf(block.outline);
    const double length = range(random, 24.0, 30.0), width = range(random, 12.0, 14.0), tower = 8.0;
    Polygon2 nave = box(centre, along, length, width);
    const glm::dvec2 west = centre - (0.5 * length + 0.5 * tower) * along;
    const Polygon2 spire = box(west, along, tower, tower);
    // The tower stands against the nave's last edge: its corners are the nave's corners too.
    nave.outer.push_back(spire.outer[2]);
    nave.outer.push_back(spire.outer[1]);
    addFootprint(layout, "church", nave, std::round(range(random, 130.0, 150.0)) / 10.0, "church");
    addFootprint(layout, "church-tower", spire, std::round(range(random, 300.0, 360.0)) / 10.0, "church");
    ClipperLib::Paths built = toPaths(nave);
    appendRings(built, spire);
    ClipperLib::Paths paved = offset(unite(built), 4.0);
    const double far = kSize;
    for (const glm::dvec2& direction : {glm::normalize(along + across), glm::normalize(along - across)})
        appendRings(paved, box(centre, direction, far, 3.0));
    const ClipperLib::Path square = toGrid(block.outline);
    const ClipperLib::Paths lawn = addGroundOf(layout, "green", subtract(offset({square}, -5.0), paved));
    addGroundOf(layout, "pavement", subtract(subtract({square}, lawn), built));
}

} // namespace

Layout builtinCity(u64 seed)
{
    Random random(mixSeed(hashText("built-in city"), seed));
    Layout layout;
    layout.crs = "built-in";
    const std::vector<CityBlock> blocks = planBlocks(random, kColumns, kRows, kSize);
    u32 number = 0;
    for (const CityBlock& block : blocks) {
        if (block.isSquare)
            buildSquare(layout, random, block);
        else
            buildBlock(layout, random, block, ++number);
    }
    findSharedWalls(layout);
    return layout;
}

} // namespace helio
