// SPDX-License-Identifier: Apache-2.0
#include "city/geometry/roof_solid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace helio {

namespace {

constexpr double kSlab = 0.1; ///< thickness of a flat roof, m

/// Rings of node indices of a base whose corners are the first nodes.
std::vector<std::vector<u32>> baseRings(const Polygon2& base)
{
    std::vector<std::vector<u32>> rings;
    u32 next = 0;
    const auto add = [&](const Ring2& ring) {
        rings.emplace_back();
        for (std::size_t i = 0; i < ring.size(); ++i) rings.back().push_back(next++);
    };
    add(base.outer);
    for (const Ring2& hole : base.holes) add(hole);
    return rings;
}

/// The faces below and, shifted by `above` nodes, above a base.
RoofMesh::Face cap(const Polygon2& base, bool up, u32 above)
{
    std::vector<std::vector<u32>> rings = baseRings(base);
    for (std::vector<u32>& ring : rings) {
        for (u32& n : ring) n += above;
        if (!up) std::reverse(ring.begin(), ring.end());
    }
    RoofMesh::Face face;
    face.ring = std::move(rings[0]);
    face.holes.assign(std::make_move_iterator(rings.begin() + 1), std::make_move_iterator(rings.end()));
    face.part = up ? RoofPart::Slope : RoofPart::Bottom;
    return face;
}

} // namespace

bool soundPitch(const RoofPitch& pitch)
{
    return pitch.byHeight ? pitch.value > 0.0 && pitch.value <= 1e4 : pitch.value >= 0.1 && pitch.value <= 89.0;
}

double slopeFactor(const RoofMesh& mesh, const RoofPitch& pitch)
{
    if (!pitch.byHeight) return std::tan(pitch.value * std::numbers::pi / 180.0);
    double highest = 1e-6;
    for (const glm::dvec3& node : mesh.nodes) highest = std::max(highest, node.z);
    return pitch.value / highest;
}

void append(Roof& roof, const RoofMesh& mesh, double factor)
{
    const auto lift = [&](const std::vector<u32>& ring) {
        Ring3 result;
        result.reserve(ring.size());
        for (const u32 n : ring) result.push_back({mesh.nodes[n].x, mesh.nodes[n].y, mesh.nodes[n].z * factor});
        return result;
    };
    for (const RoofMesh::Face& face : mesh.faces) {
        RoofFace out{{lift(face.ring), {}}, face.part, face.edge};
        for (const std::vector<u32>& hole : face.holes) out.polygon.holes.push_back(lift(hole));
        roof.faces.push_back(std::move(out));
    }
}

void noteFallback(Roof& roof, RoofFallback fallback, const std::string& reason)
{
    if (fallback <= roof.fallback) return;
    roof.fallback = fallback;
    roof.reason = reason;
}

void appendFlat(Roof& roof, const RoofBase& piece, const std::string& reason)
{
    RoofMesh mesh;
    const auto edges = edgesOf(piece.polygon);
    const u32 n = u32(edges.size());
    for (const double z : {0.0, kSlab})
        for (const auto& [a, b] : edges) mesh.nodes.push_back({a.x, a.y, z});
    mesh.faces.push_back(cap(piece.polygon, true, n));
    for (const std::vector<u32>& ring : baseRings(piece.polygon)) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const u32 a = ring[i], b = ring[(i + 1) % ring.size()];
            mesh.faces.push_back({{a, b, b + n, a + n}, {}, RoofPart::Gable, piece.edge[a]});
        }
    }
    mesh.faces.push_back(cap(piece.polygon, false, 0));
    append(roof, mesh, 1.0);
    noteFallback(roof, RoofFallback::Flat, reason);
}

RoofMesh skeletonMesh(const RoofBase& base, const Skeleton& skeleton, std::span<const double> speeds, double shift)
{
    RoofMesh mesh;
    for (const SkeletonNode& node : skeleton.nodes)
        mesh.nodes.push_back({node.position.x, node.position.y, node.time - shift});
    for (u32 i = 0; i < skeleton.faces.size(); ++i) {
        const bool gable = !speeds.empty() && speeds[i] == 0.0;
        mesh.faces.push_back({skeleton.faces[i], {}, gable ? RoofPart::Gable : RoofPart::Slope, base.edge[i]});
    }
    mesh.faces.push_back(cap(base.polygon, false, 0));
    return mesh;
}

Result<Skeleton> robustSkeleton(RoofBase& base, std::span<const double> speedOf, std::vector<double>& speeds)
{
    const auto named = [&](const RoofBase& b) {
        speeds.clear();
        if (speedOf.empty()) return;
        for (const u32 edge : b.edge) speeds.push_back(speedOf[edge]);
    };
    named(base);
    Result<Skeleton> skeleton = straightSkeleton(base.polygon, speeds);
    if (skeleton || edgeCount(base.polygon) > kSkeletonMaxCorners) return skeleton;
    std::optional<RoofBase> loose = loosenBase(base);
    if (!loose) return skeleton;
    named(*loose);
    Result<Skeleton> again = straightSkeleton(loose->polygon, speeds);
    if (!again) return skeleton;
    base = std::move(*loose);
    return again;
}

void appendHip(Roof& roof, const RoofBase& piece, const RoofPitch& pitch, double overhang)
{
    std::vector<double> speeds;
    std::string reason;
    for (const double width : {overhang, 0.0}) {
        const std::vector<double> widths(edgeCount(piece.polygon), width);
        std::optional<RoofBase> base = growBase(piece, widths);
        Result<Skeleton> skeleton = base ? robustSkeleton(*base, {}, speeds) : Error{"the overhang falls into pieces"};
        if (!skeleton) {
            if (reason.empty()) reason = skeleton.error().message;
            continue;
        }
        const RoofMesh mesh = skeletonMesh(*base, *skeleton, {}, width);
        append(roof, mesh, slopeFactor(mesh, pitch));
        if (width < overhang) noteFallback(roof, RoofFallback::Parts, "no overhang: " + reason);
        return;
    }
    appendFlat(roof, piece, reason);
}

} // namespace helio
