// SPDX-License-Identifier: Apache-2.0
#include "city/layout/builtin_city.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "city/base/check.h"
#include "city/geometry/clip.h"
#include "city/layout/city_check.h"
#include "city/layout/city_lots.h"
#include "city/layout/city_rows.h"
#include "city/layout/city_towers.h"
#include "city/layout/shared_walls.h"
#include "city/layout/streets.h"

namespace helio {

namespace {

constexpr double kFar = 400.0;     // m: longer than any block
constexpr double kThinLawn = 1.75; // m: half of the least width
constexpr double kCountry = 120.0; // m: how far the green around the town reaches

// Ground floor, storeys, cornice; the eaves of neighbours differ by a hand's breadth even where the storeys agree.
double houseHeight(Random& random, u32 storeys)
{
    const double height = 4.2 + 3.3 * (storeys - 1) + 1.2 + range(random, 0.0, 0.7);
    return std::round(height * 10.0) / 10.0;
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

// The start rule of a building, in city/rules/city.cga.
std::string startRule(const std::string& use)
{
    if (use == "rowhouse" || use == "tower") return use + ".Lot";
    return "midrise.Lot";
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

// Houses at a short or sharp side of a block may stand in each other's way: then the dice are thrown again.
std::vector<Lot> divideBuildably(Random& random, const Ring2& outline)
{
    for (u32 attempt = 0; attempt < 256; ++attempt) {
        std::vector<Lot> lots = divideBlock(random, outline);
        if (isBuildable(lots)) return lots;
    }
    return {};
}

ClipperLib::Paths pathsOf(const std::vector<Polygon2>& polygons)
{
    ClipperLib::Paths paths;
    for (const Polygon2& polygon : polygons) appendRings(paths, polygon);
    return paths;
}

glm::dvec2 longestDirection(const Ring2& ring)
{
    glm::dvec2 best(0.0);
    for (size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 edge = ring[(i + 1) % ring.size()] - ring[i];
        if (glm::length(edge) > glm::length(best)) best = edge;
    }
    return glm::normalize(best);
}

// Lawns without strips that nobody would mow.
ClipperLib::Paths addLawns(Layout& layout, const ClipperLib::Paths& land)
{
    return addGroundOf(layout, "green", intersect(offset(offset(land, -kThinLawn), kThinLawn), land));
}

// Workshops in the court where there is room for them.
void addWorkshops(Layout& layout, Random& random, const Ring2& block, const std::string& name, ClipperLib::Paths& built)
{
    const glm::dvec2 across = longestDirection(block), along(across.y, -across.x), middle = middleOf(block);
    const ClipperLib::Path land = toGrid(block);
    u32 count = 0;
    for (const double shift : {-15.0, 0.0, 15.0}) {
        const double length = range(random, 10.0, 15.0), width = range(random, 6.5, 9.0);
        const double height = std::round(range(random, 40.0, 75.0)) / 10.0;
        const bool wanted = chance(random, 0.55);
        const glm::dvec2 corner =
            middle + (shift + range(random, -2.0, 2.0) - 0.5 * width) * across - 0.5 * length * along;
        const Polygon2 shop = orientedBox(corner, along, length, width);
        const ClipperLib::Paths around = offset(toPaths(shop), 4.0);
        if (!wanted || areaOf(intersect(around, built)) > 0.0 || areaOf(subtract(around, {land})) > 0.0) continue;
        addFootprint(layout, concat(name, "-yard", ++count), shop, height, "workshop");
        appendRings(built, shop);
    }
}

void buildPerimeter(Layout& layout, Random& random, const CityBlock& block, const std::string& name)
{
    // Large blocks lie at the wide streets and are built higher.
    const u32 usual = (signedArea(block.outline) > 4000.0 ? 5 : 4) + below(random, 2);
    const std::vector<Lot> lots = divideBuildably(random, block.outline);
    ClipperLib::Paths houses;
    for (u32 i = 0; i < lots.size(); ++i) {
        const u32 most = lots[i].isCorner ? usual + 1 : usual;
        const u32 storeys = std::min(7u, most - 1 + below(random, 3));
        addFootprint(layout, concat(name, "-", i + 1), lots[i].outline, houseHeight(random, storeys), "house");
        appendRings(houses, lots[i].outline);
    }
    const ClipperLib::Path inside = toGrid(block.outline);
    addWorkshops(layout, random, block.outline, name, houses);
    ClipperLib::Paths court = subtract({inside}, houses);
    if (chance(random, 0.6)) {
        const ClipperLib::Paths lawn = subtract(offset({inside}, -16.0), offset(unite(houses), 2.5));
        court = subtract(court, addLawns(layout, lawn));
    }
    // A court that opens through a gap in the row is still a court.
    addGroundOf(layout, "court", court);
}

// Gardens before and behind the houses; the passages between the rows and the way along the back fences are paved.
void buildRows(Layout& layout, Random& random, const CityBlock& block, const std::string& name)
{
    ClipperLib::Paths houses;
    u32 number = 0;
    for (const RowHouseLot& lot : divideIntoRows(random, block)) {
        const double height = lot.storeys == 2 ? 6.2 : 9.0;
        addFootprint(layout, concat(name, "-", ++number), lot.outline, height, "rowhouse");
        appendRings(houses, lot.outline);
    }
    const ClipperLib::Path land = toGrid(block.outline);
    const Ring2& corners = block.outline; // four: its streets are straight
    const glm::dvec2 west = 0.5 * (corners[0] + corners[3]), east = 0.5 * (corners[1] + corners[2]);
    const glm::dvec2 along = glm::normalize(east - west), right(along.y, -along.x);
    const ClipperLib::Paths path = toPaths(orientedBox(west - 50.0 * along + 0.75 * right, along, kFar, 1.5));
    const ClipperLib::Paths gardens = addGroundOf(layout, "green", subtract(subtract({land}, path), houses));
    ClipperLib::Paths used = addGroundOf(layout, "court", subtract(subtract({land}, gardens), houses));
    used.insert(used.end(), gardens.begin(), gardens.end());
    used.insert(used.end(), houses.begin(), houses.end());
    // Houses that stand back from the street leave its pavement to us. It takes over the corners of the gardens on its
    // border: edges that differ in their corners differ in their rounding too.
    addGroundOf(layout, "pavement", subtract(offset({land}, 1.8), unite(used)));
}

void buildTowers(Layout& layout, Random& random, const CityBlock& block, const std::string& name)
{
    const TowerPlace place = placeTowers(random, block);
    u32 number = 0;
    for (const Polygon2& lot : place.towers) {
        // The next tower is never as high as the last.
        const double height =
            42.0 + 7.0 * ((number * 2 + below(random, 2)) % 4) + std::round(range(random, 0.0, 60.0)) / 10.0;
        addFootprint(layout, concat(name, "-tower", ++number), lot, height, "tower");
    }
    for (const Polygon2& hall : place.halls)
        addFootprint(layout, concat(name, "-hall"), hall, std::round(range(random, 60.0, 80.0)) / 10.0, "hall");
    ClipperLib::Paths built = pathsOf(place.towers);
    const ClipperLib::Paths halls = pathsOf(place.halls);
    built.insert(built.end(), halls.begin(), halls.end());

    // Lawns between the ways across.
    const glm::dvec2 along = glm::normalize(block.outline[1] - block.outline[0]), across(-along.y, along.x);
    const glm::dvec2 centre = middleOf(block.outline);
    ClipperLib::Paths paved = offset(unite(built), 4.0);
    appendRings(paved, orientedBox(centre - 0.5 * kFar * along - 2.5 * across, along, kFar, 5.0));
    appendRings(paved, orientedBox(centre - 0.5 * kFar * across + 2.5 * along, across, kFar, 5.0));
    const ClipperLib::Path land = toGrid(block.outline);
    const ClipperLib::Paths lawns = addLawns(layout, subtract(offset({land}, -6.0), paved));
    addGroundOf(layout, "pavement", subtract(subtract({land}, lawns), built));
}

// An open place: lawns between two ways across and a round in the middle.
void buildSquare(Layout& layout, const CityBlock& block)
{
    const glm::dvec2 along = glm::normalize(block.outline[1] - block.outline[0]), across(-along.y, along.x);
    const glm::dvec2 centre = middleOf(block.outline);
    Polygon2 round;
    for (u32 k = 0; k < 16; ++k) {
        const double angle = 2.0 * M_PI * k / 16;
        round.outer.push_back(onMillimetre(centre + 9.0 * (std::cos(angle) * along + std::sin(angle) * across)));
    }
    ClipperLib::Paths paved = toPaths(round);
    for (const glm::dvec2& way : {glm::normalize(along + across), glm::normalize(along - across)}) {
        const glm::dvec2 left(-way.y, way.x);
        appendRings(paved, orientedBox(centre - 0.5 * kFar * way - 1.75 * left, way, kFar, 3.5));
    }
    const ClipperLib::Path square = toGrid(block.outline);
    const ClipperLib::Paths lawns = addLawns(layout, subtract(offset({square}, -5.0), paved));
    addGroundOf(layout, "pavement", subtract({square}, lawns));
}

// A green strip in the middle of the avenue, and the green behind the outermost streets.
void addStreetGreen(Layout& layout, const CityPlan& plan)
{
    for (const CityStreet& street : plan.streets) {
        if (street.kind != StreetKind::Avenue) continue;
        const glm::dvec2 a = street.line.front(), b = street.line.back(), along = glm::normalize(b - a);
        const double length = glm::distance(a, b) - 32.0;
        if (length > 10.0)
            addGroundOf(
                layout, "green",
                toPaths(orientedBox(a + 16.0 * along + 1.75 * glm::dvec2(along.y, -along.x), along, length, 3.5)));
    }
    const ClipperLib::Paths town{toGrid(plan.border)};
    const ClipperLib::Paths kerb = offset(town, 6.0), verge = offset(town, 8.5);
    addGroundOf(layout, "pavement", subtract(verge, kerb));
    addGroundOf(layout, "green", subtract(offset(town, kCountry), verge));
}

} // namespace

Layout builtinCity(u64 seed)
{
    Random random(mixSeed(hashText("built-in city"), seed));
    Layout layout;
    layout.crs = "built-in";
    const CityPlan plan = planCity(random);
    u32 number = 0;
    for (const CityBlock& block : plan.blocks) {
        const std::string name = concat("b", ++number);
        switch (block.use) {
        case BlockUse::Perimeter:
            buildPerimeter(layout, random, block, name);
            break;
        case BlockUse::Rows:
            buildRows(layout, random, block, name);
            break;
        case BlockUse::Towers:
            buildTowers(layout, random, block, name);
            break;
        case BlockUse::Square:
            buildSquare(layout, block);
            break;
        }
    }
    addStreetGreen(layout, plan);
    for (const CityStreet& street : plan.streets) layout.streets.push_back(street.line);
    for (Footprint& footprint : layout.footprints)
        footprint.rule = startRule(std::get<std::string>(footprint.attributes.at("use")));
    findSharedWalls(layout);
    markStreets(layout);
    return layout;
}

} // namespace helio
