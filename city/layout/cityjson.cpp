// SPDX-License-Identifier: Apache-2.0
#include "city/layout/cityjson.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <set>

#include "city/layout/cityjson_building.h"
#include "city/layout/cityjson_objects.h"
#include "city/layout/json_text.h"
#include "city/layout/obj_faces.h"

namespace helio {

namespace {

using nlohmann::json;

constexpr double kLargestCoordinate = 1e7; // m
constexpr double kFlat = 0.5;              // m: geometry below has no height of its own
constexpr const char* kAdvice = "export the city as CityJSON";

class Reader
{
public:
    Reader(std::string_view name, bool lod2) : name_(name), lod2_(lod2) {}

    Status readHeader(const json& root)
    {
        const std::string type = findText(root, "type");
        if (type != "CityJSON")
            return fail(concat("type \"", type.substr(0, 40), "\" instead of \"CityJSON\" in the first object; ",
                               "a sequence starts with its header"));
        const std::string version = findText(root, "version");
        if (!version.empty() && !version.starts_with("1.") && !version.starts_with("2."))
            return fail(concat("CityJSON version ", version.substr(0, 20), " is not 1.x or 2.x; convert it with cjio"));
        if (const json* metadata = findMember(root, "metadata"))
            if (const Status crs = readCrs(findText(*metadata, "referenceSystem")); !crs) return crs;
        const json* transform = findMember(root, "transform");
        if (!transform) return Nothing{};
        if (!readVector(*transform, "scale", scale_) || !readVector(*transform, "translate", translate_))
            return fail("transform needs \"scale\" and \"translate\" of three numbers each");
        return Nothing{};
    }

    /// The objects of the file, or of one line of a sequence, with the vertices beside them.
    void readObjects(const json& root, const std::string& place)
    {
        const json* objects = findMember(root, "CityObjects");
        if (!objects || !objects->is_object()) {
            file_.notes.push_back(concat(place, "no object \"CityObjects\", skipped"));
            return;
        }
        readVertices(root);
        const std::set<std::string> withParts = buildingsWithParts(*objects);
        for (const auto& [id, object] : objects->items()) {
            const std::string type = findText(object, "type");
            if (type == "Building" || type == "BuildingPart")
                readBuilding(id, object, *objects, withParts.contains(id));
            else
                ++others_[type.empty() ? "without a type" : type.substr(0, 40)];
        }
    }

    GeoFile finish()
    {
        if (lod2_)
            file_.notes.push_back(concat("LoD 2: ", modelled_, " of ", file_.features.size(), " buildings, ", walls_,
                                         " walls, ", roofs_, " roof faces; ", report_.degenerate,
                                         " faces without area dropped, ", report_.split, " bent ones split, ",
                                         report_.turned, " turned outward, ", shared_, " between solids left out"));
        if (fromRoof_ > 0)
            file_.notes.push_back(
                concat(fromRoof_, " buildings without a floor: the outline of the roof is their footprint"));
        if (templates_ > 0)
            file_.notes.push_back(
                concat(templates_, " geometry templates are not supported, ignored; the first is of ", firstTemplate_));
        if (others_.empty()) return std::move(file_);
        u32 count = 0;
        std::string list;
        for (const auto& [type, number] : others_) {
            count += number;
            // A hostile file can name as many types as it likes.
            if (list.size() < 400) list += concat(list.empty() ? "" : ", ", type, " ", number);
        }
        file_.notes.push_back(concat(count, " city objects that are no buildings ignored (", list, ")"));
        return std::move(file_);
    }

private:
    Error fail(const std::string& what) const { return Error{concat(name_, ": ", what)}; }
    void skip(const std::string& id, const std::string& why)
    {
        file_.notes.push_back(concat("feature ", id, ": ", why, ", skipped"));
    }

    Status readCrs(const std::string& reference)
    {
        const size_t end = reference.find_last_of(":/");
        const std::string code = end == std::string::npos ? reference : reference.substr(end + 1);
        file_.crs =
            reference.find("EPSG") != std::string::npos && end != std::string::npos ? "EPSG:" + code : reference;
        for (const char* degrees : {"4326", "4258", "4979", "4937", "CRS84", "CRS84h"})
            if (code == degrees)
                return fail(
                    concat("CRS ", file_.crs.substr(0, 60), " is in degrees; reproject to a metric one (cjio can)"));
        return Nothing{};
    }

    static bool readVector(const json& transform, const char* key, glm::dvec3& vector)
    {
        const json* list = findArray(transform, key);
        if (!list || list->size() != 3) return false;
        for (u32 i = 0; i < 3; ++i) {
            if (!(*list)[i].is_number()) return false;
            vector[int(i)] = (*list)[i].get<double>();
        }
        return true;
    }

    void readVertices(const json& root)
    {
        vertices_.clear();
        const json* list = findArray(root, "vertices");
        if (!list) return;
        vertices_.reserve(list->size());
        for (const json& corner : *list) {
            glm::dvec3 vertex(std::numeric_limits<double>::quiet_NaN());
            const bool isPoint = corner.is_array() && corner.size() == 3 && corner[0].is_number() &&
                                 corner[1].is_number() && corner[2].is_number();
            if (isPoint) {
                vertex =
                    glm::dvec3(corner[0].get<double>(), corner[1].get<double>(), corner[2].get<double>()) * scale_ +
                    translate_;
                const glm::dvec3 size = glm::abs(vertex);
                const bool isNear =
                    size.x <= kLargestCoordinate && size.y <= kLargestCoordinate && size.z <= kLargestCoordinate;
                if (!isNear) vertex = glm::dvec3(std::numeric_limits<double>::quiet_NaN());
            }
            vertices_.push_back(vertex);
        }
    }

