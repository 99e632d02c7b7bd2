// SPDX-License-Identifier: Apache-2.0
// The operations of Interpreter that fit the scope to other axes around unmoved geometry.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "city/grammar/interpreter.h"
#include "city/model/convex_hull.h"

namespace helio::cga {

namespace {

constexpr double kTie = 1e-9; ///< m: what differs by less is equal, and the first one is taken

/// Right-handed axes with axis k along `main` and another one as near as it can be to one of the present axes.
glm::dmat3 axesAlong(int k, const glm::dvec3& main, const glm::dmat3& present)
{
    const auto across = [&](const glm::dvec3& v) { return v - main * glm::dot(v, main); };
    glm::dvec3 other = across(present[k == 0 ? 2 : 0]);
    if (glm::length(other) < 1e-6) other = -across(present[1]);
    other = glm::normalize(other);
    if (k == 0) return glm::dmat3(main, glm::cross(other, main), other);
    if (k == 1) return glm::dmat3(other, main, glm::cross(other, main));
    return glm::dmat3(other, glm::cross(main, other), main);
}

/// An edge of a face: its two ends in world coordinates.
struct Edge
{
    u32 face = 0;
    glm::dvec3 begin{0.0}, end{0.0};
};

std::vector<Edge> edgesOf(const ShapeState& state)
{
    std::vector<Edge> edges;
    for (u32 face = 0; face < state.geometry->faces.size(); ++face) {
        const auto add = [&](const Ring3& ring) {
            for (size_t k = 0; k < ring.size(); ++k)
                edges.push_back({face, state.scope.toWorld(ring[k]), state.scope.toWorld(ring[(k + 1) % ring.size()])});
        };
        const Polygon3& polygon = state.geometry->faces[face].polygon;
        add(polygon.outer);
        for (const Ring3& hole : polygon.holes) add(hole);
    }
    return edges;
}

/// Index of the largest value; the first one where several are equal within kTie.
template <class Measure> size_t best(size_t count, const Measure& measure)
{
    size_t chosen = 0;
    double most = -INFINITY;
    for (size_t k = 0; k < count; ++k)
        if (const double value = measure(k); value > most + kTie) {
            most = value;
            chosen = k;
        }
    return chosen;
}

/// A number that counts from the end where it is negative.
size_t wrapped(double index, size_t count)
{
    const double n = double(count), rest = std::fmod(std::floor(index), n);
    return size_t(rest < 0.0 ? rest + n : rest);
}

} // namespace

/// alignScopeToAxes(): all axes as the world's. alignScopeToAxes(y): one of them, the others turned as little as
/// possible; object.y and the like: those of the lot.
void Interpreter::alignToAxes(const Statement& statement, ShapeState& state)
{
    if (refuseAfterInsert(statement, state)) return;
    const glm::dmat3 system = statement.mode & kObjectAxes ? objectAxes_ : glm::dmat3(1.0);
    const int axis = int(statement.mode & 3u) - 1;
    turnAround(statement, state, axis < 0 ? system : axesAlong(axis, system[axis], state.scope.axes), true);
}

/// alignScopeToGeometry(yUp | zUp, face, edge): x along an edge, the up axis along the normal of its face.
void Interpreter::alignToGeometry(const Statement& statement, ShapeState& state, Frame& frame)
{
    std::vector<double> numbers;
    for (const Size& arg : statement.args) numbers.push_back(evaluator_.number(arg.value, env(state, frame)));
    if (trouble_.failed() || refuseAfterInsert(statement, state)) return;
    std::vector<Edge> edges = edgesOf(state);
    trouble_.spend(statement.place, edges.size());
    const auto facePick = FacePick((statement.mode >> 1) & 3u);
    const auto edgePick = EdgePick(statement.mode >> 3);
    const auto& faces = state.geometry->faces;
    if (edges.empty()) return;
    if (facePick != FacePick::Any) {
        const auto height = [&](size_t k) {
            double sum = 0.0;
            for (const glm::dvec3& p : faces[k].polygon.outer) sum += state.scope.toWorld(p).y;
            return -sum / double(faces[k].polygon.outer.size());
        };
        const size_t face = facePick == FacePick::Number ? wrapped(numbers[0], faces.size())
                            : facePick == FacePick::Largest
                                ? best(faces.size(), [&](size_t k) { return area(faces[k].polygon); })
                                : best(faces.size(), height);
        std::erase_if(edges, [&](const Edge& edge) { return edge.face != face; });
    }
    if (edges.empty()) return;
    const size_t chosen =
        edgePick == EdgePick::Number ? wrapped(numbers.back(), edges.size())
        : edgePick == EdgePick::Longest
            ? best(edges.size(), [&](size_t k) { return glm::distance(edges[k].begin, edges[k].end); })
            : best(edges.size(), [&](size_t k) { return -edges[k].begin.y - edges[k].end.y; });
    const glm::dvec3 along = edges[chosen].end - edges[chosen].begin;
    glm::dvec3 up = state.scope.axes * unitNormal(faces[edges[chosen].face].polygon);
    if (glm::length(along) < kTie || glm::length(up) < 0.5)
        return trouble_.warn(statement.place,
                             "alignScopeToGeometry found an edge without length or a face without area, "
                             "and leaves the scope as it is");
    const glm::dvec3 x = glm::normalize(along);
    up = glm::normalize(up - x * glm::dot(x, up));
    const glm::dvec3 third = glm::cross(x, up);
    turnAround(statement, state, statement.mode & kZUp ? glm::dmat3(x, -third, up) : glm::dmat3(x, up, third), true);
}

/// alignScopeToGeometryBBox(xz): the smallest rectangle around the geometry as seen along the third axis, which stays;
/// the first of the two axes becomes the longer side.
void Interpreter::alignToBounds(const Statement& statement, ShapeState& state)
{
    if (refuseAfterInsert(statement, state)) return;
    static constexpr int kAxes[6][2] = {{0, 1}, {1, 0}, {0, 2}, {2, 0}, {1, 2}, {2, 1}};
    const int first = kAxes[statement.mode][0], second = kAxes[statement.mode][1], third = 3 - first - second;
    std::vector<glm::dvec2> points;
    for (const Face& face : state.geometry->faces)
        for (const glm::dvec3& p : face.polygon.outer) points.emplace_back(p[first], p[second]);
    const Ring2 hull = convexHull(points);
    trouble_.spend(statement.place, points.size() + hull.size() * hull.size());
    if (hull.size() < 3 || trouble_.failed()) return;
    double least = INFINITY;
    glm::dvec2 longer(1.0, 0.0);
    for (size_t k = 0; k < hull.size(); ++k) {
        // A side of the smallest rectangle lies on an edge of the hull (Freeman and Shapira 1975).
        const glm::dvec2 u = glm::normalize(hull[(k + 1) % hull.size()] - hull[k]), v(-u.y, u.x);
        glm::dvec2 low(INFINITY), high(-INFINITY);
        for (const glm::dvec2& p : hull) {
            const glm::dvec2 q(glm::dot(p, u), glm::dot(p, v));
            low = glm::min(low, q);
            high = glm::max(high, q);
        }
        const glm::dvec2 size = high - low;
        if (size.x * size.y >= least - kTie) continue;
        least = size.x * size.y;
        longer = size.x >= size.y ? u : v;
    }
    // Of the two directions, the one nearer to the present axis.
    if (longer.x < 0.0 || (longer.x == 0.0 && longer.y < 0.0)) longer = -longer;
    glm::dmat3 turn(1.0);
    turn[first] = turn[second] = glm::dvec3(0.0);
    turn[first][first] = longer.x;
    turn[first][second] = longer.y;
    turn[second][first] = -longer.y;
    turn[second][second] = longer.x;
    turn[third][third] = 1.0;
    turnAround(statement, state, state.scope.axes * turn, true);
}

} // namespace helio::cga
