// SPDX-License-Identifier: Apache-2.0
#include "city/layout/overlaps.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "city/base/check.h"
#include "city/layout/box_grid.h"
#include "city/geometry/clip.h"
#include "city/layout/polygon_repair.h"

namespace helio {

namespace {

constexpr double kOverlap = 0.5; // m2

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

} // namespace

void dropEqualFootprints(Layout& layout)
{
    std::map<std::vector<Corner>, u32> seen;
    std::vector<Footprint> kept;
    for (Footprint& footprint : layout.footprints) {
        const auto [place, isNew] = seen.emplace(cornersOf(footprint.outline), u32(kept.size()));
        if (isNew) {
            kept.push_back(std::move(footprint));
            continue;
        }
        Footprint& first = kept[place->second];
        first.height = std::max(first.height, footprint.height);
        layout.notes.push_back(concat("feature ", footprint.id, ": same outline as feature ", first.id, ", dropped"));
    }
    layout.footprints = std::move(kept);
}

void cutOverlaps(Layout& layout)
{
    const u32 count = u32(layout.footprints.size());
    BoxGrid grid(32.0);
    std::vector<Box2> boxes;
    std::vector<ClipperLib::Paths> paths;
    for (u32 f = 0; f < count; ++f) {
        boxes.push_back(boxOf(layout.footprints[f].outline.outer));
        paths.push_back(toPaths(layout.footprints[f].outline));
        grid.insert(boxes[f], f);
    }
    std::vector<std::vector<u32>> above(count); // per footprint, the higher ones that overlap it
    std::vector<double> overlap(count, 0.0);
    for (u32 f = 0; f < count; ++f) {
        for (const u32 other : grid.touching(boxes[f])) {
            if (other <= f) continue;
            const double common = areaOf(intersect(paths[f], paths[other]));
            if (common <= kOverlap) continue;
            const u32 lower = layout.footprints[f].height < layout.footprints[other].height ? f : other;
            above[lower].push_back(lower == f ? other : f);
            overlap[lower] += common;
        }
    }
    std::vector<std::string> ids;
    for (const Footprint& footprint : layout.footprints) ids.push_back(footprint.id);
    std::vector<Footprint> kept;
    for (u32 f = 0; f < count; ++f) {
        Footprint& footprint = layout.footprints[f];
        if (above[f].empty()) {
            kept.push_back(std::move(footprint));
            continue;
        }
        std::string names;
        ClipperLib::Paths higher;
        for (const u32 other : above[f]) {
            names += (names.empty() ? "" : ", ") + ids[other];
            higher.insert(higher.end(), paths[other].begin(), paths[other].end());
        }
        u32 pieces = 0;
        RepairReport report;
        for (const Polygon2& rest : subtractToPolygons(paths[f], higher)) {
            for (Polygon2& piece : cleanPolygon(rest, report)) {
                Footprint copy = footprint;
                copy.outline = std::move(piece);
                if (pieces > 0) copy.id = concat(footprint.id, ".", pieces + 1);
                kept.push_back(std::move(copy));
                ++pieces;
            }
        }
        layout.notes.push_back(concat("feature ", footprint.id, ": overlaps feature ", names, " by ",
                                      oneDecimal(overlap[f]), " m2, ",
                                      pieces == 0 ? "nothing remains, dropped" : "the common part is cut away"));
    }
    layout.footprints = std::move(kept);
}

} // namespace helio