    void countTemplates(const std::string& id, const json& object)
    {
        const json* list = findArray(object, "geometry");
        if (!list) return;
        for (const json& geometry : *list)
            if (findText(geometry, "type") == "GeometryInstance" && templates_++ == 0) firstTemplate_ = id;
    }

    void readBuilding(const std::string& id, const json& object, const json& objects, bool hasParts)
    {
        const std::vector<const json*> geometries = rankedGeometries(object);
        countTemplates(id, object);
        if (geometries.empty()) {
            if (!hasParts) skip(id, "no surfaces");
            return;
        }
        std::string trouble;
        for (const json* geometry : geometries) {
            if (hasParts && lodOf(*geometry) < 1.0) continue;
            const SurfaceSet set = readSurfaceSet(*geometry, vertices_);
            const GroundOutline outline = groundOutline(set);
            if (outline.polygons.empty()) {
                if (trouble.empty()) trouble = outline.trouble;
                continue;
            }
            if (set.badSurfaces > 0)
                file_.notes.push_back(concat("feature ", id, ": ", set.badSurfaces, " surfaces not usable (",
                                             set.trouble, "), left out"));
            return addFeature(id, object, objects, set, outline);
        }
        if (!trouble.empty()) skip(id, trouble);
    }

    void addFeature(const std::string& id, const json& object, const json& objects, const SurfaceSet& set,
                    const GroundOutline& outline)
    {
        GeoFeature feature;
        feature.id = id;
        feature.isPart = findText(object, "type") == "BuildingPart";
        readAttributes(object, objects, feature);
        const double height = outline.top - outline.ground;
        if (height >= kFlat && height <= kLargestHeight) feature.height = height;
        if (height > kLargestHeight)
            file_.notes.push_back(concat("feature ", id, ": height ", height, " m is not usable, ignored"));
        for (Polygon2 polygon : outline.polygons) {
            for (glm::dvec2& corner : polygon.outer) corner += glm::dvec2(set.anchor);
            for (Ring2& hole : polygon.holes)
                for (glm::dvec2& corner : hole) corner += glm::dvec2(set.anchor);
            feature.polygons.push_back(std::move(polygon));
        }
        fromRoof_ += outline.fromRoof;
        if (lod2_ && set.lod >= 2.0 && height >= kFlat && height <= kLargestHeight) {
            shared_ += set.sharedSurfaces;
            feature.faces = facesOf(set, outline, report_);
            ++modelled_;
            for (const GivenFace& face : feature.faces) ++(face.kind == GivenKind::Wall ? walls_ : roofs_);
        }
        file_.features.push_back(std::move(feature));
    }

    std::string_view name_;
    bool lod2_;
    glm::dvec3 scale_{1.0}, translate_{0.0};
    std::vector<glm::dvec3> vertices_; // m; NaN: not usable
    GeoFile file_;
    std::map<std::string, u32> others_; // city objects by type
    u32 fromRoof_ = 0, templates_ = 0, modelled_ = 0;
    u64 walls_ = 0, roofs_ = 0, shared_ = 0;
    std::string firstTemplate_;
    FaceReport report_;
};

std::string_view trimmed(std::string_view text)
{
    const size_t begin = text.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t\r\n") + 1 - begin);
}

// One object a line, and more than one of them.
bool isSequence(std::string_view text)
{
    std::string_view rest = trimmed(text);
    const std::string_view first = trimmed(takeLine(rest));
    return first.starts_with('{') && first.ends_with('}') && trimmed(rest).starts_with('{');
}

} // namespace

bool isCityJson(std::string_view text)
{
    u32 depth = 0;
    std::string_view key; // of the member at the top level
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '{' || c == '[') {
            if (depth == 0 && c == '[') return false;
            ++depth;
        } else if (c == '}' || c == ']') {
            if (depth <= 1) return false;
            --depth;
        } else if (c == '"') {
            const size_t begin = ++i;
            while (i < text.size() && text[i] != '"') i += text[i] == '\\' ? 2 : 1;
            if (i >= text.size()) return false;
            if (depth != 1) continue;
            const std::string_view word = text.substr(begin, i - begin);
            if (key == "type" && word.starts_with("CityJSON")) return true;
            if (key.empty() && word == "CityObjects") return true;
            if (key.empty()) key = word;
        } else if (c == ',' && depth == 1) {
            key = {};
        }
    }
    return false;
}

Result<GeoFile> readCityJson(std::string_view text, std::string_view name, bool lod2)
{
    Reader reader(name, lod2);
    if (!isSequence(text)) {
        const Result<json> root = parseJson(text, text, name, kAdvice);
        if (!root) return root.error();
        if (const Status header = reader.readHeader(*root); !header) return header.error();
        reader.readObjects(*root, "");
        return reader.finish();
    }
    std::string_view rest = text;
    bool hasHeader = false;
    for (u32 number = 1; !rest.empty(); ++number) {
        const std::string_view line = trimmed(takeLine(rest));
        if (line.empty()) continue;
        const Result<json> root = parseJson(line, text, name, kAdvice);
        if (!root) return root.error();
        if (!hasHeader) {
            if (const Status header = reader.readHeader(*root); !header) return header.error();
            hasHeader = true;
            if (const json* objects = findMember(*root, "CityObjects"); !objects || objects->empty()) continue;
        }
        reader.readObjects(*root, concat("line ", number, ": "));
    }
    return reader.finish();
}

} // namespace helio
