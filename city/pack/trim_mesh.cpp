// SPDX-License-Identifier: Apache-2.0
#include "city/pack/trim_mesh.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace helio {
namespace {

constexpr double kOnPlane = 1e-7; // m

double heightOver(const glm::dvec4& plane, const glm::dvec3& p)
{
    const double h = glm::dot(glm::dvec3(plane), p) + plane.w;
    return std::abs(h) < kOnPlane ? 0.0 : h;
}

TrimmedVertex between(const TrimmedVertex& a, const TrimmedVertex& b, double share)
{
    const glm::dvec3 normal = glm::mix(a.normal, b.normal, share);
    const double length = glm::length(normal);
    return {glm::mix(a.position, b.position, share), length > 0.0 ? normal / length : a.normal,
            glm::mix(a.albedo, b.albedo, share), a.glass};
}

std::vector<TrimmedVertex> clip(const std::vector<TrimmedVertex>& corners, const glm::dvec4& plane)
{
    std::vector<TrimmedVertex> kept;
    for (size_t i = 0; i < corners.size(); ++i) {
        const TrimmedVertex &a = corners[i], &b = corners[(i + 1) % corners.size()];
        const double ha = heightOver(plane, a.position), hb = heightOver(plane, b.position);
        if (ha >= 0.0) kept.push_back(a);
        if ((ha > 0.0 && hb < 0.0) || (ha < 0.0 && hb > 0.0)) kept.push_back(between(a, b, ha / (ha - hb)));
    }
    return kept;
}

} // namespace

TrimmedMesh trimMesh(const AssetMesh& mesh, const glm::dmat4x3& worldFromAsset, std::span<const glm::dvec4> planes)
{
    // Adjugate transpose: right for normals under uneven scales, and for mirrored assets it keeps them outside.
    const glm::dmat3 m(worldFromAsset);
    const glm::dmat3 forNormals(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    const double handed = glm::dot(m[0], glm::cross(m[1], m[2])) < 0.0 ? -1.0 : 1.0;
    const auto vertex = [&](u32 i) {
        const glm::dvec3 normal = handed * (forNormals * glm::dvec3(mesh.normals[i]));
        const double length = glm::length(normal);
        return TrimmedVertex{worldFromAsset * glm::dvec4(mesh.positions[i], 1.0),
                             length > 0.0 ? normal / length : glm::dvec3(0, 0, 1), mesh.albedos[i], mesh.isGlass[i]};
    };
    TrimmedMesh out;
    for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
        std::vector<TrimmedVertex> corners{vertex(mesh.indices[t]), vertex(mesh.indices[t + 1]),
                                           vertex(mesh.indices[t + 2])};
        for (const glm::dvec4& plane : planes) corners = clip(corners, plane);
        if (corners.size() < 3) continue;
        const u32 base = u32(out.vertices.size());
        out.vertices.insert(out.vertices.end(), corners.begin(), corners.end());
        for (u32 k = 1; k + 1 < corners.size(); ++k)
            out.indices.insert(out.indices.end(), {base, base + k, base + k + 1});
    }
    return out;
}

} // namespace helio
