// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/grammar_solid_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <optional>

#include "city/base/check.h"
#include "city/model/triangulate.h"

namespace helio::test {
namespace {

using Loop = std::vector<glm::dvec3>;

/// What of a convex or simple loop lies in n.p + d >= inset (Sutherland and Hodgman).
Loop clipped(const Loop& loop, const glm::dvec4& plane, double inset)
{
    Loop result;
    for (size_t k = 0; k < loop.size(); ++k) {
        const glm::dvec3 &a = loop[k], &b = loop[(k + 1) % loop.size()];
        const double da = glm::dot(glm::dvec3(plane), a) + plane.w - inset,
                     db = glm::dot(glm::dvec3(plane), b) + plane.w - inset;
        if (da >= 0) result.push_back(a);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) result.push_back(a + (b - a) * (da / (da - db)));
    }
    return result;
}

std::vector<std::array<glm::dvec3, 3>> trianglesOf(const Polygon3& polygon)
{
    std::vector<glm::dvec3> corners = polygon.outer;
    for (const Ring3& hole : polygon.holes) corners.insert(corners.end(), hole.begin(), hole.end());
    std::vector<std::array<glm::dvec3, 3>> triangles;
    for (const auto& t : triangulate(polygon)) triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
    return triangles;
}

/// Where a line meets a triangle, in units of `direction`.
std::optional<double> hit(const std::array<glm::dvec3, 3>& t, const glm::dvec3& origin, const glm::dvec3& direction)
{
    const glm::dvec3 e1 = t[1] - t[0], e2 = t[2] - t[0], p = glm::cross(direction, e2);
    const double det = glm::dot(e1, p);
    if (std::abs(det) < 1e-12) return {};
    const glm::dvec3 s = origin - t[0], q = glm::cross(s, e1);
    const double u = glm::dot(s, p) / det, v = glm::dot(direction, q) / det;
    if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9) return {}; // an edge belongs to both its triangles
    return glm::dot(e2, q) / det;
}

/// Corner `index` of the unit cube: one bit an axis.
glm::dvec3 unitCorner(int index)
{
    return {index & 1, (index >> 1) & 1, (index >> 2) & 1};
}

} // namespace

std::string SolidBox::where() const
{
    return concat(low.x, " ", low.y, " ", low.z, " to ", high.x, " ", high.y, " ", high.z);
}

std::vector<SolidBox> assetBoxes(const ShapeTree& tree,
                                 const std::function<Result<AssetBox>(const std::string&)>& assetBox)
{
    // Sides of the unit cube, counter-clockwise from outside: -x, +x, -y, +y, -z, +z.
    static constexpr int kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    std::vector<SolidBox> boxes;
    for (u32 k = 0; k < tree.shapes.size(); ++k) {
        const Shape& shape = tree.shapes[k];
        if (shape.asset == kNoIndex) continue;
        const Result<AssetBox> own = assetBox(tree.assets[shape.asset]);
        HELIO_CHECK(own.ok(), tree.assets[shape.asset]);
        SolidBox box;
        box.what = concat(tree.assets[shape.asset], " ", treeKey(tree, k));
        box.shape = k;
        glm::dvec3 corners[8];
        box.low = glm::dvec3(INFINITY);
        box.high = glm::dvec3(-INFINITY);
        for (int c = 0; c < 8; ++c) {
            corners[c] = shape.worldFromAsset * glm::dvec4(glm::mix(own->min, own->max, unitCorner(c)), 1.0);
            box.low = glm::min(box.low, corners[c]);
            box.high = glm::max(box.high, corners[c]);
        }
        const glm::dvec3 middle = 0.5 * (corners[0] + corners[7]);
        for (const auto& side : kSides) {
            const glm::dvec3 &a = corners[side[0]], &b = corners[side[1]], &c = corners[side[3]];
            glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
            if (glm::dot(normal, middle - a) < 0) normal = -normal;
            box.planes.emplace_back(normal, -glm::dot(normal, a));
            box.sides.push_back({a, b, corners[side[2]], c});
        }
        for (u32 t = 0; t < shape.trimCount; ++t) box.planes.push_back(tree.trimPlanes[shape.trimBegin + t]);
        boxes.push_back(std::move(box));
    }
    return boxes;
}

bool touches(const SolidBox& box, const ShapeTree& tree, double reach)
{
    const auto farFrom = [&](const Polygon3& polygon) {
        for (int axis = 0; axis < 3; ++axis) {
            double low = INFINITY, high = -INFINITY;
            for (const glm::dvec3& p : polygon.outer) {
                low = std::min(low, p[axis]);
                high = std::max(high, p[axis]);
            }
            if (low > box.high[axis] + reach || high < box.low[axis] - reach) return true;
        }
        return false;
    };
    for (u32 k = 0; k < tree.shapes.size(); ++k) {
        if (k == box.shape) continue;
        const Shape& shape = tree.shapes[k];
        for (u32 p = 0; p < shape.polygonCount; ++p)
            if (!farFrom(tree.polygons[shape.polygonBegin + p]))
                for (const auto& triangle : trianglesOf(tree.polygons[shape.polygonBegin + p])) {
                    Loop loop(triangle.begin(), triangle.end());
                    for (const glm::dvec4& plane : box.planes) loop = clipped(loop, plane, -reach);
                    if (!loop.empty()) return true;
                }
    }
    return false;
}

