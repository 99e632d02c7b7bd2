// SPDX-License-Identifier: Apache-2.0
#include "city/layout/geojson.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "city/base/file.h"
#include "city/layout/box_grid.h"
#include "city/geometry/clip.h"
#include "city/layout/geojson_features.h"
#include "city/layout/overlaps.h"
#include "city/layout/polygon_repair.h"
#include "city/layout/shared_walls.h"

namespace helio {

namespace {

constexpr double kLargestCoordinate = 1e7; // m
constexpr double kDegreeExtent = 0.05;     // no building is that small in metres or that large in degrees

bool isFinite(const Box2& box)
{
    return std::isfinite(box.low.x + box.low.y + box.high.x + box.high.y);
}

Box2 boxAround(const GeoFeature& feature)
{
    Ring2 corners;
    for (const Polygon2& polygon : feature.polygons) {
        corners.insert(corners.end(), polygon.outer.begin(), polygon.outer.end());
        for (const Ring2& hole : polygon.holes) corners.insert(corners.end(), hole.begin(), hole.end());
    }
    return boxOf(corners);
}

bool looksLikeDegrees(const Box2& box)
{
    const glm::dvec2 extent = box.high - box.low;
    return std::max(extent.x, extent.y) < kDegreeExtent && box.low.x >= -180.0 && box.high.x <= 180.0 &&
           box.low.y >= -90.0 && box.high.y <= 90.0;
}

double medianOf(std::vector<double> values)
{
    const auto middle = values.begin() + long(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Leaves out features that cannot be of this city, with a note each.
class Sieve
{
public:
    explicit Sieve(std::vector<std::string>& notes) : notes_(notes) {}

    std::vector<GeoFeature> run(std::vector<GeoFeature> features)
    {
        std::erase_if(features, [&](const GeoFeature& feature) { return hasBadCoordinates(feature); });
        if (features.empty()) return features;
        std::vector<double> x, y;
        for (const GeoFeature& feature : features) {
            const Box2 box = boxAround(feature);
            x.push_back(0.5 * (box.low.x + box.high.x));
            y.push_back(0.5 * (box.low.y + box.high.y));
        }
        const glm::dvec2 middle(medianOf(x), medianOf(y));
        std::erase_if(features, [&](const GeoFeature& feature) { return isFarAway(feature, middle); });
        return features;
    }
    u32 degreeCount() const { return degreeCount_; }

private:
    bool skip(const GeoFeature& feature, const std::string& why)
    {
        notes_.push_back(concat("feature ", feature.id, ": ", why, ", skipped"));
        return true;
    }
    bool hasBadCoordinates(const GeoFeature& feature)
    {
        for (const Polygon2& polygon : feature.polygons)
            if (polygon.outer.empty()) return skip(feature, "ring without corners");
        const Box2 box = boxAround(feature);
        const glm::dvec2 largest = glm::max(glm::abs(box.low), glm::abs(box.high));
        if (!isFinite(box) || std::max(largest.x, largest.y) > kLargestCoordinate)
            return skip(feature, "coordinate beyond 1e7 m");
        if (!looksLikeDegrees(box)) return false;
        ++degreeCount_;
        return skip(feature, "coordinates look like longitude and latitude, metres are needed");
    }
    // Half of the grid's range, so that the city fits whatever its middle is.
    bool isFarAway(const GeoFeature& feature, const glm::dvec2& middle)
    {
        const Box2 box = boxAround(feature);
        const glm::dvec2 far = glm::max(glm::abs(box.low - middle), glm::abs(box.high - middle));
        const double distance = std::max(far.x, far.y);
        if (distance <= 0.5 * kGridLimit) return false;
        return skip(feature, concat("lies ", std::llround(distance / 1000.0), " km from the other footprints"));
    }

    std::vector<std::string>& notes_;
    u32 degreeCount_ = 0;
};

// Subtracts the origin, repairs, and makes one footprint of each piece. Height 0 marks a height that is not known.
void addFootprints(Layout& layout, GeoFeature& feature, const glm::dvec2& offset, const ImportOptions& options,
                   RepairReport& total)
{
    RepairReport report;
    std::vector<Polygon2> pieces;
    for (Polygon2& polygon : feature.polygons) {
        for (glm::dvec2& corner : polygon.outer) corner -= offset;
        for (Ring2& hole : polygon.holes)
            for (glm::dvec2& corner : hole) corner -= offset;
        for (Polygon2& piece : cleanPolygon(std::move(polygon), report)) pieces.push_back(std::move(piece));
    }
    total.reversedRings += report.reversedRings;
    total.straightCorners += report.straightCorners;
    std::string text = describeRepairs(report);
    if (feature.openRings) text = concat("closed ", feature.openRings, " open ring(s)", text.empty() ? "" : ", ", text);
    if (pieces.empty()) {
        if (report.smallPieces == 0) text += text.empty() ? "no area" : ", no area remains";
        layout.notes.push_back(concat("feature ", feature.id, ": ", text, ", skipped"));
        return;
    }
    if (!text.empty()) layout.notes.push_back(concat("feature ", feature.id, ": ", text));
    for (size_t i = 0; i < pieces.size(); ++i) {
        Footprint footprint;
        footprint.id = i == 0 ? feature.id : concat(feature.id, ".", i + 1);
        footprint.outline = std::move(pieces[i]);
        footprint.attributes = feature.attributes;
        if (feature.height)
            footprint.height = *feature.height;
        else if (feature.levels)
            footprint.height = *feature.levels * options.storeyHeight + 1.0;
        layout.footprints.push_back(std::move(footprint));
    }
}

void fillMissingHeights(Layout& layout, const ImportOptions& options, u32 fromHeight, u32 fromLevels)
{
    BoxGrid grid(std::max(options.neighbourRadius, 10.0));
    std::vector<glm::dvec2> centres;
    for (u32 f = 0; f < layout.footprints.size(); ++f) {
        const Box2 box = boxOf(layout.footprints[f].outline.outer);
        centres.push_back(0.5 * (box.low + box.high));
        if (layout.footprints[f].height > 0.0) grid.insert({centres[f], centres[f]}, f);
    }
    std::vector<double> heights;
    u32 fromNeighbours = 0, fromOption = 0;
    for (u32 f = 0; f < layout.footprints.size(); ++f) {
        heights.push_back(layout.footprints[f].height);
        if (heights[f] > 0.0) continue;
        std::vector<double> near;
        for (const u32 other : grid.touching(Box2{centres[f], centres[f]}.grown(options.neighbourRadius)))
            if (glm::distance(centres[other], centres[f]) <= options.neighbourRadius)
                near.push_back(layout.footprints[other].height);
        const bool known = !near.empty() && options.neighbourRadius > 0.0;
        ++(known ? fromNeighbours : fromOption);
        heights[f] = known ? medianOf(near) : options.defaultHeight;
    }
    for (u32 f = 0; f < layout.footprints.size(); ++f) layout.footprints[f].height = heights[f];
    layout.notes.push_back(concat("heights: ", fromHeight, " given, ", fromLevels, " from levels, ", fromNeighbours,
                                  " the median of neighbours, ", fromOption, " the default of ", options.defaultHeight,
                                  " m"));
}

} // namespace

Result<Layout> parseGeoJson(std::string_view text, std::string_view name, const ImportOptions& options)
{
    Result<GeoFile> file = readGeoFeatures(text, name);
    if (!file) return file.error();
    Layout layout;
    layout.crs = file->crs;
    layout.notes = std::move(file->notes);
    Sieve sieve(layout.notes);
    std::vector<GeoFeature> features = sieve.run(std::move(file->features));
    if (features.empty()) {
        if (sieve.degreeCount() > 0)
            return Error{
                concat(name, ": coordinates are longitude and latitude; reproject to a metric CRS (UTM, say)")};
        return Error{
            concat(name, ": no footprint to use",
                   layout.notes.empty() ? std::string("; it holds no Polygon") : " (" + layout.notes[0] + ")")};
    }
    Box2 box = boxAround(features[0]);
    for (const GeoFeature& feature : features) {
        const Box2 own = boxAround(feature);
        box = {glm::min(box.low, own.low), glm::max(box.high, own.high)};
    }
    const glm::dvec2 offset = glm::round(0.5 * (box.low + box.high));
    layout.origin = file->origin + glm::dvec3(offset, 0.0);
    RepairReport total;
    u32 fromHeight = 0, fromLevels = 0;
    for (GeoFeature& feature : features) {
        const size_t before = layout.footprints.size();
        addFootprints(layout, feature, offset, options, total);
        const u32 added = u32(layout.footprints.size() - before);
        if (feature.height)
            fromHeight += added;
        else if (feature.levels)
            fromLevels += added;
    }
    if (layout.footprints.empty()) return Error{concat(name, ": no footprint to use (", layout.notes[0], ")")};
    if (total.reversedRings + total.straightCorners > 0)
        layout.notes.push_back(concat("rings: ", total.reversedRings, " reversed, ", total.straightCorners,
                                      " corners on straight lines dropped"));
    fillMissingHeights(layout, options, fromHeight, fromLevels);
    dropEqualFootprints(layout);
    cutOverlaps(layout);
    if (layout.footprints.empty()) return Error{concat(name, ": no footprint to use (", layout.notes.back(), ")")};
    findSharedWalls(layout);
    chooseFronts(layout);
    return layout;
}

Result<Layout> importGeoJson(const std::filesystem::path& path, const ImportOptions& options)
{
    const Result<std::string> text = readTextFile(path);
    if (!text) return text.error();
    return parseGeoJson(*text, path.string(), options);
}

} // namespace helio
