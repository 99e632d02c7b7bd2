// SPDX-License-Identifier: Apache-2.0
#include "city/layout/placement.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <iomanip>
#include <sstream>

#include "city/geometry/clip.h"
#include "city/layout/validity.h"

namespace helio {

namespace {

constexpr double kLargestCoordinate = 1e7; // m
constexpr double kDegreeExtent = 0.05;     // no building is that small in metres or that large in degrees
constexpr double kStreetMargin = 100.0;    // m
constexpr size_t kMaxCorners = 20000;      // the largest of real buildings have a few thousand
constexpr u32 kMaxMeetings = 10000;        // of edges: uniting makes a corner of each

template <class Feature, class Visit> void forEachCorner(Feature& feature, Visit&& visit)
{
    for (auto& polygon : feature.polygons) {
        for (auto& corner : polygon.outer) visit(corner);
        for (auto& hole : polygon.holes)
            for (auto& corner : hole) visit(corner);
    }
}

Box2 boxAround(const GeoFeature& feature)
{
    Ring2 corners;
    forEachCorner(feature, [&](const glm::dvec2& corner) { corners.push_back(corner); });
    return boxOf(corners);
}

Box2 boxAround(std::span<const GeoFeature> features)
{
    Box2 box = boxAround(features[0]);
    for (const GeoFeature& feature : features) {
        const Box2 own = boxAround(feature);
        box = {glm::min(box.low, own.low), glm::max(box.high, own.high)};
    }
    return box;
}

// Whether every polygon has corners, all finite.
bool isWhole(const GeoFeature& feature)
{
    bool isFinite = !feature.polygons.empty();
    for (const Polygon2& polygon : feature.polygons) isFinite = isFinite && !polygon.outer.empty();
    forEachCorner(feature,
                  [&](const glm::dvec2& p) { isFinite = isFinite && std::isfinite(p.x) && std::isfinite(p.y); });
    return isFinite;
}

bool isOnGlobe(const Box2& box)
{
    return box.low.x >= -180.0 && box.high.x <= 180.0 && box.low.y >= -90.0 && box.high.y <= 90.0;
}

bool looksLikeDegrees(const Box2& box)
{
    const glm::dvec2 extent = box.high - box.low;
    const double size = std::max(extent.x, extent.y);
    return size > 0.0 && size < kDegreeExtent && isOnGlobe(box);
}

// Area centroid, whatever the direction of the rings; the middle of the box where there is no area.
glm::dvec2 centroidOf(const GeoFeature& feature)
{
    const glm::dvec2 base = feature.polygons[0].outer[0];
    glm::dvec2 moment(0.0);
    double sum = 0.0;
    const auto add = [&](const Ring2& ring, double sign) {
        sign *= signedArea(ring) < 0.0 ? -1.0 : 1.0;
        for (size_t i = 0; i < ring.size(); ++i) {
            const glm::dvec2 a = ring[i] - base, b = ring[(i + 1) % ring.size()] - base;
            moment += sign * cross(a, b) / 6.0 * (a + b);
            sum += sign * cross(a, b) / 2.0;
        }
    };
    for (const Polygon2& polygon : feature.polygons) {
        add(polygon.outer, 1.0);
        for (const Ring2& hole : polygon.holes) add(hole, -1.0);
    }
    const Box2 box = boxAround(feature);
    const glm::dvec2 found = base + moment / sum;
    const bool isUsable = sum > 0.0 && Box2{found, found}.touches(box);
    return isUsable ? found : 0.5 * (box.low + box.high);
}

double medianOf(std::vector<double> values)
{
    const auto middle = values.begin() + long(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

glm::dvec2 medianCentre(std::span<const GeoFeature> features)
{
    std::vector<double> x, y;
    for (const GeoFeature& feature : features) {
        const Box2 box = boxAround(feature);
        x.push_back(0.5 * (box.low.x + box.high.x));
        y.push_back(0.5 * (box.low.y + box.high.y));
    }
    return {medianOf(std::move(x)), medianOf(std::move(y))};
}

std::string crsOf(const GeoPoint& centre)
{
    std::ostringstream out;
    out << std::fixed << std::setprecision(9) << "+proj=tmerc +lat_0=" << centre.latitudeDeg
        << " +lon_0=" << centre.longitudeDeg << " +k=1 +datum=WGS84 +units=m";
    return out.str();
}

class Sieve
{
public:
    Sieve(ImportNotes& notes, bool degrees) : notes_(notes), degrees_(degrees) {}

    void dropBad(std::vector<GeoFeature>& features)
    {
        std::erase_if(features, [&](const GeoFeature& feature) { return isBad(feature); });
    }
    void select(std::vector<GeoFeature>& features, const ImportOptions& options) const
    {
        if (options.bbox)
            std::erase_if(features, [&](const GeoFeature& feature) {
                const glm::dvec2 middle = centroidOf(feature);
                return !options.bbox->touches({middle, middle});
            });
        if (options.limit && features.size() > *options.limit) features.resize(*options.limit);
    }
    /// `inMetres` maps corners to metres from the middle of the city.
    template <class Map> void dropFar(std::vector<GeoFeature>& features, Map&& inMetres)
    {
        std::erase_if(features, [&](const GeoFeature& feature) {
            double distance = 0.0;
            forEachCorner(feature, [&](const glm::dvec2& corner) {
                const glm::dvec2 from = glm::abs(inMetres(corner));
                distance = std::max({distance, from.x, from.y});
            });
            // Half of the grid's range, so that the city fits whatever its middle is.
            if (distance <= 0.5 * kGridLimit) return false;
            return skip(feature, "skipped.far",
                        concat("lies ", std::llround(distance / 1000.0), " km from the other footprints"));
        });
    }
    const std::string& firstReason() const { return firstReason_; }

private:
    bool skip(const GeoFeature& feature, const std::string& kind, const std::string& why)
    {
        if (firstReason_.empty()) firstReason_ = concat("feature ", feature.id, ": ", why);
        notes_.feature(feature.id, {{kind, why + ", skipped"}});
        return true;
    }
    bool isBad(const GeoFeature& feature)
    {
        if (!isWhole(feature)) return skip(feature, "skipped.no_area", "ring without corners");
        const Box2 box = boxAround(feature);
        const glm::dvec2 largest = glm::max(glm::abs(box.low), glm::abs(box.high));
        if (std::max(largest.x, largest.y) > kLargestCoordinate)
            return skip(feature, "skipped.coordinates", "coordinate beyond 1e7 m");
        if (degrees_ && !isOnGlobe(box))
            return skip(feature, "skipped.coordinates", "longitude beyond 180 or latitude beyond 90 degrees");
        if (!degrees_ && looksLikeDegrees(box))
            return skip(feature, "skipped.degrees",
                        "coordinates look like longitude and latitude, metres are needed as in the rest of the file");
        size_t corners = 0;
        forEachCorner(feature, [&](const glm::dvec2&) { ++corners; });
        bool isTooComplex = corners > kMaxCorners;
        for (const Polygon2& polygon : feature.polygons)
            isTooComplex = isTooComplex || polygonFindings(polygon, kMaxMeetings).meetings > kMaxMeetings;
        return isTooComplex &&
               skip(feature, "skipped.too_complex", "over 20,000 corners, or edges that meet in over 10,000 places");
    }

    ImportNotes& notes_;
    bool degrees_;
    std::string firstReason_;
};

double turnedTowards(double longitude, double middle)
{
    return middle + std::remainder(longitude - middle, 360.0);
}

// On the antimeridian neighbours may be 360 degrees apart: turns every feature as a whole to within 180 degrees of the
// median one. Longitudes may then exceed 180.
void joinAcrossAntimeridian(std::vector<GeoFeature>& features)
{
    const auto turn = [](GeoFeature& feature, double middle) {
        forEachCorner(feature, [&](glm::dvec2& corner) {
            if (std::abs(corner.x - middle) > 180.0) corner.x = turnedTowards(corner.x, middle);
        });
    };
    // One that stands on the line itself would have its middle on the far side of the globe.
    for (GeoFeature& feature : features) turn(feature, feature.polygons[0].outer[0].x);
    const double middle = medianCentre(features).x;
    for (GeoFeature& feature : features) turn(feature, middle);
}

void project(GeoFeature& feature, const TransverseMercator& projection)
{
    forEachCorner(feature, [&](glm::dvec2& corner) { corner = projection.forward({corner.y, corner.x}); });
}

void shift(GeoFeature& feature, const glm::dvec2& offset)
{
    forEachCorner(feature, [&](glm::dvec2& corner) { corner -= offset; });
    const auto move = [&](Ring3& ring) {
        for (glm::dvec3& corner : ring) corner -= glm::dvec3(offset, 0.0);
    };
    for (GivenFace& face : feature.faces) {
        move(face.polygon.outer);
        for (Ring3& hole : face.polygon.holes) move(hole);
    }
}

// Returns how many lines are gone.
size_t dropFarStreets(PlacedCity& city)
{
    const Box2 around = boxAround(city.features).grown(kStreetMargin);
    return std::erase_if(city.streets, [&](const Ring2& line) {
        const bool isFinite = std::all_of(line.begin(), line.end(),
                                          [](const glm::dvec2& p) { return std::isfinite(p.x) && std::isfinite(p.y); });
        return !isFinite || !boxOf(line).touches(around);
    });
}

} // namespace

bool isInDegrees(const GeoFile& file)
{
    if (isGeographicCrs(file.crs)) return true;
    if (!file.crs.empty() || file.metric) return false;
    size_t small = 0, whole = 0;
    for (const GeoFeature& feature : file.features) {
        if (!isWhole(feature)) continue;
        ++whole;
        small += looksLikeDegrees(boxAround(feature));
    }
    return 2 * small > whole;
}

Result<PlacedCity> placeCity(GeoFile file, std::string_view name, const ImportOptions& options, ImportNotes& notes)
{
    const bool degrees = isInDegrees(file);
    PlacedCity city;
    city.crs = file.crs;
    city.features = std::move(file.features);
    city.streets = std::move(file.streets);
    const size_t read = city.features.size();
    Sieve sieve(notes, degrees);
    sieve.dropBad(city.features);
    const size_t usable = city.features.size();
    sieve.select(city.features, options);
    if (city.features.empty()) {
        if (usable > 0) return Error{concat(name, ": no footprint in the bounding box or below the limit")};
        std::string reason = read > 0 ? sieve.firstReason() : file.notes.empty() ? std::string() : file.notes[0];
        if (reason.empty()) return Error{concat(name, ": no footprint to use; it holds no Polygon")};
        return Error{concat(name, ": no footprint to use (", reason, ")")};
    }
    if (degrees) joinAcrossAntimeridian(city.features);
    const glm::dvec2 median = medianCentre(city.features);
    if (degrees) {
        const TransverseMercator rough({median.y, median.x});
        sieve.dropFar(city.features, [&](const glm::dvec2& corner) { return rough.forward({corner.y, corner.x}); });
    } else {
        sieve.dropFar(city.features, [&](const glm::dvec2& corner) { return corner - median; });
    }
    if (city.features.empty()) return Error{concat(name, ": no footprint to use (", sieve.firstReason(), ")")};
    const Box2 box = boxAround(city.features);
    glm::dvec2 offset = 0.5 * (box.low + box.high);
    if (degrees) {
        city.place = GeoPoint{offset.y, std::abs(offset.x) > 180.0 ? turnedTowards(offset.x, 0.0) : offset.x};
        const TransverseMercator projection(*city.place);
        for (GeoFeature& feature : city.features) project(feature, projection);
        // Around a pole the middle of longitudes may lie aside of the city.
        sieve.dropFar(city.features, [](const glm::dvec2& corner) { return corner; });
        if (city.features.empty()) return Error{concat(name, ": no footprint to use (", sieve.firstReason(), ")")};
        for (Ring2& line : city.streets)
            for (glm::dvec2& point : line) point = projection.forward({point.y, point.x});
        city.crs = crsOf(*city.place);
    } else {
        offset = glm::round(offset);
        for (GeoFeature& feature : city.features) shift(feature, offset);
        for (Ring2& line : city.streets)
            for (glm::dvec2& point : line) point -= offset;
        city.origin = file.origin + glm::dvec3(offset, 0.0);
        city.place = placeOfUtm(city.crs, city.origin);
    }
    const size_t lines = city.streets.size(), far = dropFarStreets(city);
    if (lines > 0 && far == lines && !options.streets.empty())
        return Error{concat(options.streets.string(), ": none of its ", lines,
                            " lines comes within 100 m of the footprints of ", name,
                            "; give the streets of this city, in its coordinates")};
    if (far > 0) {
        notes.count("skipped.far_streets", u32(far));
        notes.summary(concat("streets: ", far, " of ", lines, " lines lie over 100 m from the footprints, left out"));
    }
    return city;
}

} // namespace helio
