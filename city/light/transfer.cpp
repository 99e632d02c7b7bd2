// SPDX-License-Identifier: Apache-2.0
#include "city/light/transfer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>

namespace helio {
namespace {

constexpr double kPointDistance = 30.0;    // in sums of radii: one point each is right to 1e-3
constexpr double kFourPointDistance = 3.0; // four points each are right to 1e-3

/// Integral of x x^T over a node's own rings, x relative to `centre`, m4.
glm::dmat3 secondMoment(std::span<const Ring3> rings, const glm::dvec3& centre, const glm::dvec3& normal)
{
    glm::dmat3 sum(0.0);
    for (const Ring3& ring : rings) {
        for (size_t i = 1; i + 1 < ring.size(); ++i) {
            const glm::dvec3 a = ring[0] - centre, b = ring[i] - centre, c = ring[i + 1] - centre, s = a + b + c;
            const double twice = glm::dot(normal, glm::cross(b - a, c - a));
            sum +=
                twice / 24.0 *
                (glm::outerProduct(a, a) + glm::outerProduct(b, b) + glm::outerProduct(c, c) + glm::outerProduct(s, s));
        }
    }
    return sum;
}

} // namespace

Transfer::Transfer(const NodeTree& tree) : tree_(tree), extent_(tree.nodeCount())
{
    std::vector<glm::dmat3> moment(tree.nodeCount(), glm::dmat3(0.0));
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        const Node& node = tree.nodes[i];
        if (node.kind == NodeKind::Cluster) continue;
        double radius = 0.0;
        for (const Ring3& ring : tree.outlineOf(i))
            for (const glm::dvec3& corner : ring) radius = std::max(radius, glm::distance(corner, node.centroid));
        extent_[i].radius = float(radius);
        if (tree.isLeaf(i)) {
            moment[i] = secondMoment(tree.outlineOf(i), node.centroid, node.normal);
        } else {
            for (const u32 child : tree.childrenOf(i)) {
                const glm::dvec3 d = tree.nodes[child].centroid - node.centroid;
                moment[i] += moment[child] + tree.nodes[child].area * glm::outerProduct(d, d);
            }
        }
        const PlaneFrame frame = planeFrame(node.normal);
        const double uu = glm::dot(frame.u, moment[i] * frame.u) / node.area,
                     vv = glm::dot(frame.v, moment[i] * frame.v) / node.area,
                     uv = glm::dot(frame.u, moment[i] * frame.v) / node.area;
        const double angle = 0.5 * std::atan2(2.0 * uv, uu - vv), half = std::hypot(0.5 * (uu - vv), uv),
                     mean = 0.5 * (uu + vv);
        const glm::dvec3 e1 = std::cos(angle) * frame.u + std::sin(angle) * frame.v;
        extent_[i].axis[0] = std::sqrt(std::max(0.0, mean + half)) * e1;
        extent_[i].axis[1] = std::sqrt(std::max(0.0, mean - half)) * glm::cross(node.normal, e1);
    }
}

PlanarShape Transfer::shapeOf(u32 node) const
{
    const Node& n = tree_.nodes[node];
    return {tree_.outlineOf(node), n.normal, n.centroid, n.area / n.coverage, double(extent_[node].radius)};
}

bool Transfer::faceEachOther(u32 a, u32 b) const
{
    const Node &na = tree_.nodes[a], &nb = tree_.nodes[b];
    const glm::dvec3 d = nb.centroid - na.centroid;
    return glm::dot(na.normal, d) > -radius(b) && glm::dot(nb.normal, d) < radius(a);
}

double Transfer::between(u32 a, u32 b) const
{
    const Node &na = tree_.nodes[a], &nb = tree_.nodes[b];
    const Extent &ea = extent_[a], &eb = extent_[b];
    const glm::dvec3 d = nb.centroid - na.centroid;
    const double ra = double(ea.radius), rb = double(eb.radius);
    // Heights of the centroids before each other's planes.
    const double hb = glm::dot(na.normal, d), ha = -glm::dot(nb.normal, d);
    if (hb <= -rb || ha <= -ra) return 0.0;
    const double distance = glm::length(d), size = ra + rb;
    // Half heights of rectangles with these moments. What crosses the other's plane by less is at grazing angles.
    const auto halfHeight = [](const Extent& e, const glm::dvec3& n) {
        return std::numbers::sqrt3 *
               (std::abs(glm::dot(glm::dvec3(e.axis[0]), n)) + std::abs(glm::dot(glm::dvec3(e.axis[1]), n)));
    };
    const bool crosses = hb < 0.99 * halfHeight(eb, na.normal) || ha < 0.99 * halfHeight(ea, nb.normal);
    if (crosses || distance < kFourPointDistance * size)
        return exchange(shapeOf(a), shapeOf(b)) * na.coverage * nb.coverage;
    const double scale = na.area * nb.area / std::numbers::pi;
    if (distance > kPointDistance * size)
        return scale * std::max(0.0, ha) * std::max(0.0, hb) / (distance * distance * distance * distance);
    double sum = 0.0;
    const glm::dvec3 aPlus(ea.axis[0] + ea.axis[1]), aMinus(ea.axis[0] - ea.axis[1]);
    const glm::dvec3 bPlus(eb.axis[0] + eb.axis[1]), bMinus(eb.axis[0] - eb.axis[1]);
    const std::array<glm::dvec3, 4> pa{aPlus, -aPlus, aMinus, -aMinus}, pb{bPlus, -bPlus, bMinus, -bMinus};
    for (const glm::dvec3& x : pa) {
        for (const glm::dvec3& y : pb) {
            const glm::dvec3 r = d + y - x;
            const double r2 = glm::dot(r, r);
            sum += std::max(0.0, glm::dot(na.normal, r)) * std::max(0.0, -glm::dot(nb.normal, r)) / (r2 * r2);
        }
    }
    return scale * sum / 16.0;
}

} // namespace helio