bool overlap(const SolidBox& a, const SolidBox& b, double depth)
{
    for (int k = 0; k < 3; ++k)
        if (a.low[k] > b.high[k] - depth || b.low[k] > a.high[k] - depth) return false;
    // The region where both are deeper than half of it: it has a side on a plane of one of them.
    for (const auto& [solid, other] : {std::pair(&a, &b), std::pair(&b, &a)})
        for (size_t s = 0; s < solid->sides.size(); ++s) {
            Loop loop = solid->sides[s];
            for (glm::dvec3& p : loop) p += 0.5 * depth * glm::dvec3(solid->planes[s]);
            for (size_t k = 0; k < solid->planes.size(); ++k)
                if (k != s) loop = clipped(loop, solid->planes[k], 0.5 * depth);
            for (const glm::dvec4& plane : other->planes) loop = clipped(loop, plane, 0.5 * depth);
            if (!loop.empty()) return true;
        }
    return false;
}

bool liesOnALeaf(const ShapeTree& tree, const glm::dvec3& point, const glm::dvec3& normal)
{
    const glm::dvec3 n = glm::normalize(normal);
    for (const Polygon3& polygon : tree.polygons) {
        if (glm::dot(glm::normalize(vectorArea(polygon)), n) < 0.9999) continue;
        if (std::abs(glm::dot(n, point - polygon.outer[0])) > 1e-4) continue;
        for (const auto& triangle : trianglesOf(polygon))
            if (hit(triangle, point, n)) return true;
    }
    return false;
}

namespace {

constexpr double kPartDepth = 0.5; // m: how far parts stand out of their walls

bool inPush(const ShapeTree& tree, u32 shape)
{
    for (; shape != kNoIndex; shape = tree.shapes[shape].parent)
        if (tree.shapes[shape].op == ShapeOp::Group) return true;
    return false;
}

} // namespace

std::string leavesThatSeeABack(const ShapeTree& tree)
{
    struct Target
    {
        std::array<glm::dvec3, 3> corners;
        glm::dvec3 normal;
        u32 shape;
    };
    std::vector<Target> targets;
    for (u32 k = 0; k < tree.shapes.size(); ++k)
        for (u32 p = 0; p < tree.shapes[k].polygonCount; ++p) {
            const Polygon3& polygon = tree.polygons[tree.shapes[k].polygonBegin + p];
            for (const auto& triangle : trianglesOf(polygon))
                targets.push_back({triangle, glm::normalize(vectorArea(polygon)), k});
        }
    std::string wrong;
    for (const Target& from : targets) {
        const auto& c = from.corners;
        if (glm::length(glm::cross(c[1] - c[0], c[2] - c[0])) < 2e-3) continue;
        const glm::dvec3 origin = (c[0] + c[1] + c[2]) / 3.0;
        double nearest = INFINITY;
        const Target* seen = nullptr;
        for (const Target& to : targets) {
            if (&to == &from) continue;
            const auto distance = hit(to.corners, origin, from.normal);
            // What lies on the leaf and faces it hides it.
            const bool front = glm::dot(to.normal, from.normal) < 0;
            if (distance && *distance > (front ? -1e-6 : 1e-6) && *distance < nearest) {
                nearest = *distance;
                seen = &to;
            }
        }
        // A part that stands on the leaf without a side of its own there (a fin, made in a push) hides what is under
        // it.
        if (seen != nullptr && nearest < kPartDepth && inPush(tree, seen->shape) && !inPush(tree, from.shape)) continue;
        if (seen != nullptr && glm::dot(seen->normal, from.normal) > 0)
            wrong += concat(tree.names[tree.shapes[from.shape].name], " ", treeKey(tree, from.shape), " at ", origin.x,
                            " ", origin.y, " ", origin.z, " sees the back of ", treeKey(tree, seen->shape), "\n");
        if (wrong.size() > 600) break;
    }
    return wrong;
}

size_t openEdges(const ShapeTree& tree, const Shape& shape)
{
    using Key = std::array<i64, 6>;
    std::map<Key, int> edges;
    const auto add = [&](const Ring3& ring) {
        for (size_t k = 0; k < ring.size(); ++k) {
            Key forward{}, backward{};
            for (int axis = 0; axis < 3; ++axis) {
                const i64 a = std::llround(ring[k][axis] * 1e4),
                          b = std::llround(ring[(k + 1) % ring.size()][axis] * 1e4);
                forward[size_t(axis)] = backward[size_t(axis) + 3] = a;
                forward[size_t(axis) + 3] = backward[size_t(axis)] = b;
            }
            ++edges[forward];
            edges[backward] += 1000;
        }
    };
    for (u32 p = 0; p < shape.polygonCount; ++p) {
        const Polygon3& polygon = tree.polygons[shape.polygonBegin + p];
        add(polygon.outer);
        for (const Ring3& hole : polygon.holes) add(hole);
    }
    return size_t(std::count_if(edges.begin(), edges.end(), [](const auto& edge) { return edge.second != 1001; }));
}

} // namespace helio::test
