// SPDX-License-Identifier: Apache-2.0
#include "city/layout/geojson_features.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "city/base/json_depth.h"
#include "city/layout/json_text.h"

namespace helio {

namespace {

using nlohmann::json;

constexpr double kLargestHeight = 1000.0; // m; more is a unit mistake

std::string idText(const json& value)
{
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) return value.dump();
    return {};
}

std::string idOf(const json& feature, size_t number)
{
    std::string id;
    if (const json* own = findMember(feature, "id")) id = idText(*own);
    const json* properties = findMember(feature, "properties");
    if (const json* own = properties ? findMember(*properties, "id") : nullptr; own && id.empty()) id = idText(*own);
    return id.empty() ? concat("#", number) : id;
}

// A value for a message, at most 40 bytes of it.
std::string shortText(const json& value)
{
    if (value.is_array()) return "an array";
    if (value.is_object()) return "an object";
    return value.dump().substr(0, 40);
}

// A number, or a text that is a number with at most the unit m behind it ("12", "12 m", "12.5m").
std::optional<double> numberOf(const json& value)
{
    if (value.is_number()) return value.get<double>();
    if (!value.is_string()) return std::nullopt;
    const std::string text = value.get<std::string>();
    const char* end = text.data() + text.size();
    double number = 0.0;
    const auto [stop, failure] = std::from_chars(text.data(), end, number);
    if (failure != std::errc()) return std::nullopt;
    std::string_view unit(stop, size_t(end - stop));
    while (!unit.empty() && unit.front() == ' ') unit.remove_prefix(1);
    return unit.empty() || unit == "m" ? std::optional(number) : std::nullopt;
}

class Reader
{
public:
    explicit Reader(std::string_view name) : name_(name) {}

    Result<GeoFile> read(const json& root)
    {
        if (!root.is_object()) return fail("the file holds no JSON object; export the footprints as GeoJSON");
        readFrame(root);
        const std::string type = findText(root, "type");
        if (type == "FeatureCollection") {
            const json* features = findMember(root, "features");
            if (!features || !features->is_array()) return fail("FeatureCollection without an array \"features\"");
            for (size_t i = 0; i < features->size(); ++i) readFeature((*features)[i], i);
        } else if (type == "Feature") {
            readFeature(root, 0);
        } else if (findMember(root, "coordinates") || findMember(root, "geometries")) {
            GeoFeature feature;
            feature.id = "#0";
            readGeometry(root, feature);
        } else {
            return fail(concat("type \"", type.substr(0, 40), "\" is not GeoJSON; a FeatureCollection is expected"));
        }
        return std::move(file_);
    }

private:
    Error fail(const std::string& what) const { return Error{concat(name_, ": ", what)}; }
    void skip(const GeoFeature& feature, const std::string& why)
    {
        file_.notes.push_back(concat("feature ", feature.id, ": ", why, ", skipped"));
    }

    void readFrame(const json& root)
    {
        if (const json* crs = findMember(root, "crs"))
            if (const json* properties = findMember(*crs, "properties")) file_.crs = findText(*properties, "name");
        const json* metadata = findMember(root, "metadata");
        if (!metadata) return;
        if (const std::string crs = findText(*metadata, "crs"); !crs.empty()) file_.crs = crs;
        const std::string units = findText(*metadata, "units");
        file_.metric = units == "m" || units == "metre" || units == "meter" || units == "metres" || units == "meters";
        const json* origin = findMember(*metadata, "origin");
        if (!origin || !origin->is_array()) return;
        for (u32 i = 0; i < std::min<size_t>(3, origin->size()); ++i)
            if ((*origin)[i].is_number()) file_.origin[int(i)] = (*origin)[i].get<double>();
    }

    void readFeature(const json& value, size_t number)
    {
        GeoFeature feature;
        feature.id = idOf(value, number);
        const json* geometry = findMember(value, "geometry");
        if (!geometry || !geometry->is_object()) return skip(feature, "no geometry");
        if (const json* properties = findMember(value, "properties"); properties && properties->is_object())
            readProperties(*properties, feature);
        readGeometry(*geometry, feature);
    }

    std::optional<double> positive(const json& value, const char* key, double largest, const GeoFeature& feature)
    {
        if (value.is_null()) return std::nullopt;
        const std::optional<double> number = numberOf(value);
        const bool usable = number && *number > 0.0 && *number <= largest;
        const std::string outcome = usable ? concat("is read as ", *number) : "is not usable, ignored";
        if (!usable || value.is_string())
            file_.notes.push_back(concat("feature ", feature.id, ": ", key, " ", shortText(value), " ", outcome));
        return usable ? number : std::nullopt;
    }

