// SPDX-License-Identifier: Apache-2.0
#include "city/light/occluders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "city/base/check.h"
#include "city/base/lanes.h"
#include "city/light/filled_nodes.h"
#include "city/light/sky.h"

namespace helio {
namespace {

constexpr float kFar = std::numeric_limits<float>::max();

/// Rectangle around rings in the plane of a node.
Ring3 rectangleAround(std::span<const Ring3> rings, const Node& node)
{
    const PlaneFrame frame = planeFrame(node.normal);
    glm::dvec2 low(std::numeric_limits<double>::max()), high(-low);
    for (const Ring3& ring : rings) {
        for (const glm::dvec3& corner : ring) {
            const glm::dvec3 d = corner - node.centroid;
            low = glm::min(low, {glm::dot(frame.u, d), glm::dot(frame.v, d)});
            high = glm::max(high, {glm::dot(frame.u, d), glm::dot(frame.v, d)});
        }
    }
    const auto at = [&](double x, double y) { return node.centroid + x * frame.u + y * frame.v; };
    return {at(low.x, low.y), at(high.x, low.y), at(high.x, high.y), at(low.x, high.y)};
}

} // namespace

/// A convex body around two nodes, and the nodes.
struct Occluders::Shaft
{
    std::array<Bound, 2 * kFilledCorners + 2> sides;
    u32 count = 0;
    u32 rootA = 0, rootB = 0;
    float slack = 0.0f; // m: how far beyond the sides patches of the nodes may lie
    std::array<std::span<const glm::vec3>, 2> ends;
};

Occluders::Occluders(const NodeTree& tree, const Visibility& visibility)
    : tree_(tree), tolerance_(float(visibility.lift())), origin_(visibility.origin()), polygons_(tree.nodeCount()),
      root_(planarRoots(tree))
{
    const std::vector<double> offPlane = distanceOffPlane(tree);
    std::vector<u32> roots;
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        if (tree.nodes[i].kind == NodeKind::Cluster) continue;
        addPolygon(i, visibility);
        polygons_[i].slack = float(offPlane[i]);
        if (root_[i] == i) roots.push_back(i);
    }
    if (!roots.empty()) build(roots);
}

void Occluders::addEdges(std::span<const glm::dvec3> corners, const glm::dvec3& normal)
{
    for (size_t k = 0; k < corners.size(); ++k) {
        const glm::dvec3 edge = corners[k + 1 < corners.size() ? k + 1 : 0] - corners[k],
                         out = glm::normalize(glm::cross(edge, normal));
        edges_.push_back({glm::vec3(out), float(glm::dot(out, corners[k]))});
    }
}

void Occluders::addPolygon(u32 i, const Visibility& visibility)
{
    const Node& node = tree_.nodes[i];
    const bool filled = visibility.isFilled(i);
    Polygon& polygon = polygons_[i];
    polygon.plane = {glm::vec3(node.normal), float(glm::dot(node.normal, node.centroid - origin_))};
    Ring3 corners = filled ? withoutStraightCorners(tree_.outlineOf(i)[0]) : rectangleAround(tree_.outlineOf(i), node);
    for (glm::dvec3& corner : corners) corner -= origin_;
    polygon.begin = u32(corners_.size());
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    polygon.end = u32(corners_.size());
    polygon.edgeBegin = u32(edges_.size());
    addEdges(corners, node.normal);

    polygon.pieceBegin = u32(pieces_.size());
    if (filled) {
        pieces_.push_back({polygon.edgeBegin, u32(edges_.size())});
    } else if (tree_.isLeaf(i)) {
        const std::span<const glm::vec3> triangles = visibility.trianglesOf(i);
        for (size_t t = 0; t < triangles.size(); t += 3) {
            const std::array<glm::dvec3, 3> triangle{triangles[t], triangles[t + 1], triangles[t + 2]};
            const glm::dvec3 area = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
            if (!(glm::dot(area, node.normal) > 0.0)) continue; // rounded to a line
            const u32 begin = u32(edges_.size());
            addEdges(triangle, node.normal);
            pieces_.push_back({begin, u32(edges_.size())});
        }
    }
    polygon.pieceEnd = u32(pieces_.size());
}

