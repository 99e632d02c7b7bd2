// SPDX-License-Identifier: Apache-2.0
// The roof operations of Interpreter: a closed roof over each face of the shape.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "city/geometry/roof.h"
#include "city/grammar/interpreter.h"
#include "city/grammar/pieces.h"

namespace helio::cga {

namespace {

constexpr size_t kMaxNotes = 8; ///< a building: one bad footprint must not fill the log

/// What the arguments of a roof operation say.
struct RoofRequest
{
    Operation op = Operation::RoofHip;
    RoofPitch pitch;
    double overhangX = 0.0, overhangY = 0.0; ///< m on the slopes: beyond the eaves, and beyond the gables
    bool even = false;
    std::optional<i64> index;
};

Roof buildRoof(const RoofRequest& request, const Polygon2& base, const RoofPitch& pitch, double eaves, double gables)
{
    const i64 edges = i64(base.outer.size()), index = request.index.value_or(0);
    const u32 edge = u32(((index % edges) + edges) % edges);
    switch (request.op) {
    case Operation::RoofGable:
        return gableRoof(base, pitch, eaves, gables, request.even, request.index ? edge : kNoIndex);
    case Operation::RoofShed:
        return shedRoof(base, pitch, edge);
    case Operation::RoofPyramid:
        return pyramidRoof(base, pitch);
    default:
        return hipRoof(base, pitch, eaves);
    }
}

/// Steepness of a roof's slopes in degrees; 0 if it has none.
double slopeOf(const Roof& roof)
{
    for (const RoofFace& face : roof.faces)
        if (face.part == RoofPart::Slope)
            return std::acos(std::clamp(unitNormal(face.polygon).z, 0.0, 1.0)) * 180.0 / M_PI;
    return 0.0;
}

/// A pyramid of this height above the centroid; downwards if `height` < 0. Where not all of the base sees the centroid,
/// and above holes, what pyramidRoof makes of it.
Roof taperRoof(const Polygon2& base, double height)
{
    const Ring2& ring = base.outer;
    glm::dvec2 sum(0.0);
    const double whole = signedArea(ring);
    for (size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
        sum += (a + b) * cross(a, b) / 6.0;
    }
    const glm::dvec2 apex = ring[0] + sum / whole;
    bool seen = base.holes.empty();
    for (size_t i = 0; i < ring.size() && seen; ++i) {
        const glm::dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
        seen = cross(a, b, apex) > 0.01 * glm::distance(a, b);
    }
    Roof roof;
    if (seen) {
        RoofFace bottom;
        bottom.part = RoofPart::Bottom;
        for (u32 i = 0; i < ring.size(); ++i) {
            const glm::dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
            roof.faces.push_back(
                {{{{a.x, a.y, 0.0}, {b.x, b.y, 0.0}, {apex.x, apex.y, std::abs(height)}}, {}}, RoofPart::Slope, i});
            bottom.polygon.outer.insert(bottom.polygon.outer.begin(), {a.x, a.y, 0.0});
        }
        roof.faces.push_back(std::move(bottom));
    } else {
        roof = pyramidRoof(base, {true, std::abs(height)});
    }
    if (height > 0.0) return roof;
    const auto flip = [](Ring3& corners) {
        for (glm::dvec3& p : corners) p.z = -p.z;
        std::reverse(corners.begin(), corners.end());
    };
    for (RoofFace& face : roof.faces) {
        flip(face.polygon.outer);
        for (Ring3& hole : face.polygon.holes) flip(hole);
    }
    return roof;
}

/// The language measures overhangs down the slope, the geometry level.
Roof buildRoof(const RoofRequest& request, const Polygon2& base)
{
    RoofPitch pitch = request.pitch;
    if (request.op == Operation::Taper) return taperRoof(base, pitch.value);
    if (request.overhangX == 0.0 && request.overhangY == 0.0) return buildRoof(request, base, pitch, 0.0, 0.0);
    if (pitch.byHeight) {
        // The slope is that of the roof without overhangs.
        const Roof plain = buildRoof(request, base, pitch, 0.0, 0.0);
        const double slope = slopeOf(plain);
        if (!(slope > 0.0)) return plain;
        pitch = {false, slope};
    }
    const double level = request.overhangX * std::cos(pitch.value * M_PI / 180.0);
    return buildRoof(request, base, pitch, level, request.overhangY);
}

} // namespace

void Interpreter::roof(const Statement& statement, ShapeState& state, Frame& frame)
{
    if (!needsFaces(statement, state)) return;
    RoofRequest request;
    request.op = statement.op;
    const size_t argCount = statement.args.size();
    const auto number = [&](size_t k) { return evaluator_.number(statement.args[k].value, env(state, frame)); };
    const bool taper = statement.op == Operation::Taper;
    request.pitch = {taper || statement.mode == kByHeight, number(0)};
    if (statement.op == Operation::RoofShed) {
        if (argCount > 1) request.index = i64(std::clamp(number(1), -1e6, 1e6));
    } else {
        if (argCount > 1) request.overhangX = request.overhangY = number(1);
        size_t next = 2;
        if (statement.op == Operation::RoofGable && argCount > next) request.overhangY = number(next++);
        if (argCount > next) request.even = evaluator_.truth(statement.args[next++].value, env(state, frame));
        if (argCount > next) request.index = i64(std::clamp(number(next), -1e6, 1e6));
    }
    if (trouble_.failed()) return;
    if (request.overhangX < 0.0 || request.overhangY < 0.0) {
        trouble_.warn(statement.place, "a roof's overhang below 0 counts as 0");
        request.overhangX = std::max(0.0, request.overhangX);
        request.overhangY = std::max(0.0, request.overhangY);
    }
    const double value = taper ? std::abs(request.pitch.value) : request.pitch.value;
    if (!(value > 0.0) || (!request.pitch.byHeight && !(value < 90.0)))
        return trouble_.warn(statement.place,
                             request.pitch.byHeight
                                 ? "a roof or taper without height leaves the shape flat"
                                 : "a roof needs an angle between 0 and 90 degrees: the shape stays flat");
    if (request.even && statement.op == Operation::RoofHip)
        trouble_.warn(statement.place, "an even hip would have faces that are not planar: its ridges stay as they are");
    if (!(value < kMaxCoordinate && request.overhangX < kMaxCoordinate && request.overhangY < kMaxCoordinate))
        return trouble_.fail(statement.place, concat("the shape grows beyond ", kMaxCoordinate, " m"));

    Geometry solid;
    solid.closed = true;
    glm::dvec3 first(0.0);
    for (const Face& original : state.geometry->faces) {
        const Face face = numberedFace(original, state.footprint);
        const auto plane = FacePlane::of(face);
        if (!plane) continue;
        const size_t corners = face.polygon.outer.size();
        trouble_.spend(statement.place, planeWork(face));
        const Roof built = buildRoof(request, plane->flat(face.polygon));
        if (built.faces.empty()) continue;
        if (first == glm::dvec3(0.0)) first = plane->normal();
        if (!taper) ++result_.roofs.roofs;
        if (built.fallback != RoofFallback::None) {
            ++(built.fallback == RoofFallback::Flat ? result_.roofs.flat : result_.roofs.parts);
            if (result_.notes.size() < kMaxNotes)
                result_.notes.push_back(concat(
                    "building '", footprint_.id, "': ", program_.names[statement.name],
                    built.fallback == RoofFallback::Flat ? " stays flat: " : " is a simpler roof: ", built.reason));
        }
        for (const RoofFace& part : built.faces) {
            Face raised;
            const auto lift = [&](const Ring3& ring) {
                Ring3 result;
                for (const glm::dvec3& p : ring) result.push_back(plane->raise({p.x, p.y}, p.z));
                return result;
            };
            raised.polygon.outer = lift(part.polygon.outer);
            for (const Ring3& hole : part.polygon.holes) raised.polygon.holes.push_back(lift(hole));
            raised.xAxis = glm::normalize(raised.polygon.outer[1] - raised.polygon.outer[0]);
            if (part.edge < face.edges.size()) raised.edge = face.edges[part.edge];
            raised.outer = part.edge == kNoIndex || part.edge < corners;
            solid.faces.push_back(std::move(raised));
        }
    }
    if (solid.faces.empty()) return;
    trouble_.spend(statement.place, cornerCount(solid));

    // y becomes the direction in which the first roof rises; x stays as far as it can.
    const glm::dvec3 y = state.scope.axes * first;
    glm::dvec3 x = state.scope.axes[0] - y * glm::dot(y, state.scope.axes[0]);
    if (glm::length(x) < 1e-6) x = state.scope.axes[2] - y * glm::dot(y, state.scope.axes[2]);
    x = glm::normalize(x);
    turnScope(state.scope, solid, glm::dmat3(x, y, glm::cross(x, y)));
    state.geometry = std::make_shared<const Geometry>(std::move(solid));
    state.tile = nullptr;
    state.intact = state.footprint = false;
    checkSize(state, statement.place);
}

} // namespace helio::cga
