// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/occlusion.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "city/grammar/clip.h"

namespace helio::cga {

namespace {

constexpr double kTolerance = 0.01; ///< m: contacts and gaps below this do not count
constexpr double kNearWall = 0.05;  ///< m: how far before or behind a wall a shape still stands on it

struct Box
{
    glm::dvec2 low{INFINITY}, high{-INFINITY};
    void add(const glm::dvec2& p)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
};

/// The part of a ring on one side of an axis-parallel line (Sutherland and Hodgman 1974): sign * (p[axis] - at) <= 0.
Ring2 clipHalf(const Ring2& ring, int axis, double at, double sign)
{
    Ring2 result;
    for (size_t k = 0; k < ring.size(); ++k) {
        const glm::dvec2 &a = ring[k], &b = ring[(k + 1) % ring.size()];
        const double da = sign * (a[axis] - at), db = sign * (b[axis] - at);
        if (da <= 0.0) result.push_back(a);
        if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) {
            glm::dvec2 p = a + (b - a) * (da / (da - db));
            p[axis] = at;
            result.push_back(p);
        }
    }
    return result;
}

Ring2 clipBox(const Ring2& ring, double left, double right, double top)
{
    return clipHalf(clipHalf(clipHalf(ring, 0, left, -1.0), 0, right, 1.0), 1, top, 1.0);
}

} // namespace

Occlusion::Occlusion(const Footprint& footprint)
{
    u32 edge = 0;
    const glm::dvec2 first = footprintCorner(footprint);
    const auto addRing = [&](const Ring2& ring) {
        for (size_t k = 0; k < ring.size(); ++k, ++edge) {
            if (edge >= footprint.covered.size() || footprint.covered[edge].empty()) continue;
            const glm::dvec2 a = ring[k] - first, b = ring[(k + 1) % ring.size()] - first;
            const double length = glm::distance(a, b);
            if (!(length > 0.0)) continue;
            Wall wall;
            wall.edge = edge;
            wall.corner = {a.x, 0.0, -a.y};
            wall.along = glm::dvec3(b.x - a.x, 0.0, a.y - b.y) / length;
            wall.out = glm::cross(wall.along, glm::dvec3(0, 1, 0));
            wall.strips = skyline(footprint.covered[edge], 0.0);
            wall.wide = skyline(footprint.covered[edge], kTolerance);
            if (!wall.strips.empty()) walls_.push_back(std::move(wall));
        }
    };
    addRing(footprint.outline.outer);
    for (const Ring2& hole : footprint.outline.holes) addRing(hole);
}

/// Disjoint strips under the upper envelope of spans that may overlap.
std::vector<Occlusion::Strip> Occlusion::skyline(const std::vector<CoveredSpan>& spans, double margin)
{
    std::vector<double> cuts;
    for (const CoveredSpan& span : spans) {
        if (!(span.end > span.begin && span.height > 0.0)) continue;
        cuts.push_back(span.begin - margin);
        cuts.push_back(span.end + margin);
    }
    std::sort(cuts.begin(), cuts.end());
    std::vector<Strip> strips;
    for (size_t k = 0; k + 1 < cuts.size(); ++k) {
        const double middle = 0.5 * (cuts[k] + cuts[k + 1]);
        double height = 0.0;
        for (const CoveredSpan& span : spans)
            if (span.begin - margin < middle && middle < span.end + margin && span.end > span.begin)
                height = std::max(height, span.height);
        if (height <= 0.0 || cuts[k + 1] <= cuts[k]) continue;
        height += margin;
        if (!strips.empty() && strips.back().end == cuts[k] && strips.back().height == height)
            strips.back().end = cuts[k + 1];
        else
            strips.push_back({cuts[k], cuts[k + 1], height});
    }
    return strips;
}

bool Occlusion::project(const Wall& wall, const Scope& scope, const Face& face, Polygon2& flat)
{
    const glm::dvec3 normal = scope.axes * unitNormal(face.polygon);
    if (std::abs(glm::dot(normal, wall.out)) < 0.999) return false;
    bool near = true;
    const auto convert = [&](const Ring3& ring) {
        Ring2 result;
        for (const glm::dvec3& local : ring) {
            const glm::dvec3 p = scope.toWorld(local) - wall.corner;
            near = near && std::abs(glm::dot(p, wall.out)) <= kNearWall;
            result.emplace_back(glm::dot(p, wall.along), p.y);
        }
        return result;
    };
    flat.outer = convert(face.polygon.outer);
    flat.holes.clear();
    for (const Ring3& hole : face.polygon.holes) flat.holes.push_back(convert(hole));
    return near;
}

bool Occlusion::meets(const Polygon2& flat, const Strip& strip)
{
    Box box;
    const Ring2 part = clipBox(flat.outer, strip.begin, strip.end, strip.height);
    for (const glm::dvec2& p : part) box.add(p);
    double contact = part.size() < 3 ? 0.0 : std::abs(signedArea(part));
    for (const Ring2& hole : flat.holes) {
        const Ring2 open = clipBox(hole, strip.begin, strip.end, strip.height);
        if (open.size() >= 3) contact -= std::abs(signedArea(open));
    }
    return contact > kTolerance * kTolerance && box.high.x - box.low.x > kTolerance &&
           box.high.y - box.low.y > kTolerance;
}