    void readProperties(const json& properties, GeoFeature& feature)
    {
        for (const auto& [key, value] : properties.items()) {
            if (key == "height") {
                feature.height = positive(value, "height", kLargestHeight, feature);
                continue;
            }
            const bool isLevels = key == "levels" || (key == "building:levels" && !properties.contains("levels"));
            if (isLevels) feature.levels = positive(value, key.c_str(), kLargestHeight / 2.0, feature);
            if (value.is_number()) feature.attributes[key] = value.get<double>();
            if (value.is_boolean()) feature.attributes[key] = value.get<bool>();
            if (value.is_string()) feature.attributes[key] = value.get<std::string>();
        }
    }

    void readGeometry(const json& geometry, GeoFeature& feature)
    {
        std::string trouble;
        const size_t streets = file_.streets.size();
        collect(geometry, feature, trouble);
        if (!trouble.empty()) return skip(feature, trouble);
        if (!feature.polygons.empty() || file_.streets.size() == streets) file_.features.push_back(std::move(feature));
    }

    // Appends the polygons of a geometry, and its lines to the streets; sets `trouble` if it is not usable. Collections
    // nest no deeper than one level.
    void collect(const json& geometry, GeoFeature& feature, std::string& trouble, bool nested = false)
    {
        const std::string type = findText(geometry, "type");
        const json* list = findMember(geometry, type == "GeometryCollection" ? "geometries" : "coordinates");
        const bool isLine = type == "LineString" || type == "MultiLineString";
        const bool known =
            isLine || type == "Polygon" || type == "MultiPolygon" || (type == "GeometryCollection" && !nested);
        if (!known) {
            trouble = concat(type.empty() ? "geometry without a type" : type.substr(0, 40), " is no footprint");
        } else if (!list || !list->is_array() || list->empty()) {
            trouble = concat(type, " without coordinates");
        } else if (type == "Polygon") {
            readPolygon(*list, feature, trouble);
        } else if (type == "LineString") {
            readLine(*list, trouble);
        } else {
            for (const json& part : *list) {
                if (type == "MultiPolygon")
                    readPolygon(part, feature, trouble);
                else if (isLine)
                    readLine(part, trouble);
                else
                    collect(part, feature, trouble, true);
            }
        }
    }

    // The points of a ring or line; false, with the trouble, if they are no pairs of numbers.
    static bool readPoints(const json& list, const std::string& what, Ring2& points, std::string& trouble)
    {
        if (!list.is_array()) {
            trouble = what + " is not an array of corners";
            return false;
        }
        for (size_t i = 0; i < list.size(); ++i) {
            const json& corner = list[i];
            if (!corner.is_array() || corner.size() < 2 || !corner[0].is_number() || !corner[1].is_number()) {
                trouble = concat(what, ", corner ", i, " is not a pair of numbers");
                return false;
            }
            points.emplace_back(corner[0].get<double>(), corner[1].get<double>());
        }
        return true;
    }

    void readLine(const json& list, std::string& trouble)
    {
        Ring2 line;
        if (readPoints(list, "line", line, trouble) && line.size() >= 2) file_.streets.push_back(std::move(line));
    }

    void readPolygon(const json& rings, GeoFeature& feature, std::string& trouble)
    {
        if (!rings.is_array() || rings.empty()) {
            trouble = "polygon without rings";
            return;
        }
        Polygon2 polygon;
        for (size_t r = 0; r < rings.size(); ++r) {
            Ring2 ring;
            if (!readPoints(rings[r], concat("ring ", r), ring, trouble)) return;
            if (ring.size() > 1 && ring.front() == ring.back())
                ring.pop_back();
            else
                ++feature.openRings;
            if (r == 0)
                polygon.outer = std::move(ring);
            else
                polygon.holes.push_back(std::move(ring));
        }
        feature.polygons.push_back(std::move(polygon));
    }

    std::string_view name_;
    GeoFile file_;
};

} // namespace

Result<GeoFile> readGeoFeatures(std::string_view text, std::string_view name)
{
    const auto failAt = [&](size_t byte, const std::string& what) {
        const auto line = 1 + std::count(text.begin(), text.begin() + long(byte), '\n');
        return Error{concat(name, ":", line, ": byte ", byte, ": ", what, "; export the footprints as GeoJSON")};
    };
    if (const std::optional<size_t> deep = findDeepJson(text))
        return failAt(*deep, concat("nests deeper than ", kMaxJsonDepth, " levels"));
    try {
        return Reader(name).read(json::parse(text));
    } catch (const json::parse_error& failure) {
        return failAt(std::min(failure.byte, text.size()), concat("not JSON (", jsonReason(failure), ")"));
    } catch (const json::exception& failure) {
        return Error{concat(name, ": ", jsonReason(failure), "; export the footprints as GeoJSON")};
    }
}

} // namespace helio
