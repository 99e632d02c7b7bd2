// SPDX-License-Identifier: Apache-2.0
// The built-in functions of Evaluator that look at the current shape and at its neighbours.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <set>

#include "city/grammar/component.h"
#include "city/grammar/evaluator.h"

namespace helio::cga {

namespace {

/// A corner on a grid of a micrometre, so that faces that share one agree on it.
std::array<i64, 3> gridKey(const glm::dvec3& p)
{
    return {std::llround(p.x * 1e6), std::llround(p.y * 1e6), std::llround(p.z * 1e6)};
}

/// How often faces use an edge, in its direction and against it.
struct EdgeUse
{
    u32 with = 0, against = 0;
};

/// Visits every edge once, whatever number of faces shares it.
template <class Visit> void forEachEdge(const Geometry& geometry, const Visit& visit)
{
    struct Shared
    {
        glm::dvec3 a{0.0}, b{0.0};
        EdgeUse use;
    };
    std::map<std::pair<std::array<i64, 3>, std::array<i64, 3>>, Shared> edges;
    const auto add = [&](const Ring3& ring) {
        for (size_t k = 0; k < ring.size(); ++k) {
            const glm::dvec3 &a = ring[k], &b = ring[(k + 1) % ring.size()];
            const auto from = gridKey(a), to = gridKey(b);
            Shared& edge = edges[std::minmax(from, to)];
            edge.a = a;
            edge.b = b;
            ++(from < to ? edge.use.with : edge.use.against);
        }
    };
    for (const Face& face : geometry.faces) {
        add(face.polygon.outer);
        for (const Ring3& hole : face.polygon.holes) add(hole);
    }
    for (const auto& [key, edge] : edges) visit(edge.a, edge.b, edge.use);
}

} // namespace

Value Evaluator::callGeometry(const Expr& expr, const Env& env)
{
    const ShapeState& shape = *env.shape;
    const Geometry& geometry = *shape.geometry;
    trouble_.spend(expr.place, cornerCount(geometry));
    switch (Function(expr.index)) {
    case Function::GeometryArea: {
        if (expr.args.empty()) return area(geometry);
        const auto selector = Selector(expr.args[0].index);
        const SelectorFrame frame = frameOf(selector);
        const glm::dmat3 turn = frame == SelectorFrame::Scope ? glm::dmat3(1.0)
                                : frame == SelectorFrame::World
                                    ? shape.scope.axes
                                    : glm::transpose(initial_.scope.axes) * shape.scope.axes;
        double sum = 0.0;
        for (const Face& face : geometry.faces)
            if (selects(selector, turn * unitNormal(face.polygon))) sum += area(face.polygon);
        return sum;
    }
    case Function::GeometryBoundaryLength: {
        double sum = 0.0;
        forEachEdge(geometry, [&](const glm::dvec3& a, const glm::dvec3& b, EdgeUse use) {
            if (use.with + use.against == 1) sum += glm::distance(a, b);
        });
        return sum;
    }
    case Function::GeometryIsClosedSurface: {
        bool closed = !geometry.faces.empty();
        forEachEdge(geometry, [&](const glm::dvec3&, const glm::dvec3&, EdgeUse use) {
            closed = closed && use.with + use.against == 2;
        });
        return closed;
    }
    case Function::GeometryIsOriented: {
        bool oriented = true;
        forEachEdge(geometry, [&](const glm::dvec3&, const glm::dvec3&, EdgeUse use) {
            oriented = oriented && use.with <= 1 && use.against <= 1;
        });
        return oriented;
    }
    case Function::GeometryHeight: {
        double low = INFINITY, high = -INFINITY;
        for (const Face& face : geometry.faces)
            for (const glm::dvec3& p : face.polygon.outer) {
                const double y = shape.scope.toWorld(p).y;
                low = std::min(low, y);
                high = std::max(high, y);
            }
        return std::max(0.0, high - low);
    }
    case Function::GeometryIsConcave:
        return isConcave(geometry);
    case Function::GeometryIsPlanar:
        return isPlanar(geometry);
    case Function::GeometryIsRectangular:
        return isRectangular(geometry, expr.args.empty() ? 1.0 : number(expr.args[0], env));
    case Function::GeometryNEdges: {
        double count = 0.0;
        forEachEdge(geometry, [&](const glm::dvec3&, const glm::dvec3&, EdgeUse) { ++count; });
        return count;
    }
    case Function::GeometryNFaces:
        return double(geometry.faces.size());
    case Function::GeometryNHoles: {
        size_t count = 0;
        for (const Face& face : geometry.faces) count += face.polygon.holes.size();
        return double(count);
    }
    case Function::GeometryNVertices: {
        std::set<std::array<i64, 3>> corners;
        forEachEdge(geometry, [&](const glm::dvec3& a, const glm::dvec3& b, EdgeUse) {
            corners.insert(gridKey(a));
            corners.insert(gridKey(b));
        });
        return double(corners.size());
    }
    case Function::GeometryVolume:
        return volume(geometry);
    default:
        break;
    }
    HELIO_CHECK(false, "function ", expr.index);
}

/// touches(inter): a neighbour's wall stands against some of the shape. inside(inter): against all of it.
/// overlaps(inter): against a part of it.
Value Evaluator::callOcclusion(const Expr& expr, const Env& env)
{
    if (!occlusion_.any()) return false;
    const ShapeState& shape = *env.shape;
    trouble_.spend(expr.place, cornerCount(*shape.geometry) * occlusion_.wallCount());
    const bool inside = occlusion_.inside(shape.scope, *shape.geometry, shape.edge);
    switch (Function(expr.index)) {
    case Function::Inside:
        return inside;
    case Function::Overlaps:
        return !inside && occlusion_.touches(shape.scope, *shape.geometry, shape.edge);
    default:
        return inside || occlusion_.touches(shape.scope, *shape.geometry, shape.edge);
    }
}

} // namespace helio::cga
