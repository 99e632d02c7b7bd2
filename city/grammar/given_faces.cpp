// SPDX-License-Identifier: Apache-2.0
// Buildings that the input models by their surfaces: every surface starts a rule of its own.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "city/grammar/component.h"
#include "city/grammar/interpreter.h"

namespace helio::cga {

namespace {

constexpr double kOnEdge = 0.05; ///< m: how near a wall's foot must be to an edge of the footprint to stand on it

std::string_view ruleOf(GivenKind kind)
{
    static constexpr std::string_view kNames[] = {"WallSurface", "RoofSurface", "GroundSurface"};
    return kNames[size_t(kind)];
}

/// The edge of a ring whose middle lies lowest; the first of several.
size_t lowestEdge(const Ring3& ring)
{
    size_t lowest = 0;
    for (size_t k = 1; k < ring.size(); ++k)
        if (ring[k].y + ring[(k + 1) % ring.size()].y < ring[lowest].y + ring[(lowest + 1) % ring.size()].y - 1e-6)
            lowest = k;
    return lowest;
}

} // namespace

/// Edge of the footprint on which a segment of the building's frame stands, seen from above; kNoIndex if there is none.
u32 Interpreter::edgeUnder(const glm::dvec3& a, const glm::dvec3& b) const
{
    const glm::dvec2 first = footprintCorner(footprint_);
    const glm::dvec2 p[2] = {first + glm::dvec2(a.x, -a.z), first + glm::dvec2(b.x, -b.z)};
    u32 edge = 0;
    const auto find = [&](const Ring2& ring) {
        for (size_t k = 0; k < ring.size(); ++k, ++edge) {
            const glm::dvec2 from = ring[k], to = ring[(k + 1) % ring.size()];
            const double length = glm::distance(from, to);
            if (!(length > 0.0)) continue;
            const glm::dvec2 u = (to - from) / length;
            bool on = glm::dot(p[1] - p[0], u) > 0.0;
            for (const glm::dvec2& q : p) {
                const double along = glm::dot(q - from, u);
                on = on && along > -kOnEdge && along < length + kOnEdge && std::abs(cross(u, q - from)) < kOnEdge;
            }
            if (on) return true;
        }
        return false;
    };
    if (find(footprint_.outline.outer)) return edge;
    for (const Ring2& hole : footprint_.outline.holes)
        if (find(hole)) return edge;
    return kNoIndex;
}

/// Every face becomes a component of the root: x along its lowest edge, z its normal. It runs the rule of its kind,
/// from the import that the start rule comes from; without one it is a plain surface.
void Interpreter::runGivenFaces(const Rule& start, Frame& root, const ShapeState& lot)
{
    const size_t dot = program_.names[start.name].rfind('.');
    const std::string prefix = dot == std::string::npos ? "" : program_.names[start.name].substr(0, dot + 1);
    const glm::dvec2 corner = footprintCorner(footprint_);
    size_t edgeCount = footprint_.outline.outer.size();
    for (const Ring2& hole : footprint_.outline.holes) edgeCount += hole.size();
    for (const GivenFace& given : footprint_.faces) {
        if (trouble_.failed()) return;
        trouble_.spend(start.place, given.polygon.outer.size() + edgeCount);
        Face face;
        bool inRange = true;
        const auto convert = [&](const Ring3& ring) {
            Ring3 result;
            for (const glm::dvec3& p : ring) {
                result.emplace_back(p.x - corner.x, p.z - footprint_.base, corner.y - p.y);
                for (int k = 0; k < 3; ++k) inRange = inRange && std::abs(result.back()[k]) < kMaxCoordinate;
            }
            return result;
        };
        face.polygon.outer = convert(given.polygon.outer);
        for (const Ring3& hole : given.polygon.holes) face.polygon.holes.push_back(convert(hole));
        Ring3& outer = face.polygon.outer;
        // A number is used up for a face that is left out, too: keys of the others must not hang on it.
        if (!inRange || outer.size() < 3 || !(area(face.polygon) > 1e-6)) {
            ++root.childCount;
            continue;
        }
        const size_t lowest = lowestEdge(outer);
        std::rotate(outer.begin(), outer.begin() + std::ptrdiff_t(lowest), outer.end());
        face.xAxis = outer[1] - outer[0];
        if (std::abs(unitNormal(face.polygon).y) < 0.2) face.edge = edgeUnder(outer[0], outer[1]);

        ShapeState state = lot;
        auto [scope, geometry] = faceShape(Scope{}, face);
        state.scope = scope;
        state.pivot = scope.origin;
        state.pivotAxes = scope.axes;
        state.geometry = std::make_shared<const Geometry>(std::move(geometry));
        state.footprint = false;
        state.intact = true;
        state.edge = face.edge;
        state.tile = std::make_shared<const Tile>(Tile{scope, state.geometry, area(*state.geometry), true});

        const std::string name = prefix + std::string(ruleOf(given.kind));
        Statement call;
        call.kind = StatementKind::Rule;
        call.place = start.place;
        if (const auto rule = program_.ruleIndex.find({name, 0}); rule != program_.ruleIndex.end()) {
            call.rule = rule->second;
            call.name = program_.rules[rule->second].name;
        } else {
            trouble_.warn(start.place, concat("rule '", name, "' is not declared: given surfaces of this kind ",
                                              given.kind == GivenKind::Ground ? "are left out" : "stay plain"));
            if (given.kind == GivenKind::Ground) {
                ++root.childCount;
                continue;
            }
            call.name = u32(program_.names.size()) +
                        u32(given.kind == GivenKind::Wall ? OperationName::WallSurface : OperationName::RoofSurface);
            state.look.material = given.kind == GivenKind::Wall ? "render" : "clay_tiles";
        }
        spawnRule(call, state, root, ShapeOp::Component, {});
    }
}

} // namespace helio::cga