void Occluders::build(std::span<u32> roots)
{
    const size_t at = branches_.size();
    branches_.emplace_back();
    glm::vec3 low(kFar), high(-kFar);
    for (const u32 root : roots) {
        for (const glm::vec3& corner : cornersOf(root)) {
            low = glm::min(low, corner - polygons_[root].slack);
            high = glm::max(high, corner + polygons_[root].slack);
        }
    }
    branches_[at].low = low;
    branches_[at].high = high;
    if (roots.size() == 1) {
        branches_[at].node = roots[0];
    } else {
        const glm::vec3 size = high - low;
        const glm::length_t axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
        const auto place = [&](u32 root) { return std::pair(tree_.nodes[root].centroid[axis], root); };
        const size_t half = roots.size() / 2;
        std::nth_element(roots.begin(), roots.begin() + std::ptrdiff_t(half), roots.end(),
                         [&](u32 i, u32 j) { return place(i) < place(j); });
        build(roots.first(half));
        build(roots.subspan(half));
    }
    branches_[at].next = u32(branches_.size());
}

void Occluders::addSides(Shaft& shaft, u32 node, std::span<const glm::vec3> others) const
{
    const Polygon& own = polygons_[node];
    std::array<float, kFilledCorners> height; // above the node
    bool behind = false;
    for (size_t k = 0; k < others.size(); ++k) {
        height[k] = glm::dot(own.plane.normal, others[k]) - own.plane.offset;
        behind = behind || height[k] < -tolerance_;
    }
    for (u32 k = 0; k < own.end - own.begin; ++k) {
        const auto& [normal, offset] = edges_[own.edgeBegin + k];
        // The plane through this edge that leans out as far as the other polygon does. None if that one reaches past
        // the edge where it stands in or crosses the plane of the node.
        float lean = -kFar;
        bool open = false;
        for (size_t other = 0; other < others.size() && !open; ++other) {
            const float out = glm::dot(normal, others[other]) - offset;
            open = out > tolerance_ && (behind || height[other] <= tolerance_);
            if (height[other] > tolerance_) lean = std::max(lean, out / height[other]);
        }
        if (open || lean == -kFar) continue;
        const float length = std::sqrt(1.0f + lean * lean);
        const glm::vec3 n = (normal - lean * own.plane.normal) / length;
        shaft.sides[shaft.count++] = {n, (offset - lean * own.plane.offset) / length};
    }
}

Occluders::Shaft Occluders::shaftOf(u32 a, u32 b) const
{
    Shaft shaft;
    shaft.rootA = root_[a];
    shaft.rootB = root_[b];
    shaft.slack = std::max(polygons_[a].slack, polygons_[b].slack);
    shaft.ends = {cornersOf(a), cornersOf(b)};
    for (const u32 node : {a, b}) {
        const Bound& plane = polygons_[node].plane; // what is behind a node does not count
        shaft.sides[shaft.count++] = {-plane.normal, -plane.offset};
    }
    addSides(shaft, a, cornersOf(b));
    addSides(shaft, b, cornersOf(a));
    return shaft;
}

bool Occluders::reachesInto(u32 node, const Shaft& shaft) const
{
    const Bound& plane = polygons_[node].plane;
    float low = kFar, high = -kFar;
    for (const std::span<const glm::vec3> end : shaft.ends) {
        for (const glm::vec3& corner : end) {
            const float height = glm::dot(plane.normal, corner) - plane.offset;
            low = std::min(low, height);
            high = std::max(high, height);
        }
    }
    const float margin = shaft.slack + polygons_[node].slack - tolerance_;
    if (low >= margin || high <= -margin) return false; // both ends on one side of it
    for (u32 k = 0; k < shaft.count; ++k) {
        const Bound& side = shaft.sides[k];
        float lowest = kFar;
        for (const glm::vec3& corner : cornersOf(node)) lowest = std::min(lowest, glm::dot(side.normal, corner));
        if (lowest >= side.offset + margin) return false;
    }
    return true;
}

