// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>

#include "city/geometry/roof_even.h"
#include "city/geometry/roof_solid.h"

namespace helio {

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kSameSide = 5.0 * kDegree; ///< turn between two edges of one side, at most
constexpr double kLeastAngle = 40.0 * kDegree, kMostAngle = 140.0 * kDegree;    ///< at a gable's corners
constexpr double kLeastAngles = 120.0 * kDegree, kMostAngles = 230.0 * kDegree; ///< of both corners together
/// A hip is a triangle when the rest of its border is this small a share of its side.
constexpr double kTriangleTolerance = 0.05;

/// A run of edges of almost one direction.
struct Side
{
    std::vector<u32> edges;
    u32 prev = 0, next = 0;
    double length = 0.0;
    double angle = 0.0; ///< interior, at its first corner
};

double turnBetween(const glm::dvec2& a, const glm::dvec2& b)
{
    return std::atan2(cross(a, b), glm::dot(a, b));
}

void addSides(const Ring2& ring, u32 first, std::vector<Side>& sides)
{
    const u32 n = u32(ring.size());
    const auto along = [&](u32 i) { return ring[(i + 1) % n] - ring[i % n]; };
    u32 start = 0;
    while (start < n && std::abs(turnBetween(along(start + n - 1), along(start))) < kSameSide) ++start;
    if (start == n) start = 0; // round: every corner is flat
    const u32 begin = u32(sides.size());
    for (u32 k = 0; k < n; ++k) {
        const u32 i = (start + k) % n;
        const double turn = turnBetween(along(i + n - 1), along(i));
        if (k == 0 || std::abs(turn) >= kSameSide) {
            sides.emplace_back();
            sides.back().angle = std::numbers::pi - turn;
        }
        sides.back().edges.push_back(first + i);
        sides.back().length += glm::length(along(i));
    }
    const u32 count = u32(sides.size()) - begin;
    for (u32 k = 0; k < count; ++k) {
        sides[begin + k].next = begin + (k + 1) % count;
        sides[begin + k].prev = begin + (k + count - 1) % count;
    }
}

std::vector<Side> sidesOf(const Polygon2& base)
{
    std::vector<Side> sides;
    u32 first = 0;
    addSides(base.outer, first, sides);
    first += u32(base.outer.size());
    for (const Ring2& hole : base.holes) {
        addSides(hole, first, sides);
        first += u32(hole.size());
    }
    return sides;
}

/// Length in plan of the border between the hip of each side and sides that are not next to it.
std::vector<double> foreignBorders(const std::vector<Side>& sides, const Skeleton& skeleton)
{
    std::vector<u32> sideOf(skeleton.faces.size());
    for (u32 s = 0; s < sides.size(); ++s)
        for (const u32 e : sides[s].edges) sideOf[e] = s;
    std::map<std::pair<u32, u32>, u32> owner;
    for (u32 f = 0; f < skeleton.faces.size(); ++f) {
        const std::vector<u32>& face = skeleton.faces[f];
        for (std::size_t i = 0; i < face.size(); ++i) owner[{face[i], face[(i + 1) % face.size()]}] = sideOf[f];
    }
    std::vector<double> borders(sides.size(), 0.0);
    for (const auto& [arc, s] : owner) {
        const auto twin = owner.find({arc.second, arc.first});
        if (twin == owner.end()) continue; // an edge of the base
        const u32 other = twin->second;
        if (other != s && other != sides[s].prev && other != sides[s].next)
            borders[s] += glm::distance(skeleton.nodes[arc.first].position, skeleton.nodes[arc.second].position);
    }
    return borders;
}

bool convex(const std::vector<Side>& sides)
{
    return std::all_of(sides.begin(), sides.end(), [](const Side& side) { return side.angle < std::numbers::pi; });
}

/// Sides that get a gable.
std::vector<bool> chooseGables(const RoofBase& base, const std::vector<Side>& sides, u32 index)
{
    std::vector<bool> gable(sides.size(), false);
    if (index != kNoIndex && sides.size() == 4 && base.polygon.holes.empty() && convex(sides)) {
        for (u32 s = 0; s < 4; ++s) {
            const bool asked =
                std::any_of(sides[s].edges.begin(), sides[s].edges.end(), [&](u32 e) { return base.edge[e] == index; });
            if (asked) {
                gable[sides[s].prev] = gable[sides[s].next] = true;
                return gable;
            }
        }
    }
    const Result<Skeleton> skeleton = straightSkeleton(base.polygon);
    if (!skeleton) return gable;
    const std::vector<double> borders = foreignBorders(sides, *skeleton);
    std::vector<u32> order;
    for (u32 s = 0; s < sides.size(); ++s) {
        const Side& side = sides[s];
        const double a = side.angle, b = sides[side.next].angle;
        if (side.prev == side.next || std::min(a, b) < kLeastAngle || std::max(a, b) > kMostAngle) continue;
        if (a + b < kLeastAngles || a + b > kMostAngles || borders[s] > kTriangleTolerance * side.length) continue;
        order.push_back(s);
    }
    // Centimetres: rounding on the grid does not choose between equal sides.
    std::stable_sort(order.begin(), order.end(), [&](u32 a, u32 b) {
        return std::llround(sides[a].length * 100.0) < std::llround(sides[b].length * 100.0);
    });
    for (const u32 s : order) gable[s] = !gable[sides[s].prev] && !gable[sides[s].next];
    return gable;
}

void appendGable(Roof& roof, const RoofBase& given, const RoofPitch& pitch, double eaves, double ends, bool even,
                 u32 index)
{
    // From here on edges are named by their place in the piece.
    const std::vector<Side> sides = sidesOf(given.polygon);
    const std::vector<bool> gable = chooseGables(given, sides, index);
    if (std::none_of(gable.begin(), gable.end(), [](bool g) { return g; })) {
        appendHip(roof, given, pitch, eaves);
        return;
    }
    RoofBase piece = given;
    std::vector<double> speedOf(piece.edge.size(), 1.0), widths(piece.edge.size(), eaves);
    for (u32 s = 0; s < sides.size(); ++s) {
        for (const u32 e : sides[s].edges) {
            if (!gable[s]) continue;
            speedOf[e] = 0.0;
            widths[e] = ends;
        }
    }
    for (u32 e = 0; e < piece.edge.size(); ++e) piece.edge[e] = e;
    std::vector<double> speeds;
    std::optional<RoofBase> base = growBase(piece, widths);
    Result<Skeleton> skeleton = base ? robustSkeleton(*base, speedOf, speeds) : Error{"the overhang falls into pieces"};
    if (!skeleton) {
        noteFallback(roof, RoofFallback::Parts, "hip instead of gables: " + skeleton.error().message);
        appendHip(roof, given, pitch, eaves);
        return;
    }
    for (u32& edge : base->edge) edge = given.edge[edge];
    RoofMesh mesh = skeletonMesh(*base, *skeleton, speeds, eaves);
    if (even) levelRidges(mesh);
    append(roof, mesh, slopeFactor(mesh, pitch));
}

} // namespace

Roof gableRoof(const Polygon2& base, const RoofPitch& pitch, double overhangX, double overhangY, bool even, u32 index)
{
    Roof roof;
    if (index != kNoIndex && !base.outer.empty()) index %= u32(base.outer.size());
    for (const RoofBase& piece : cleanBase(base)) {
        if (soundPitch(pitch))
            appendGable(roof, piece, pitch, std::clamp(overhangX, 0.0, kMostOverhang),
                        std::clamp(overhangY, 0.0, kMostOverhang), even, index);
        else
            appendFlat(roof, piece, "the pitch is out of range");
    }
    return roof;
}

} // namespace helio
