// SPDX-License-Identifier: Apache-2.0
// Any text as a city must give an error or a layout that keeps the promises of importCity.
#include <cmath>

#include "city/base/hash.h"
#include "city/layout/ground.h"
#include "city/layout/import.h"
#include "city/layout/polygon_repair.h"
#include "tests/fuzz/text_target.h"

namespace helio::fuzz {

namespace {

constexpr std::string_view kWords[] = {"type",
                                       "FeatureCollection",
                                       "Feature",
                                       "features",
                                       "geometry",
                                       "properties",
                                       "coordinates",
                                       "Polygon",
                                       "MultiPolygon",
                                       "LineString",
                                       "MultiLineString",
                                       "Point",
                                       "GeometryCollection",
                                       "geometries",
                                       "id",
                                       "height",
                                       "levels",
                                       "metadata",
                                       "origin",
                                       "crs",
                                       "name",
                                       "EPSG:4326",
                                       "urn:ogc:def:crs:OGC:1.3:CRS84",
                                       "EPSG:32632",
                                       "part",
                                       "parts",
                                       "building:part",
                                       "min_height",
                                       "CityJSON",
                                       "CityJSONFeature",
                                       "CityObjects",
                                       "vertices",
                                       "transform",
                                       "scale",
                                       "translate",
                                       "version",
                                       "1.0",
                                       "1.1",
                                       "2.0",
                                       "Building",
                                       "BuildingPart",
                                       "parents",
                                       "children",
                                       "attributes",
                                       "measuredHeight",
                                       "storeysAboveGround",
                                       "lod",
                                       "boundaries",
                                       "semantics",
                                       "surfaces",
                                       "values",
                                       "Solid",
                                       "MultiSolid",
                                       "CompositeSolid",
                                       "MultiSurface",
                                       "CompositeSurface",
                                       "GeometryInstance",
                                       "GroundSurface",
                                       "WallSurface",
                                       "RoofSurface",
                                       "referenceSystem",
                                       "null",
                                       "true",
                                       "[]",
                                       "{}",
                                       "\"\"",
                                       "[[]]",
                                       "[[[]]]",
                                       "-1",
                                       "1e308",
                                       "NaN"};

bool isFinite(const glm::dvec3& v)
{
    return std::isfinite(v.x + v.y + v.z);
}

void check(const Layout& layout)
{
    HELIO_CHECK(!layout.footprints.empty(), layout.notes.size());
    HELIO_CHECK(isFinite(layout.origin), layout.origin.x, " ", layout.origin.y);
    for (const Footprint& footprint : layout.footprints) {
        const Polygon2& outline = footprint.outline;
        HELIO_CHECK(std::isfinite(footprint.height) && footprint.height > 0.0, footprint.id, " ", footprint.height);
        HELIO_CHECK(isSimple(outline), footprint.id);
        HELIO_CHECK(signedArea(outline.outer) > 0.0 && area(outline) >= 0.99, footprint.id, " ", area(outline));
        size_t edges = outline.outer.size();
        for (const Ring2& hole : outline.holes) {
            HELIO_CHECK(signedArea(hole) < 0.0, footprint.id);
            edges += hole.size();
        }
        HELIO_CHECK(footprint.covered.size() == edges, footprint.id, " ", footprint.covered.size(), " ", edges);
        for (const std::vector<CoveredSpan>& spans : footprint.covered)
            for (const CoveredSpan& span : spans)
                HELIO_CHECK(std::isfinite(span.begin + span.end + span.height), footprint.id);
        for (const GivenFace& face : footprint.faces) {
            for (const glm::dvec3& corner : face.polygon.outer) HELIO_CHECK(isFinite(corner), footprint.id);
            HELIO_CHECK(area(face.polygon) > 0.0, footprint.id);
        }
    }
    for (const Ring2& street : layout.streets)
        for (const glm::dvec2& corner : street) HELIO_CHECK(std::isfinite(corner.x + corner.y), street.size());
    for (const std::string& note : layout.notes) HELIO_CHECK(!note.empty(), layout.notes.size());
}

} // namespace

const TextTarget textTarget = {"import", kWords};
u64 acceptedTexts = 0, refusedTexts = 0;

} // namespace helio::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size)
{
    using namespace helio;
    using namespace helio::fuzz;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    ImportOptions options;
    options.lod2 = hashText(text) % 4 != 0;
    Result<Layout> layout = parseCity(text, "fuzz.json", options);
    if (!layout) {
        HELIO_CHECK(layout.error().message.starts_with("fuzz.json"), layout.error().message);
        ++refusedTexts;
        return 0;
    }
    ++acceptedTexts;
    check(*layout);
    GroundOptions ground;
    ground.maxCells = 400;
    addGround(*layout, ground);
    for (const GroundArea& area : layout->ground)
        for (const glm::dvec3& corner : area.polygon.outer) HELIO_CHECK(isFinite(corner), area.kind);
    return 0;
}