bool Occlusion::within(const Polygon2& flat, const Wall& wall)
{
    double open = area(flat);
    for (const Strip& strip : wall.wide) {
        const auto part = [&](const Ring2& ring) {
            const Ring2 clipped = clipBox(ring, strip.begin, strip.end, strip.height);
            return clipped.size() < 3 ? 0.0 : std::abs(signedArea(clipped));
        };
        open -= part(flat.outer);
        for (const Ring2& hole : flat.holes) open += part(hole);
    }
    return open <= 1e-9 * (1.0 + area(flat));
}

bool Occlusion::touches(const Scope& scope, const Geometry& geometry, u32 edge) const
{
    Polygon2 flat;
    for (const Wall& wall : walls_) {
        if (edge != kNoIndex && wall.edge != edge) continue;
        for (const Face& face : geometry.faces) {
            if (project(wall, scope, face, flat)) {
                for (const Strip& strip : wall.strips)
                    if (meets(flat, strip)) return true;
                continue;
            }
            if (geometry.closed || std::abs((scope.axes * unitNormal(face.polygon)).y) < 0.999) continue;
            // A lot has no height: its edges count as the feet of its walls.
            const auto runsAlong = [&](const Ring3& ring) {
                for (size_t k = 0; k < ring.size(); ++k) {
                    const glm::dvec3 a = scope.toWorld(ring[k]) - wall.corner,
                                     b = scope.toWorld(ring[(k + 1) % ring.size()]) - wall.corner;
                    if (std::abs(glm::dot(a, wall.out)) > kNearWall || std::abs(glm::dot(b, wall.out)) > kNearWall)
                        continue;
                    const auto [left, right] = std::minmax({glm::dot(a, wall.along), glm::dot(b, wall.along)});
                    for (const Strip& strip : wall.strips)
                        if (a.y < strip.height - kTolerance &&
                            std::min(right, strip.end) - std::max(left, strip.begin) > kTolerance)
                            return true;
                }
                return false;
            };
            if (runsAlong(face.polygon.outer)) return true;
            for (const Ring3& hole : face.polygon.holes)
                if (runsAlong(hole)) return true;
        }
    }
    return false;
}

bool Occlusion::inside(const Scope& scope, const Geometry& geometry, u32 edge) const
{
    if (walls_.empty() || geometry.faces.empty()) return false;
    Polygon2 flat;
    for (const Face& face : geometry.faces) {
        bool found = false;
        for (const Wall& wall : walls_) {
            if ((edge != kNoIndex && wall.edge != edge) || !project(wall, scope, face, flat)) continue;
            found = found || within(flat, wall);
        }
        if (!found) return false;
    }
    return true;
}

void Occlusion::divide(const Scope& scope, const Face& face, u32 edge, Geometry& open, Geometry& hidden) const
{
    Polygon2 flat;
    const auto stands = [&](const Wall& wall) { return wall.edge == edge && project(wall, scope, face, flat); };
    const auto wall = std::find_if(walls_.begin(), walls_.end(), stands);
    if (wall == walls_.end()) return open.faces.push_back(face);
    if (within(flat, *wall)) return hidden.faces.push_back(face);
    Box box;
    for (const glm::dvec2& p : flat.outer) box.add(p);
    const glm::dmat3 toScope = glm::transpose(scope.axes);
    const glm::dvec3 along = toScope * wall->along, up = toScope * glm::dvec3(0, 1, 0);
    const double left = glm::dot(wall->corner - scope.origin, wall->along), foot = wall->corner.y - scope.origin.y;
    const auto append = [](Geometry& to, const Geometry& from) {
        to.faces.insert(to.faces.end(), from.faces.begin(), from.faces.end());
    };
    Geometry rest;
    rest.faces.push_back(face);
    double done = box.low.x; // everything to the left of it is dealt with
    for (const Strip& strip : wall->strips) {
        if (!meets(flat, strip)) continue;
        // Borders closer than the tolerance to each other or to the face's own would only make slivers.
        if (strip.begin > done + kTolerance) {
            append(open, clipPlane(rest, -along, -(left + strip.begin)));
            rest = clipPlane(rest, along, left + strip.begin);
        }
        Geometry slab = rest;
        done = strip.end;
        if (strip.end < box.high.x - kTolerance) {
            slab = clipPlane(rest, -along, -(left + strip.end));
            rest = clipPlane(rest, along, left + strip.end);
        } else {
            rest = {};
        }
        if (strip.height < box.high.y - kTolerance) {
            append(open, clipPlane(slab, up, foot + strip.height));
            slab = clipPlane(slab, -up, -(foot + strip.height));
        }
        append(hidden, slab);
    }
    append(open, rest);
}

bool Occlusion::covers(const glm::dvec3& point, u32 edge) const
{
    for (const Wall& wall : walls_) {
        if (edge != kNoIndex && wall.edge != edge) continue;
        const glm::dvec3 p = point - wall.corner;
        if (std::abs(glm::dot(p, wall.out)) > kNearWall) continue;
        const double x = glm::dot(p, wall.along);
        for (const Strip& strip : wall.strips)
            if (strip.begin <= x && x <= strip.end && p.y <= strip.height) return true;
    }
    return false;
}

} // namespace helio::cga
