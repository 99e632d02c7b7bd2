// SPDX-License-Identifier: Apache-2.0
#include "city/layout/cityjson_geometry.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "city/geometry/clip.h"
#include "city/layout/json_text.h"

namespace helio {

namespace {

using nlohmann::json;

// Levels of arrays above a surface; 0 for a type without surfaces.
u32 levelsOf(const std::string& type)
{
    if (type == "MultiSurface" || type == "CompositeSurface") return 1;
    if (type == "Solid") return 2;
    if (type == "MultiSolid" || type == "CompositeSolid") return 3;
    return 0;
}

SurfaceKind kindOf(const std::string& type)
{
    if (type == "GroundSurface") return SurfaceKind::Ground;
    if (type == "WallSurface") return SurfaceKind::Wall;
    if (type == "RoofSurface") return SurfaceKind::Roof;
    if (type == "InteriorWallSurface" || type == "CeilingSurface" || type == "FloorSurface") return SurfaceKind::Inside;
    return SurfaceKind::Unknown;
}

class SurfaceReader
{
public:
    SurfaceReader(const json& geometry, std::span<const glm::dvec3> vertices) : vertices_(vertices)
    {
        const std::string type = findText(geometry, "type");
        const u32 levels = levelsOf(type);
        set_.lod = lodOf(geometry);
        const json* values = nullptr;
        if (const json* semantics = findMember(geometry, "semantics")) {
            if (const json* surfaces = findArray(*semantics, "surfaces"))
                for (const json& surface : *surfaces) kinds_.push_back(kindOf(findText(surface, "type")));
            values = findArray(*semantics, "values");
        }
        if (const json* boundaries = findMember(geometry, "boundaries"); boundaries && levels > 0)
            collect(*boundaries, values, levels);
        if (levels == 3) dropShared();
    }
    SurfaceSet& set() { return set_; }

private:
    void refuse(const std::string& why)
    {
        if (set_.badSurfaces++ == 0) set_.trouble = why;
    }

    void collect(const json& list, const json* values, u32 levels)
    {
        if (!list.is_array()) return refuse("boundaries are not nested arrays");
        // Of a solid's shells the first is its skin; the others bound hollows inside.
        const size_t count = levels == 2 ? std::min<size_t>(1, list.size()) : list.size();
        for (size_t i = 0; i < count; ++i) {
            const json* own = values && values->is_array() && i < values->size() ? &(*values)[i] : nullptr;
            if (levels > 1)
                collect(list[i], own, levels - 1);
            else
                readSurface(list[i], own);
        }
    }

    void readSurface(const json& rings, const json* value)
    {
        if (!rings.is_array() || rings.empty()) return refuse("a surface without rings");
        CitySurface surface;
        if (value && value->is_number_unsigned() && value->get<u64>() < kinds_.size())
            surface.kind = kinds_[value->get<size_t>()];
        if (!readRing(rings[0], surface.polygon.outer, &surface.corners)) return;
        for (size_t r = 1; r < rings.size(); ++r)
            if (Ring3 hole; readRing(rings[r], hole, nullptr)) surface.polygon.holes.push_back(std::move(hole));
        set_.surfaces.push_back(std::move(surface));
    }

    bool readRing(const json& indices, Ring3& ring, std::vector<u32>* corners)
    {
        if (!indices.is_array()) return refuse("a ring that is no array of indices"), false;
        for (const json& index : indices) {
            const bool isIndex = index.is_number_unsigned() && index.get<u64>() < vertices_.size();
            if (!isIndex)
                return refuse(concat("index ", index.is_structured() ? "[...]" : index.dump().substr(0, 24),
                                     " is none of ", vertices_.size(), " vertices")),
                       false;
            const u32 corner = index.get<u32>();
            const glm::dvec3& vertex = vertices_[corner];
            if (std::isnan(vertex.x)) return refuse(concat("vertex ", corner, " is not usable")), false;
            if (!hasAnchor_) set_.anchor = vertex;
            hasAnchor_ = true;
            const glm::dvec3 local = vertex - set_.anchor;
            if (std::max({std::abs(local.x), std::abs(local.y), std::abs(local.z)}) > 0.1 * kGridLimit)
                return refuse(concat("vertex ", corner, " lies over ", 1e-4 * kGridLimit, " km from the others")),
                       false;
            if (corners) corners->push_back(corner);
            ring.push_back(local);
        }
        if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
        if (ring.size() < 3) {
            if (corners) ++set_.degenerate;
            return false;
        }
        return true;
    }

    // Two solids of a set that touch both hold the surface between them; no light gets there.
    void dropShared()
    {
        const auto key = [](const CitySurface& surface) {
            std::vector<u32> corners = surface.corners;
            std::sort(corners.begin(), corners.end());
            return corners;
        };
        std::map<std::vector<u32>, u32> uses;
        for (const CitySurface& surface : set_.surfaces) ++uses[key(surface)];
        set_.sharedSurfaces =
            u32(std::erase_if(set_.surfaces, [&](const CitySurface& surface) { return uses[key(surface)] > 1; }));
    }

    std::span<const glm::dvec3> vertices_;
    std::vector<SurfaceKind> kinds_; // of the semantic objects
    SurfaceSet set_;
    bool hasAnchor_ = false;
};

} // namespace

bool hasSurfaces(const json& geometry)
{
    return levelsOf(findText(geometry, "type")) > 0;
}

double lodOf(const json& geometry)
{
    const json* lod = findMember(geometry, "lod");
    double number = -1.0;
    if (lod && lod->is_number()) number = lod->get<double>();
    if (lod && lod->is_string()) {
        const std::string text = lod->get<std::string>();
        std::from_chars(text.data(), text.data() + text.size(), number);
    }
    if (number >= 0.0 && number < 10.0) return number;
    return findMember(geometry, "semantics") ? 2.0 : 1.0;
}

SurfaceSet readSurfaceSet(const json& geometry, std::span<const glm::dvec3> vertices)
{
    return std::move(SurfaceReader(geometry, vertices).set());
}

} // namespace helio
