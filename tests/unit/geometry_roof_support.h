// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <string>

#include "city/base/check.h"
#include "city/geometry/roof.h"

// What every roof has to be, whatever made it.
namespace helio {

/// Faces of one part.
inline u32 countPart(const Roof& roof, RoofPart part)
{
    u32 count = 0;
    for (const RoofFace& face : roof.faces) count += face.part == part;
    return count;
}

/// Volume of a closed solid of plane faces, m3 (divergence theorem).
inline double volume(const Roof& roof)
{
    double sum = 0.0;
    for (const RoofFace& face : roof.faces) sum += glm::dot(face.polygon.outer[0], vectorArea(face.polygon)) / 3.0;
    return sum;
}

inline double highest(const Roof& roof)
{
    double z = -1e300;
    for (const RoofFace& face : roof.faces)
        for (const glm::dvec3& p : face.polygon.outer) z = std::max(z, p.z);
    return z;
}

inline double lowest(const Roof& roof)
{
    double z = 1e300;
    for (const RoofFace& face : roof.faces)
        for (const glm::dvec3& p : face.polygon.outer) z = std::min(z, p.z);
    return z;
}

/// Why the faces are no closed solid with its slopes up and its bottom down, or empty. Corners are compared as bits, so
/// a corner in the middle of another face's side is an open edge.
inline std::string solidProblem(const Roof& roof)
{
    std::map<std::array<double, 6>, int> edges;
    bool finite = true;
    const auto addRing = [&](const Ring3& ring) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const glm::dvec3& a = ring[i];
            const glm::dvec3& b = ring[(i + 1) % ring.size()];
            finite = finite && std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
            if (finite) ++edges[{a.x, a.y, a.z, b.x, b.y, b.z}];
        }
    };
    for (std::size_t i = 0; i < roof.faces.size(); ++i) {
        const RoofFace& face = roof.faces[i];
        addRing(face.polygon.outer);
        for (const Ring3& hole : face.polygon.holes) addRing(hole);
        if (!finite) return concat("face ", i, " is not finite");
        if (!(area(face.polygon) > 1e-6)) return concat("face ", i, " has no area");
        const double up = unitNormal(face.polygon).z;
        if (face.part == RoofPart::Slope && !(up > 0.0)) return concat("slope ", i, " looks down");
        if (face.part == RoofPart::Gable && !(std::abs(up) < 1e-6)) return concat("gable ", i, " is not upright");
        if (face.part == RoofPart::Bottom && !(up < -0.999999)) return concat("bottom ", i, " does not look down");
    }
    for (const auto& [edge, count] : edges) {
        const auto twin = edges.find({edge[3], edge[4], edge[5], edge[0], edge[1], edge[2]});
        if (count != 1 || twin == edges.end() || twin->second != 1)
            return concat("edge ", edge[0], " ", edge[1], " ", edge[2], " - ", edge[3], " ", edge[4], " ", edge[5],
                          " is not in two faces");
    }
    return {};
}

} // namespace helio
