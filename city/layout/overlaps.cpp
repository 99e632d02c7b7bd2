// SPDX-License-Identifier: Apache-2.0
#include "city/layout/overlaps.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iomanip>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "city/base/check.h"
#include "city/geometry/clip.h"
#include "city/layout/box_grid.h"
#include "city/layout/polygon_repair.h"

namespace helio {

namespace {

constexpr double kWholeCover = 0.9; // share of an outline that its parts cover if they are all of it

using Corner = std::pair<i64, i64>;

// The polygon's corners on a grid of 1 cm, sorted: equal for equal polygons, however they are drawn.
std::vector<Corner> cornersOf(const Polygon2& polygon)
{
    std::vector<Corner> corners;
    const auto add = [&](const Ring2& ring) {
        for (const glm::dvec2& p : ring) corners.emplace_back(std::llround(p.x * 100.0), std::llround(p.y * 100.0));
    };
    add(polygon.outer);
    for (const Ring2& hole : polygon.holes) add(hole);
    std::sort(corners.begin(), corners.end());
    return corners;
}

std::string oneDecimal(double value)
{
    std::ostringstream out;
    out << std::fixed << std::setprecision(1) << value;
    return out.str();
}

std::vector<Polygon2> outlinesOf(std::span<const Footprint> footprints)
{
    std::vector<Polygon2> outlines;
    for (const Footprint& footprint : footprints) outlines.push_back(footprint.outline);
    return outlines;
}

// 0 inside of the ring, else the distance to its nearest edge.
double distanceTo(const Ring2& ring, const glm::dvec2& point)
{
    if (contains(ring, point)) return 0.0;
    double least = std::numeric_limits<double>::max();
    for (size_t i = 0; i < ring.size(); ++i)
        least = std::min(least, glm::distance(point, nearestOnSegment(ring[i], ring[(i + 1) % ring.size()], point)));
    return least;
}

// What others take away from one footprint.
struct Cut
{
    std::vector<u32> by;
    double area = 0.0;
};

std::string namesOf(std::span<const Footprint> footprints, const std::vector<u32>& which)
{
    std::string names;
    for (const u32 f : which) names += (names.empty() ? "" : ", ") + footprints[f].id;
    return names;
}

// The clean pieces that are left of footprint f.
std::vector<Polygon2> restOf(std::span<const Footprint> footprints, u32 f, const Cut& cut)
{
    ClipperLib::Paths others;
    for (const u32 other : cut.by) appendRings(others, footprints[other].outline);
    std::vector<Polygon2> pieces;
    RepairReport report;
    for (const Polygon2& rest : subtractToPolygons(toPaths(footprints[f].outline), others))
        for (Polygon2& piece : cleanPolygon(rest, report)) pieces.push_back(std::move(piece));
    return pieces;
}

} // namespace

bool saysPart(const std::map<std::string, Attribute>& attributes)
{
    for (const char* key : {"part", "building:part"}) {
        const auto place = attributes.find(key);
        if (place == attributes.end()) continue;
        if (const bool* flag = std::get_if<bool>(&place->second)) return *flag;
        if (const double* number = std::get_if<double>(&place->second)) return *number != 0.0;
        const std::string& word = std::get<std::string>(place->second);
        return !word.empty() && word != "no" && word != "false" && word != "0";
    }
    return false;
}

std::vector<OverlappingPair> overlappingPairs(std::span<const Polygon2> polygons, double least)
{
    BoxGrid grid(32.0);
    std::vector<Box2> boxes;
    std::vector<ClipperLib::Paths> paths;
    std::vector<OverlappingPair> pairs;
    for (u32 f = 0; f < polygons.size(); ++f) {
        boxes.push_back(boxOf(polygons[f].outer));
        paths.push_back(toPaths(polygons[f]));
    }
    for (u32 f = 0; f < polygons.size(); ++f) grid.insert(boxes[f], f);
    for (u32 f = 0; f < polygons.size(); ++f) {
        for (const u32 other : grid.touching(boxes[f])) {
            if (other <= f) continue;
            const glm::dvec2 common =
                glm::min(boxes[f].high, boxes[other].high) - glm::max(boxes[f].low, boxes[other].low);
            if (common.x * common.y <= least) continue; // most neighbours only touch
            const double shared = areaOf(intersect(paths[f], paths[other]));
            if (shared > least) pairs.push_back({f, other, shared});
        }
    }
    return pairs;
}

std::vector<u32> firstEqual(std::span<const Polygon2> polygons)
{
    std::map<std::vector<Corner>, u32> seen;
    std::vector<u32> first;
    for (u32 f = 0; f < polygons.size(); ++f) first.push_back(seen.emplace(cornersOf(polygons[f]), f).first->second);
    return first;
}

std::vector<Footprint> splitFootprint(const Footprint& whole, std::vector<Polygon2> pieces, ImportNotes& notes)
{
    std::vector<Footprint> result;
    for (Polygon2& piece : pieces) {
        Footprint footprint = whole;
        footprint.outline = std::move(piece);
        if (pieces.size() > 1) footprint.faces.clear();
        result.push_back(std::move(footprint));
    }
    if (pieces.size() > 1 && !whole.faces.empty()) {
        for (const GivenFace& face : whole.faces) {
            const glm::dvec2 foot(centroid(face.polygon));
            const auto distance = [&](const Footprint& piece) { return distanceTo(piece.outline.outer, foot); };
            const auto nearest = std::min_element(
                result.begin(), result.end(), [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
            nearest->faces.push_back(face);
        }
        const size_t bare = std::erase_if(result, [](const Footprint& piece) { return piece.faces.empty(); });
        if (bare > 0)
            notes.feature(whole.id, {{"repaired.faceless_pieces",
                                      concat("dropped ", bare, " piece(s) on which no given wall or roof stands")}});
    }
    for (size_t i = 1; i < result.size(); ++i) result[i].id = concat(whole.id, ".", i + 1);
    return result;
}

void makeIdsUnique(std::vector<Footprint>& footprints, ImportNotes& notes)
{
    std::set<std::string> ids, taken; // of all, and of those that have been passed
    for (const Footprint& footprint : footprints) ids.insert(footprint.id);
    std::map<std::string, u32> nextOf; // by id: so that many equal ids do not all count from 2
    u32 renamed = 0;
    std::string first;
    for (Footprint& footprint : footprints) {
        if (taken.insert(footprint.id).second) continue;
        u32& next = nextOf.try_emplace(footprint.id, 2).first->second;
        std::string id = concat(footprint.id, ".", next++);
        while (!ids.insert(id).second) id = concat(footprint.id, ".", next++);
        if (renamed++ == 0) first = concat(footprint.id, " is now ", id);
        taken.insert(id);
        footprint.id = std::move(id);
    }
    if (renamed == 0) return;
    notes.count("repaired.renamed", renamed);
    notes.summary(concat("ids: ", renamed,
                         " buildings shared theirs with an earlier one and were renamed (the first: ", first, ")"));
}

void replaceOutlinesByParts(std::vector<Footprint>& footprints, const std::vector<bool>& part, ImportNotes& notes)
{
    HELIO_CHECK(part.size() == footprints.size(), part.size(), " flags for ", footprints.size(), " footprints");
    if (std::none_of(part.begin(), part.end(), [](bool is) { return is; })) return;
    std::map<u32, Cut> cuts;
    for (const OverlappingPair& pair : overlappingPairs(outlinesOf(footprints))) {
        if (part[pair.first] == part[pair.second]) continue;
        const u32 outline = part[pair.first] ? pair.second : pair.first;
        const u32 own = part[pair.first] ? pair.first : pair.second;
        // A part that mostly lies elsewhere belongs to another building; that is an overlap like any other.
        if (pair.area < 0.5 * area(footprints[own].outline)) continue;
        if (footprints[own].height == 0.0) footprints[own].height = footprints[outline].height;
        cuts[outline].by.push_back(own);
        cuts[outline].area += pair.area;
    }
    std::vector<Footprint> kept;
    for (u32 f = 0; f < footprints.size(); ++f) {
        const auto cut = cuts.find(f);
        if (cut == cuts.end()) {
            kept.push_back(footprints[f]);
            continue;
        }
        const std::string parts = namesOf(footprints, cut->second.by);
        std::vector<Polygon2> rest = restOf(footprints, f, cut->second);
        double left = 0.0;
        for (const Polygon2& piece : rest) left += area(piece);
        const bool isReplaced = left <= (1.0 - kWholeCover) * area(footprints[f].outline);
        if (!isReplaced)
            for (Footprint& piece : splitFootprint(footprints[f], std::move(rest), notes))
                kept.push_back(std::move(piece));
        notes.feature(footprints[f].id,
                      {isReplaced
                           ? ImportNotes::Item{"repaired.replaced_by_parts", "replaced by its part " + parts}
                           : ImportNotes::Item{"repaired.cut_by_parts", concat("its part ", parts, " is cut from it (",
                                                                               oneDecimal(cut->second.area), " m2)")}});
    }
    footprints = std::move(kept);
}

void dropEqualFootprints(std::vector<Footprint>& footprints, ImportNotes& notes)
{
    const std::vector<u32> first = firstEqual(outlinesOf(footprints));
    std::vector<Footprint> kept;
    for (u32 f = 0; f < footprints.size(); ++f) {
        if (first[f] == f) continue;
        Footprint& earlier = footprints[first[f]];
        earlier.height = std::max(earlier.height, footprints[f].height);
        notes.feature(footprints[f].id,
                      {{"repaired.equal_dropped", concat("same outline as feature ", earlier.id, ", dropped")}});
    }
    for (u32 f = 0; f < footprints.size(); ++f)
        if (first[f] == f) kept.push_back(std::move(footprints[f]));
    footprints = std::move(kept);
}

void cutOverlaps(std::vector<Footprint>& footprints, ImportNotes& notes)
{
    std::map<u32, Cut> cuts;
    for (const OverlappingPair& pair : overlappingPairs(outlinesOf(footprints))) {
        const bool firstIsLower = footprints[pair.first].height < footprints[pair.second].height;
        Cut& cut = cuts[firstIsLower ? pair.first : pair.second];
        cut.by.push_back(firstIsLower ? pair.second : pair.first);
        cut.area += pair.area;
    }
    std::vector<Footprint> kept;
    for (u32 f = 0; f < footprints.size(); ++f) {
        const auto cut = cuts.find(f);
        if (cut == cuts.end()) {
            kept.push_back(footprints[f]);
            continue;
        }
        std::vector<Footprint> pieces = splitFootprint(footprints[f], restOf(footprints, f, cut->second), notes);
        const std::string what = concat("overlaps feature ", namesOf(footprints, cut->second.by), " by ",
                                        oneDecimal(cut->second.area), " m2, ");
        notes.feature(footprints[f].id,
                      {pieces.empty()
                           ? ImportNotes::Item{"repaired.overlap_dropped", what + "nothing remains, dropped"}
                           : ImportNotes::Item{"repaired.overlap_cut", what + "the common part is cut away"}});
        for (Footprint& piece : pieces) kept.push_back(std::move(piece));
    }
    footprints = std::move(kept);
}

} // namespace helio
