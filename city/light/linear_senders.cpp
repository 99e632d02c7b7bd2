// SPDX-License-Identifier: Apache-2.0
#include "city/light/linear_senders.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace helio {
namespace {

constexpr double kFlat = 1e-5;      // of the other direction's spread: patches in a row
constexpr double kPointLike = 1e-6; // m: patches in one place

/// Unit vectors along the principal directions of the patches below a node, with their standard deviations, m.
struct Principal
{
    glm::dvec3 e1{0.0}, e2{0.0};
    double s1 = 0.0, s2 = 0.0;
};

Principal principalOf(const PlaneFrame& frame, double uu, double vv, double uv)
{
    const double angle = 0.5 * std::atan2(2.0 * uv, uu - vv), half = std::hypot(0.5 * (uu - vv), uv),
                 mean = 0.5 * (uu + vv);
    Principal p;
    p.e1 = std::cos(angle) * frame.u + std::sin(angle) * frame.v;
    p.e2 = glm::cross(frame.normal, p.e1);
    p.s1 = std::sqrt(std::max(0.0, mean + half));
    p.s2 = std::sqrt(std::max(0.0, mean - half));
    if (p.s1 < kPointLike) p.s1 = 0.0;
    if (p.s2 < std::max(kPointLike, kFlat * p.s1)) p.s2 = 0.0;
    return p;
}

} // namespace

std::vector<SlopeFrame> slopeFrames(const NodeTree& tree)
{
    // Covariance of the patch centroids below each node, upwards: children have smaller numbers.
    std::vector<glm::dmat3> covariance(tree.nodeCount(), glm::dmat3(0.0));
    std::vector<SlopeFrame> frames(tree.nodeCount());
    for (u32 i = tree.patchCount(); i < tree.nodeCount(); ++i) {
        const Node& node = tree.nodes[i];
        if (node.kind == NodeKind::Cluster) continue;
        for (const u32 child : tree.childrenOf(i)) {
            const glm::dvec3 d = tree.nodes[child].centroid - node.centroid;
            covariance[i] += tree.nodes[child].area / node.area * (covariance[child] + glm::outerProduct(d, d));
        }
        const PlaneFrame plane = planeFrame(node.normal);
        const auto moment = [&](const glm::dvec3& a, const glm::dvec3& b) { return glm::dot(a, covariance[i] * b); };
        const Principal p =
            principalOf(plane, moment(plane.u, plane.u), moment(plane.v, plane.v), moment(plane.u, plane.v));
        if (p.s1 > 0.0) frames[i].x = p.e1 / p.s1;
        if (p.s2 > 0.0) frames[i].y = p.e2 / p.s2;
    }
    return frames;
}

std::vector<gpu::ChildSlopeRecord> childSlopes(const NodeTree& tree, const std::vector<SlopeFrame>& frames)
{
    std::vector<gpu::ChildSlopeRecord> slopes(tree.children.size(), gpu::ChildSlopeRecord{});
    // A unit of a slope coordinate, m: the vector x / |x|^2 of a frame.
    const auto unit = [](const glm::dvec3& x) {
        const double square = glm::dot(x, x);
        return square > 0.0 ? x / square : glm::dvec3(0.0);
    };
    for (u32 i = tree.patchCount(); i < tree.nodeCount(); ++i) {
        const Node& node = tree.nodes[i];
        if (node.kind == NodeKind::Cluster) continue;
        for (u32 k = node.childBegin; k < node.childBegin + node.childCount; ++k) {
            const u32 child = tree.children[k];
            const glm::dvec2 offset = frames[i].at(tree.nodes[child].centroid - node.centroid),
                             ofX = frames[i].at(unit(frames[child].x)), ofY = frames[i].at(unit(frames[child].y));
            slopes[k] = {float(offset.x), float(offset.y), float(ofX.x), float(ofY.x), float(ofX.y), float(ofY.y)};
        }
    }
    return slopes;
}

} // namespace helio
