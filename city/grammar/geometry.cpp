// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <set>

namespace helio::cga {

namespace {

template <class Visit> void forEachRing(const Polygon3& polygon, const Visit& visit)
{
    visit(polygon.outer);
    for (const Ring3& hole : polygon.holes) visit(hole);
}

template <class Visit> void forEachCorner(const Geometry& geometry, const Visit& visit)
{
    for (const Face& face : geometry.faces)
        forEachRing(face.polygon, [&](const Ring3& ring) {
            for (const glm::dvec3& p : ring) visit(p);
        });
}

/// Corners at which the ring turns, without collinear ones (0.01 rad).
Ring3 turningCorners(const Ring3& ring)
{
    Ring3 corners;
    for (size_t k = 0; k < ring.size(); ++k) {
        const glm::dvec3 before = ring[k] - ring[(k + ring.size() - 1) % ring.size()],
                         after = ring[(k + 1) % ring.size()] - ring[k];
        if (glm::length(glm::cross(before, after)) > 0.01 * glm::length(before) * glm::length(after))
            corners.push_back(ring[k]);
    }
    return corners;
}

u32 ringEdgeCount(const Polygon3& polygon)
{
    size_t count = 0;
    forEachRing(polygon, [&](const Ring3& ring) { count += ring.size(); });
    return u32(count);
}

} // namespace

double area(const Geometry& geometry)
{
    double sum = 0.0;
    for (const Face& face : geometry.faces) sum += area(face.polygon);
    return sum;
}

double volume(const Geometry& geometry)
{
    if (!geometry.closed) return 0.0;
    double sum = 0.0;
    for (const Face& face : geometry.faces)
        if (!face.polygon.outer.empty()) sum += glm::dot(face.polygon.outer[0], vectorArea(face.polygon)) / 3.0;
    return sum;
}

std::pair<glm::dvec3, glm::dvec3> bounds(const Geometry& geometry)
{
    glm::dvec3 low(INFINITY), high(-INFINITY);
    forEachCorner(geometry, [&](const glm::dvec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    });
    if (!(low.x <= high.x)) return {glm::dvec3(0.0), glm::dvec3(0.0)};
    return {low, high};
}

size_t cornerCount(const Geometry& geometry)
{
    size_t count = 0;
    for (const Face& face : geometry.faces) forEachRing(face.polygon, [&](const Ring3& ring) { count += ring.size(); });
    return count;
}

EdgeKey edgeKey(const glm::dvec3& a, const glm::dvec3& b)
{
    EdgeKey key;
    for (int k = 0; k < 3; ++k) {
        key[size_t(k)] = std::llround(a[k] * 1e6);
        key[size_t(k) + 3] = std::llround(b[k] * 1e6);
    }
    return key;
}

u64 planeWork(const Face& face)
{
    u64 corners = 0;
    forEachRing(face.polygon, [&](const Ring3& ring) { corners += ring.size(); });
    return 16 * corners + corners * corners / 2;
}

bool isConcave(const Geometry& geometry)
{
    for (const Face& face : geometry.faces) {
        if (!face.polygon.holes.empty()) return true;
        const glm::dvec3 normal = unitNormal(face.polygon);
        const Ring3 ring = turningCorners(face.polygon.outer);
        for (size_t k = 0; k < ring.size(); ++k) {
            const glm::dvec3 a = ring[(k + 1) % ring.size()] - ring[k],
                             b = ring[(k + 2) % ring.size()] - ring[(k + 1) % ring.size()];
            if (glm::dot(glm::cross(a, b), normal) < 0.0) return true;
        }
    }
    return false;
}

bool isRectangular(const Geometry& geometry, double toleranceDeg)
{
    const double limit = std::sin(toleranceDeg * M_PI / 180.0);
    for (const Face& face : geometry.faces) {
        const Ring3 ring = turningCorners(face.polygon.outer);
        if (ring.size() != 4 || !face.polygon.holes.empty()) return false;
        for (size_t k = 0; k < 4; ++k) {
            const glm::dvec3 a = glm::normalize(ring[(k + 1) % 4] - ring[k]),
                             b = glm::normalize(ring[(k + 2) % 4] - ring[(k + 1) % 4]);
            if (std::abs(glm::dot(a, b)) > limit) return false;
        }
    }
    return !geometry.faces.empty();
}

bool isPlanar(const Geometry& geometry)
{
    if (geometry.closed || geometry.faces.empty()) return false;
    const glm::dvec3 normal = unitNormal(geometry.faces[0].polygon), origin = geometry.faces[0].polygon.outer[0];
    for (const Face& face : geometry.faces)
        if (glm::dot(normal, unitNormal(face.polygon)) < 0.0) return false;
    bool planar = true;
    forEachCorner(geometry,
                  [&](const glm::dvec3& p) { planar = planar && std::abs(glm::dot(normal, p - origin)) < 1e-6; });
    return planar;
}

Geometry transformed(const Geometry& geometry, const glm::dmat3& rotation, const glm::dvec3& offset)
{
    Geometry result = geometry;
    for (Face& face : result.faces) {
        for (glm::dvec3& p : face.polygon.outer) p = rotation * (p - offset);
        for (Ring3& hole : face.polygon.holes)
            for (glm::dvec3& p : hole) p = rotation * (p - offset);
        face.xAxis = rotation * face.xAxis;
    }
    return result;
}

void fitScope(Scope& scope, Geometry& geometry)
{
    const auto [low, high] = bounds(geometry);
    scope.origin = scope.toWorld(low);
    scope.size = high - low;
    if (low == glm::dvec3(0.0)) return;
    for (Face& face : geometry.faces) {
        for (glm::dvec3& p : face.polygon.outer) p -= low;
        for (Ring3& hole : face.polygon.holes)
            for (glm::dvec3& p : hole) p -= low;
    }
}

void turnScope(Scope& scope, Geometry& geometry, const glm::dmat3& axes)
{
    geometry = transformed(geometry, glm::transpose(axes) * scope.axes, glm::dvec3(0.0));
    scope.axes = axes;
    fitScope(scope, geometry);
}

void inheritEdges(const Face& from, Face& part)
{
    constexpr double kTolerance = 1e-3; // m: offsets are rounded to a tenth of a millimetre
    struct Line
    {
        glm::dvec3 begin, along;
        double size;
        u32 edge;
    };
    std::vector<Line> lines;
    u32 number = 0;
    forEachRing(from.polygon, [&](const Ring3& ring) {
        for (size_t k = 0; k < ring.size(); ++k, ++number) {
            const glm::dvec3 by = ring[(k + 1) % ring.size()] - ring[k];
            const u32 edge = from.edges.empty() ? number : from.edges[number];
            if (edge != kNoIndex && glm::length(by) > kTolerance)
                lines.push_back({ring[k], glm::normalize(by), glm::length(by), edge});
        }
    });
    const auto liesOn = [&](const Line& line, const glm::dvec3& p) {
        const double at = glm::dot(p - line.begin, line.along);
        return at > -kTolerance && at < line.size + kTolerance &&
               glm::distance(line.begin + line.along * at, p) < kTolerance;
    };
    std::vector<u32> edges;
    forEachRing(part.polygon, [&](const Ring3& ring) {
        for (size_t k = 0; k < ring.size(); ++k) {
            const glm::dvec3 &a = ring[k], &b = ring[(k + 1) % ring.size()];
            const auto line = std::find_if(lines.begin(), lines.end(), [&](const Line& l) {
                return glm::dot(b - a, l.along) > 0.0 && liesOn(l, a) && liesOn(l, b);
            });
            edges.push_back(line == lines.end() ? kNoIndex : line->edge);
        }
    });
    part.edges = std::move(edges);
}

Geometry extrude(const Geometry& base, const glm::dvec3& by, bool tagEdges)
{
    std::set<EdgeKey> shared;
    if (base.faces.size() > 1)
        for (const Face& face : base.faces)
            forEachRing(face.polygon, [&](const Ring3& ring) {
                for (size_t k = 0; k < ring.size(); ++k) shared.insert(edgeKey(ring[(k + 1) % ring.size()], ring[k]));
            });

    Geometry solid;
    solid.closed = true;
    u32 edge = 0;
    for (const Face& face : base.faces) {
        // A face that looks against the vector becomes the bottom as it is; its walls run the other way round.
        const bool along = glm::dot(vectorArea(face.polygon), by) > 0.0;
        bool outer = true;
        size_t ringEdge = 0;
        forEachRing(face.polygon, [&](const Ring3& ring) {
            for (size_t k = 0; k < ring.size(); ++k, ++edge, ++ringEdge) {
                const glm::dvec3 &a = ring[k], &b = ring[(k + 1) % ring.size()];
                if (!shared.empty() && shared.count(edgeKey(a, b)) > 0) continue;
                if (a == b) continue;
                Face wall;
                wall.polygon.outer = along ? Ring3{a, b, b + by, a + by} : Ring3{b, a, a + by, b + by};
                wall.xAxis = glm::normalize(along ? b - a : a - b);
                wall.edge = ringEdge < face.edges.size() ? face.edges[ringEdge] : tagEdges ? edge : kNoIndex;
                wall.outer = outer;
                solid.faces.push_back(std::move(wall));
            }
            outer = false;
        });
    }
    for (const bool top : {true, false}) {
        u32 number = 0;
        for (const Face& face : base.faces) {
            Face cap = face;
            const bool along = glm::dot(vectorArea(face.polygon), by) > 0.0;
            const auto place = [&](Ring3& ring) {
                if (top)
                    for (glm::dvec3& p : ring) p += by;
                if (along != top) std::reverse(ring.begin(), ring.end());
            };
            place(cap.polygon.outer);
            for (Ring3& hole : cap.polygon.holes) place(hole);
            cap.edge = kNoIndex;
            if (along != top) cap.edges.clear();
            const u32 count = ringEdgeCount(face.polygon);
            if (along == top && tagEdges && cap.edges.empty())
                for (u32 k = 0; k < count; ++k) cap.edges.push_back(number + k);
            number += count;
            solid.faces.push_back(std::move(cap));
        }
    }
    return solid;
}

} // namespace helio::cga
