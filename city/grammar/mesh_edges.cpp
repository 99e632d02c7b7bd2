// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/mesh_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

namespace helio::cga {

namespace {

constexpr double kNear = 1e-3;      ///< m: edges this close run along each other
constexpr double kFlatAngle = 1e-4; ///< 1 - cosine: faces in one plane have no corner between them

/// True if `b` runs against `a` along a part of it.
bool runsAgainst(const MeshEdge& a, const MeshEdge& b)
{
    const double size = glm::distance(a.from, a.to);
    if (size < kNear) return false;
    const glm::dvec3 along = (a.to - a.from) / size;
    if (glm::dot(b.to - b.from, along) >= 0.0) return false;
    const double begin = glm::dot(b.to - a.from, along), end = glm::dot(b.from - a.from, along);
    return begin < size - kNear && end > kNear && glm::distance(a.from + along * begin, b.to) < kNear &&
           glm::distance(a.from + along * end, b.from) < kNear;
}

} // namespace

std::vector<MeshEdge> meshEdges(const Geometry& geometry, bool findPartial, u64* work)
{
    std::vector<MeshEdge> edges;
    std::map<EdgeKey, u32> byEnds;
    for (u32 f = 0; f < geometry.faces.size(); ++f) {
        const Face& face = geometry.faces[f];
        size_t number = 0;
        const auto addRing = [&](const Ring3& ring, bool outer) {
            for (size_t k = 0; k < ring.size(); ++k, ++number) {
                MeshEdge edge{ring[k], ring[(k + 1) % ring.size()], f};
                edge.footprint = number < face.edges.size() ? face.edges[number] : face.edge;
                edge.outer = outer;
                byEnds.emplace(edgeKey(edge.from, edge.to), u32(edges.size()));
                edges.push_back(edge);
            }
        };
        addRing(face.polygon.outer, true);
        for (const Ring3& hole : face.polygon.holes) addRing(hole, false);
    }
    std::vector<u32> open;
    for (u32 k = 0; k < edges.size(); ++k) {
        const auto opposite = byEnds.find(edgeKey(edges[k].to, edges[k].from));
        if (opposite == byEnds.end()) {
            open.push_back(k);
            continue;
        }
        edges[k].other = edges[opposite->second].face;
        edges[k].first = k < opposite->second;
        edges[k].border = false;
    }
    if (!findPartial) return edges;
    // From left to right: only edges whose ranges of x overlap can run along each other.
    const auto left = [&](u32 k) { return std::min(edges[k].from.x, edges[k].to.x); };
    const auto right = [&](u32 k) { return std::max(edges[k].from.x, edges[k].to.x); };
    std::sort(open.begin(), open.end(), [&](u32 a, u32 b) { return std::pair(left(a), a) < std::pair(left(b), b); });
    for (size_t i = 0; i < open.size(); ++i)
        for (size_t j = i + 1; j < open.size() && left(open[j]) <= right(open[i]) + kNear; ++j) {
            MeshEdge &a = edges[open[i]], &b = edges[open[j]];
            if (work) ++*work;
            if (a.face == b.face) continue;
            if (runsAgainst(a, b)) a.border = false;
            if (runsAgainst(b, a)) b.border = false;
        }
    return edges;
}

RoofEdge roofEdge(const glm::dvec3& direction, const glm::dvec3& normal, const glm::dvec3* otherNormal)
{
    const double slopeLimit = std::sin(11.25 * M_PI / 180.0), levelLimit = std::sin(5.0 * M_PI / 180.0);
    const glm::dvec3 along = glm::normalize(direction);
    const bool level = std::abs(along.y) <= levelLimit, slope = normal.y > slopeLimit,
               otherSlope = otherNormal && otherNormal->y > slopeLimit;
    if (slope && otherSlope) {
        if (glm::dot(normal, *otherNormal) > 1.0 - kFlatAngle) return RoofEdge::None;
        const bool convex = glm::dot(glm::cross(normal, *otherNormal), along) > 0.0;
        return !convex ? RoofEdge::Valley : level ? RoofEdge::Ridge : RoofEdge::Hip;
    }
    if (!level || slope == otherSlope) return RoofEdge::None;
    // Into the slope, from the edge: it must rise.
    const glm::dvec3 into = slope ? glm::cross(normal, along) : glm::cross(*otherNormal, -along);
    return into.y > levelLimit ? RoofEdge::Eave : RoofEdge::None;
}

std::vector<TrimPlane> trimPlanesOf(const Geometry& geometry, const std::vector<MeshEdge>& edges, u32 face,
                                    const glm::dvec3& up)
{
    std::vector<TrimPlane> planes;
    const Face& own = geometry.faces[face];
    const glm::dvec3 normal = unitNormal(own.polygon);
    for (const MeshEdge& edge : edges) {
        if (edge.face != face || edge.other == kNoIndex || edge.other == face) continue;
        const glm::dvec3 other = unitNormal(geometry.faces[edge.other].polygon), by = edge.to - edge.from;
        if (glm::length(by) < kNear || glm::dot(normal, other) > 1.0 - kFlatAngle || glm::length(normal + other) < 1e-3)
            continue;
        const glm::dvec3 along = glm::normalize(by);
        // Left of the edge, as seen from outside, lies the face.
        const glm::dvec3 side = glm::normalize(glm::cross(normal + other, along));
        TrimPlane trim{glm::dvec4(side, -glm::dot(side, edge.from)),
                       std::abs(glm::dot(along, up)) >= std::sin(40.0 * M_PI / 180.0)};
        bool cutsFace = false;
        for (const glm::dvec3& p : own.polygon.outer) cutsFace = cutsFace || glm::dot(side, p) + trim.plane.w < -kNear;
        bool known = false;
        for (const TrimPlane& t : planes) known = known || glm::length(t.plane - trim.plane) < 1e-9;
        if (!cutsFace && !known) planes.push_back(trim);
    }
    return planes;
}

} // namespace helio::cga