void Occluders::sift(u32 node, const Shaft& shaft, std::vector<u32>& found) const
{
    if (node == shaft.rootA || node == shaft.rootB || !reachesInto(node, shaft)) return;
    if (tree_.isLeaf(node) || polygons_[node].pieceBegin < polygons_[node].pieceEnd)
        found.push_back(node);
    else
        for (const u32 child : tree_.childrenOf(node)) sift(child, shaft, found);
}

bool Occluders::find(u32 a, u32 b, size_t most, std::vector<u32>& found) const
{
    const Shaft shaft = shaftOf(a, b);
    const size_t begin = found.size();
    for (u32 k = 0; k < branches_.size();) {
        const Branch& branch = branches_[k];
        bool outside = false;
        for (u32 i = 0; i < shaft.count && !outside; ++i) {
            const Bound& side = shaft.sides[i];
            const glm::vec3 lowest(side.normal.x > 0.0f ? branch.low.x : branch.high.x,
                                   side.normal.y > 0.0f ? branch.low.y : branch.high.y,
                                   side.normal.z > 0.0f ? branch.low.z : branch.high.z);
            outside = glm::dot(side.normal, lowest) >= side.offset + shaft.slack - tolerance_;
        }
        if (!outside && branch.node != kNoIndex) {
            sift(branch.node, shaft, found);
            if (found.size() - begin > most) {
                found.resize(begin + most);
                return false;
            }
        }
        k = outside ? branch.next : k + 1;
    }
    return true;
}

void Occluders::narrow(u32 a, u32 b, size_t begin, size_t end, std::vector<u32>& found) const
{
    if (begin == end) return;
    const Shaft shaft = shaftOf(a, b);
    for (size_t k = begin; k < end; ++k) {
        const u32 node = found[k]; // sift() may move the list
        sift(node, shaft, found);
    }
}

HELIO_LANES void Occluders::block(std::span<const u32> nodes, std::span<const glm::dvec3> from,
                                  std::span<const glm::dvec3> to, std::span<bool> blocked) const
{
    HELIO_CHECK(to.size() == from.size() && blocked.size() == from.size(), from.size(), " and ", to.size(), " ends, ",
                blocked.size(), " places");
    for (size_t first = 0; first < from.size(); first += kLanes) {
        const size_t count = std::min(size_t(kLanes), from.size() - first);
        Row8 start[3]{}, way[3]{};
        for (size_t k = 0; k < count; ++k) {
            const glm::dvec3 &p = from[first + k], &q = to[first + k];
            for (glm::length_t axis = 0; axis < 3; ++axis) {
                start[axis][k] = float(p[axis] - origin_[axis]);
                way[axis][k] = float(q[axis] - p[axis]);
            }
        }
        Float8 x, y, z, dx, dy, dz, nearest = Float8{} + kFar;
        load(x, start[0]);
        load(y, start[1]);
        load(z, start[2]);
        load(dx, way[0]);
        load(dy, way[1]);
        load(dz, way[2]);
        const Float8 zero{}, one = zero + 1.0f, far = zero + kFar;
        for (const u32 node : nodes) {
            const Polygon& polygon = polygons_[node];
            const glm::vec3& n = polygon.plane.normal;
            const Float8 height = n.x * x + n.y * y + n.z * z - polygon.plane.offset;
            const Float8 rise = n.x * dx + n.y * dy + n.z * dz, end = height + rise;
            const Float8 t = -height / (rise == zero ? one : rise);
            const Float8 px = x + t * dx, py = y + t * dy, pz = z + t * dz;
            // How far outside a piece; both ends on one side of the plane: not met.
            const Float8 unmet = height * end < zero ? -far : far;
            for (u32 piece = polygon.pieceBegin; piece < polygon.pieceEnd; ++piece) {
                Float8 outside = unmet;
                for (u32 e = pieces_[piece].begin; e < pieces_[piece].end; ++e) {
                    const glm::vec3& m = edges_[e].normal;
                    const Float8 above = m.x * px + m.y * py + m.z * pz - edges_[e].offset;
                    outside = above > outside ? above : outside; // what is no number does not count
                }
                nearest = outside < nearest ? outside : nearest;
            }
        }
        for (size_t k = 0; k < count; ++k) blocked[first + k] = nearest[k] <= 0.0f;
    }
}

} // namespace helio
