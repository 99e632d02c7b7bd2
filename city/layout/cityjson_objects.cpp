// SPDX-License-Identifier: Apache-2.0
#include "city/layout/cityjson_objects.h"

#include <algorithm>

#include "city/layout/cityjson_geometry.h"
#include "city/layout/json_text.h"

namespace helio {

namespace {

using nlohmann::json;

constexpr u32 kMostAncestors = 8; // parts of parts; also the end of a circle of parents

bool isPart(const json& object)
{
    return findText(object, "type") == "BuildingPart";
}

bool hasGeometry(const json& object)
{
    const json* list = findArray(object, "geometry");
    return list && std::any_of(list->begin(), list->end(), hasSurfaces);
}

std::optional<double> positive(const json& attributes, const char* key, double largest)
{
    const json* value = findMember(attributes, key);
    if (!value || !value->is_number()) return std::nullopt;
    const double number = value->get<double>();
    return number > 0.0 && number <= largest ? std::optional(number) : std::nullopt;
}

void addAttributes(const json& attributes, GeoFeature& feature)
{
    for (const auto& [key, value] : attributes.items()) {
        if (key == "height") continue;
        if (value.is_number()) feature.attributes[key] = value.get<double>();
        if (value.is_boolean()) feature.attributes[key] = value.get<bool>();
        if (value.is_string()) feature.attributes[key] = value.get<std::string>();
    }
    for (const char* key : {"height", "measuredHeight"})
        if (const std::optional<double> height = positive(attributes, key, kLargestHeight)) feature.height = height;
    for (const char* key : {"levels", "storeysAboveGround"})
        if (const std::optional<double> levels = positive(attributes, key, 0.5 * kLargestHeight))
            feature.levels = levels;
}

} // namespace

std::set<std::string> buildingsWithParts(const json& objects)
{
    std::set<std::string> ids;
    for (const auto& [id, object] : objects.items()) {
        if (isPart(object) && hasGeometry(object))
            if (const json* parents = findArray(object, "parents"))
                for (const json& parent : *parents)
                    if (parent.is_string()) ids.insert(parent.get<std::string>());
        if (const json* children = findArray(object, "children"))
            for (const json& child : *children) {
                const json* part = child.is_string() ? findMember(objects, child.get<std::string>().c_str()) : nullptr;
                if (part && isPart(*part) && hasGeometry(*part)) ids.insert(id);
            }
    }
    return ids;
}

// Attributes of the building first, so that those of the part replace them.
void readAttributes(const json& object, const json& objects, GeoFeature& feature)
{
    std::vector<const json*> line = {&object};
    while (line.size() <= kMostAncestors) {
        const json* parents = findArray(*line.back(), "parents");
        if (!parents || parents->empty() || !(*parents)[0].is_string()) break;
        const json* parent = findMember(objects, (*parents)[0].get<std::string>().c_str());
        if (!parent) break;
        line.push_back(parent);
    }
    for (size_t i = line.size(); i-- > 0;)
        if (const json* attributes = findMember(*line[i], "attributes"); attributes && attributes->is_object())
            addAttributes(*attributes, feature);
}

std::vector<const json*> rankedGeometries(const json& object)
{
    std::vector<const json*> result;
    const json* list = findArray(object, "geometry");
    if (!list) return result;
    for (const json& geometry : *list)
        if (hasSurfaces(geometry)) result.push_back(&geometry);
    const auto rank = [](const json* geometry) {
        const double lod = lodOf(*geometry);
        return lod < 3.0 ? 3.0 - lod : 3.0 + lod;
    };
    std::stable_sort(result.begin(), result.end(), [&](const json* a, const json* b) { return rank(a) < rank(b); });
    return result;
}

} // namespace helio
