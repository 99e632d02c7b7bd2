// SPDX-License-Identifier: Apache-2.0
#include "city/layout/import.h"

#include "city/base/file.h"
#include "city/layout/census.h"
#include "city/layout/cityjson.h"
#include "city/layout/fronts.h"
#include "city/layout/geojson_features.h"
#include "city/layout/heights.h"
#include "city/layout/import_notes.h"
#include "city/layout/overlaps.h"
#include "city/layout/placement.h"
#include "city/layout/polygon_repair.h"
#include "city/layout/shared_walls.h"
#include "city/layout/streets.h"

namespace helio {

namespace {

constexpr size_t kLargestFile = size_t(1) << 29; // bytes: read at once, and several times that as a tree

Result<std::string> readInput(const std::filesystem::path& path)
{
    std::error_code failure;
    const auto size = std::filesystem::file_size(path, failure);
    if (!failure && size > kLargestFile)
        return Error{concat(path.string(), ": larger than 512 MiB; cut the city into several files")};
    return readTextFile(path);
}

// Appends the lines of another file, in the coordinates of the city's own.
Status addStreets(GeoFile& city, const std::filesystem::path& path, std::string_view name)
{
    const Result<std::string> text = readInput(path);
    if (!text) return text.error();
    Result<GeoFile> streets = readGeoFeatures(*text, path.string());
    if (!streets) return streets.error();
    if (streets->streets.empty()) return Error{concat(path.string(), ": no streets; it holds no LineString")};
    if (!streets->crs.empty() && !city.crs.empty() && !isSameCrs(streets->crs, city.crs))
        return Error{concat(path.string(), ": streets in ", streets->crs, ", but the footprints of ", name, " in ",
                            city.crs, "; give both in one CRS")};
    const glm::dvec2 shift(streets->origin - city.origin);
    for (Ring2& line : streets->streets) {
        for (glm::dvec2& point : line) point += shift;
        city.streets.push_back(std::move(line));
    }
    return Nothing{};
}

// What was done to all features, of the kinds that are too ordinary for a note each.
struct Ordinary
{
    u32 reversedRings = 0, straightCorners = 0;
};

// Repairs a feature and makes one footprint of each piece. Height 0 marks a height that is not known.
std::vector<Footprint> makeFootprints(GeoFeature& feature, const ImportOptions& options, ImportNotes& notes,
                                      Ordinary& total)
{
    RepairReport report;
    std::vector<Polygon2> pieces;
    for (Polygon2& polygon : feature.polygons)
        for (Polygon2& piece : cleanPolygon(std::move(polygon), report)) pieces.push_back(std::move(piece));
    std::vector<ImportNotes::Item> items;
    if (feature.openRings) items.emplace_back("repaired.closed", concat("closed ", feature.openRings, " open ring(s)"));
    for (ImportNotes::Item& item : repairItems(report)) items.push_back(std::move(item));
    if (pieces.empty()) {
        const bool isSmall = report.smallPieces > 0;
        items.emplace_back(isSmall ? "skipped.too_small" : "skipped.no_area", isSmall ? "skipped" : "no area, skipped");
    }
    notes.feature(feature.id, items);
    if (report.reversedRings) notes.count("repaired.oriented");
    if (report.straightCorners) notes.count("repaired.straight_corners");
    total.reversedRings += report.reversedRings;
    total.straightCorners += report.straightCorners;

    Footprint whole;
    whole.id = feature.id;
    whole.attributes = std::move(feature.attributes);
    whole.faces = std::move(feature.faces);
    if (feature.height)
        whole.height = *feature.height;
    else if (feature.levels)
        whole.height = *feature.levels * options.storeyHeight + 1.0;
    std::vector<Footprint> footprints = splitFootprint(whole, std::move(pieces), notes);
    if (!footprints.empty() && whole.height > 0.0)
        notes.count(feature.height ? "height.given" : "height.levels", u32(footprints.size()));
    return footprints;
}

void noteReading(const GeoFile& file, ImportNotes& notes)
{
    for (const std::string& note : file.notes)
        notes.line(note.ends_with("skipped") ? "skipped.unreadable" : "noted.while_reading", note);
}

// The repairs of a city, from single outlines to what stands between them.
void repair(Layout& layout, std::vector<GeoFeature>& features, const ImportOptions& options, ImportNotes& notes)
{
    Ordinary total;
    std::vector<Footprint>& footprints = layout.footprints;
    std::vector<bool> isPart; // per footprint
    for (GeoFeature& feature : features) {
        const bool own = feature.isPart || saysPart(feature.attributes);
        for (Footprint& footprint : makeFootprints(feature, options, notes, total)) {
            footprints.push_back(std::move(footprint));
            isPart.push_back(own);
        }
    }
    if (total.reversedRings + total.straightCorners > 0)
        notes.summary(concat("rings: ", total.reversedRings, " reversed, ", total.straightCorners,
                             " corners on straight lines dropped"));
    replaceOutlinesByParts(footprints, isPart, notes);
    dropEqualFootprints(footprints, notes);
    fillMissingHeights(footprints, options, notes);
    const auto count = [&](const char* kind) {
        const auto place = notes.counts().find(kind);
        return place == notes.counts().end() ? 0u : place->second;
    };
    notes.summary(concat("heights: ", count("height.given"), " given, ", count("height.levels"), " from levels, ",
                         count("height.neighbours"), " the median of neighbours, ", count("height.default"),
                         " the default of ", options.defaultHeight, " m"));
    cutOverlaps(footprints, notes);
    makeIdsUnique(footprints, notes);
}

Result<GeoFile> readCity(std::string_view text, std::string_view name, const ImportOptions& options)
{
    if (isCityJson(text)) return readCityJson(text, name, options.lod2);
    return readGeoFeatures(text, name);
}

} // namespace

Result<Layout> parseCity(std::string_view text, std::string_view name, const ImportOptions& options)
{
    Result<GeoFile> file = readCity(text, name, options);
    if (!file) return file.error();
    if (!options.streets.empty())
        if (Status status = addStreets(*file, options.streets, name); !status) return status.error();
    ImportNotes notes;
    noteReading(*file, notes);
    Result<PlacedCity> city = placeCity(std::move(*file), name, options, notes);
    if (!city) return city.error();
    Layout layout;
    layout.origin = city->origin;
    layout.crs = std::move(city->crs);
    layout.streets = std::move(city->streets);
    if (city->place) {
        layout.latitudeDeg = city->place->latitudeDeg;
        layout.longitudeDeg = city->place->longitudeDeg;
    }
    layout.counts = censusOf(city->features);
    repair(layout, city->features, options, notes);
    for (const auto& [kind, number] : notes.counts()) layout.counts[kind] = number;
    layout.notes = notes.take();
    if (layout.footprints.empty())
        return Error{concat(name, ": no footprint to use", layout.notes.empty() ? "" : " (" + layout.notes[0] + ")")};
    findSharedWalls(layout);
    markStreets(layout);
    if (!options.keepFirstEdge) chooseFronts(layout);
    return layout;
}

Result<Layout> importCity(const std::filesystem::path& path, const ImportOptions& options)
{
    const Result<std::string> text = readInput(path);
    if (!text) return text.error();
    return parseCity(*text, path.string(), options);
}

} // namespace helio
