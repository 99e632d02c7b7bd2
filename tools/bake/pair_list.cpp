// SPDX-License-Identifier: Apache-2.0
#include "tools/bake/pair_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "city/base/file.h"
#include "city/layout/json_text.h"

namespace helio {
namespace {

using nlohmann::json;

/// Largest coordinate, m: beyond any map, and far from where squares overflow.
constexpr double kMaxCoordinate = 1e9;

/// The corners of one polygon; `where` names file, pair and polygon.
Result<Ring3> readRing(const json& value, const std::string& where)
{
    if (!value.is_array()) return Error{concat(where, ": a list of corners [x, y, z] is needed")};
    if (value.size() > kMaxPairCorners + 1)
        return Error{concat(where, ": ", value.size(), " corners; at most ", kMaxPairCorners, " are taken")};
    Ring3 ring;
    for (const json& corner : value) {
        const bool good = corner.is_array() && corner.size() == 3 &&
                          std::ranges::all_of(corner, [](const json& number) { return number.is_number(); });
        if (!good) return Error{concat(where, ": corner ", ring.size(), " is not [x, y, z] in metres")};
        const glm::dvec3 p(corner[0].get<double>(), corner[1].get<double>(), corner[2].get<double>());
        if (!(std::abs(p.x) <= kMaxCoordinate && std::abs(p.y) <= kMaxCoordinate && std::abs(p.z) <= kMaxCoordinate))
            return Error{concat(where, ": corner ", ring.size(), " lies beyond ", kMaxCoordinate, " m")};
        ring.push_back(p);
    }
    if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
    if (ring.size() < 3) return Error{concat(where, ": ", ring.size(), " corners; a polygon has three or more")};
    return ring;
}

/// True if two edges of a ring in the plane cross in their insides.
bool edgesCross(const std::array<glm::dvec2, 2>& p, const std::array<glm::dvec2, 2>& q)
{
    const double a = cross(p[0], p[1], q[0]), b = cross(p[0], p[1], q[1]);
    const double c = cross(q[0], q[1], p[0]), d = cross(q[0], q[1], p[1]);
    return a * b < 0.0 && c * d < 0.0;
}

Status checkRing(const Ring3& ring, const std::string& where)
{
    Ring3 relative;
    double size = 0.0, largest = 0.0;
    for (const glm::dvec3& corner : ring) {
        relative.push_back(corner - ring[0]);
        size = std::max(size, glm::length(relative.back()));
        largest = std::max({largest, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
    }
    const double rounding = 4e-16 * largest;
    const glm::dvec3 vector = vectorArea(relative);
    const double area = glm::length(vector);
    if (!(area > 1e-15 * size * size && area > rounding * size))
        return Error{concat(where, ": the polygon has no area")};
    const PlaneFrame frame = planeFrame(vector / area);
    Ring2 flat;
    for (size_t k = 0; k < ring.size(); ++k) {
        const double height = std::abs(glm::dot(frame.normal, relative[k]));
        if (height > 1e-6 * size + 4.0 * rounding)
            return Error{
                concat(where, ": corner ", k, " lies ", height, " m off the plane; cut the polygon into planar ones")};
        flat.push_back({glm::dot(frame.u, relative[k]), glm::dot(frame.v, relative[k])});
    }
    const size_t n = flat.size();
    for (size_t i = 0; i < n; ++i)
        for (size_t k = i + 2; k < n; ++k)
            if (edgesCross({flat[i], flat[i + 1]}, {flat[k], flat[(k + 1) % n]}))
                return Error{concat(where, ": edges ", i, " and ", k, " cross; cut the polygon there")};
    return Nothing{};
}

Result<Ring3> readPolygon(const json& value, const std::string& where)
{
    Result<Ring3> ring = readRing(value, where);
    if (ring)
        if (Status status = checkRing(*ring, where); !status) return status.error();
    return ring;
}

Result<PolygonPair> readPair(const json& item, size_t index, const std::string& name)
{
    PolygonPair pair;
    const json* id = findMember(item, "id");
    if (!id || !id->is_string())
        return Error{concat(name, ": pair ", index, ": an object with \"id\" (text), \"a\" and \"b\" is needed")};
    pair.id = id->get<std::string>();
    const bool plain = std::ranges::none_of(pair.id, [](char c) { return c == ',' || c == '"' || u8(c) < 0x20; });
    if (pair.id.empty() || pair.id.size() > 200 || !plain)
        return Error{concat(name, ": pair ", index, ": the id needs 1 to 200 characters, no comma, quote or line end")};
    const std::string where = concat(name, ": pair ", pair.id);
    for (const auto& [key, ring] : {std::pair{"a", &pair.a}, {"b", &pair.b}}) {
        const json* corners = findMember(item, key);
        if (!corners) return Error{concat(where, ": \"", key, "\" is missing: a list of corners [x, y, z]")};
        Result<Ring3> polygon = readPolygon(*corners, concat(where, ": ", key));
        if (!polygon) return polygon.error();
        *ring = std::move(*polygon);
    }
    if (const json* occluders = findMember(item, "occluders")) {
        if (!occluders->is_array()) return Error{concat(where, ": \"occluders\" is a list of polygons")};
        if (occluders->size() > kMaxPairOccluders)
            return Error{
                concat(where, ": ", occluders->size(), " occluders; at most ", kMaxPairOccluders, " are taken")};
        for (const json& corners : *occluders) {
            Result<Ring3> polygon = readPolygon(corners, concat(where, ": occluder ", pair.occluders.size()));
            if (!polygon) return polygon.error();
            pair.occluders.push_back(std::move(*polygon));
        }
    }
    return pair;
}

} // namespace

Result<std::vector<PolygonPair>> readPolygonPairs(const std::filesystem::path& path)
{
    const Result<std::string> text = readTextFile(path);
    if (!text) return text.error();
    const std::string name = path.string();
    constexpr const char* kAdvice = "a list of {\"id\": ..., \"a\": [[x, y, z], ...], \"b\": ...} is needed";
    const Result<json> document = parseJson(*text, *text, name, kAdvice);
    if (!document) return document.error();
    if (!document->is_array()) return Error{concat(name, ": ", kAdvice)};
    std::vector<PolygonPair> pairs;
    std::set<std::string> ids;
    for (const json& item : *document) {
        Result<PolygonPair> pair = readPair(item, pairs.size(), name);
        if (!pair) return pair.error();
        if (!ids.insert(pair->id).second)
            return Error{concat(name, ": pair ", pairs.size(), ": the id ", pair->id, " stands there twice")};
        pairs.push_back(std::move(*pair));
    }
    return pairs;
}

} // namespace helio
