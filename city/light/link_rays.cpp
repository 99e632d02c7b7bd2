// SPDX-License-Identifier: Apache-2.0
#include "city/light/link_rays.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "city/base/check.h"
#include "city/base/hash.h"
#include "city/light/cosine_directions.h"
#include "city/light/sequence.h"

namespace helio {
namespace {

constexpr u32 kEnoughRays = 512;    // of one pair, however strong its link
constexpr double kNearFactor = 0.1; // form factor from which on rays are aimed by the cosine

} // namespace

LinkRays::LinkRays(const NodeTree& tree, const Visibility& visibility, const Occluders& occluders, u64 seed)
    : tree_(tree), visibility_(visibility), occluders_(occluders), seed_(seed), plates_(tree.nodeCount())
{
    constexpr double kFilled = 1e-3; // share of the outline that may be missing
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        const std::span<const Ring3> rings = tree.outlineOf(i);
        if (rings.size() != 1 || rings[0].size() != 4) continue;
        const Ring3& r = rings[0];
        const glm::dvec3 side = r[1] - r[0], up = r[3] - r[0];
        const double size = glm::length(side) + glm::length(up), area = glm::length(glm::cross(side, up));
        if (glm::distance(r[2], r[0] + side + up) > 1e-6 * size) continue;
        if (std::abs(tree.nodes[i].area / area - 1.0) > kFilled) continue;
        plates_[i] = {r[0], side, up};
    }
}

glm::dvec3 LinkRays::pointIn(u32 node, double u, double v) const
{
    const Plate& plate = plates_[node];
    if (plate.side != glm::dvec3(0.0)) return plate.corner + u * plate.side + v * plate.up;
    while (!tree_.isLeaf(node)) {
        double rest = u * tree_.nodes[node].area;
        const std::span<const u32> children = tree_.childrenOf(node);
        u32 c = 0;
        while (c + 1 < children.size() && rest >= tree_.nodes[children[c]].area)
            rest -= tree_.nodes[children[c++]].area;
        node = children[c];
        u = std::min(rest / tree_.nodes[node].area, 0x1.fffffffffffffp-1);
    }
    return visibility_.pointOnPatch(node, u, v);
}

void LinkRays::block(std::span<const glm::dvec3> from, const glm::dvec3& fromNormal, std::span<const glm::dvec3> to,
                     const glm::dvec3& toNormal, Between between, std::span<bool> blocked) const
{
    if (between.known)
        occluders_.block(between.nodes, from, to, blocked);
    else
        visibility_.areBlocked(from, fromNormal, to, toNormal, blocked);
}

void LinkRays::shoot(std::span<const u32> from, std::span<const u32> to, u32 first, Between between,
                     std::span<RayFate> fate) const
{
    HELIO_CHECK(from.size() == to.size() && from.size() == fate.size() && from.size() <= kMostRays, from.size(), ", ",
                to.size(), ", ", fate.size(), " rays");
    if (from.empty()) return;
    const glm::dvec3 &na = tree_.nodes[from[0]].normal, &nb = tree_.nodes[to[0]].normal;
    const std::array<u32, 4> shift = digitalShift(mixSeed(mixSeed(seed_, from[0]), to[0]));
    std::array<glm::dvec3, kMostRays> a, b;
    std::array<bool, kMostRays> blocked;
    std::array<u32, kMostRays> ray;
    u32 count = 0;
    for (u32 k = 0; k < from.size(); ++k) {
        fate[k] = RayFate::Missed;
        const std::array<double, 4> x = shiftedSobol4(first + k, shift);
        a[count] = pointIn(from[k], x[0], x[1]);
        b[count] = pointIn(to[k], x[2], x[3]);
        const glm::dvec3 d = b[count] - a[count];
        if (glm::dot(na, d) <= 0.0 || glm::dot(nb, d) >= 0.0) continue;
        ray[count++] = k;
    }
    block(std::span(a).first(count), na, std::span(b).first(count), nb, between, std::span(blocked).first(count));
    for (u32 k = 0; k < count; ++k) fate[ray[k]] = blocked[k] ? RayFate::Blocked : RayFate::Open;
}

void LinkRays::shootFar(Tally& tally, u32 a, u32 b, const std::array<u32, 4>& shift, u32 rays, Between between) const
{
    const glm::dvec3 &na = tree_.nodes[a].normal, &nb = tree_.nodes[b].normal;
    std::array<glm::dvec3, kMostRays> p, q;
    std::array<double, kMostRays> kernel;
    std::array<bool, kMostRays> blocked;
    u32 count = 0;
    for (const u32 end = tally.next + rays; tally.next < end; ++tally.next) {
        const std::array<double, 4> x = shiftedSobol4(tally.next, shift);
        p[count] = pointIn(a, x[0], x[1]);
        q[count] = pointIn(b, x[2], x[3]);
        const glm::dvec3 d = q[count] - p[count];
        const double ca = glm::dot(na, d), cb = -glm::dot(nb, d), d2 = glm::dot(d, d);
        if (ca <= 0.0 || cb <= 0.0) continue;
        kernel[count++] = ca * cb / (d2 * d2);
    }
    block(std::span(p).first(count), na, std::span(q).first(count), nb, between, std::span(blocked).first(count));
    for (u32 k = 0; k < count; ++k) {
        ++tally.rays;
        tally.weight += kernel[k];
        if (!blocked[k]) tally.open += kernel[k];
    }
}

void LinkRays::shootNear(Tally& tally, u32 small, u32 large, const std::array<u32, 4>& shift, u32 rays,
                         Between between) const
{
    // Points that are uniform on both would seldom be near each other, yet near points exchange most: directions by the
    // cosine from the smaller one find them. All that reach the larger one's outline count alike.
    const glm::dvec3 &normal = tree_.nodes[small].normal, &other = tree_.nodes[large].normal,
                     &onPlane = tree_.nodes[large].centroid;
    const PlaneFrame frame = planeFrame(normal);
    std::array<glm::dvec3, kMostRays> p, q;
    std::array<bool, kMostRays> blocked;
    u32 count = 0;
    for (u32 tries = u32(2.0 * double(rays) / kNearFactor); tries > 0 && count < rays; --tries, ++tally.next) {
        const std::array<double, 4> x = shiftedSobol4(tally.next, shift);
        const glm::dvec3 direction = cosineDirection(frame, x[0], x[1]);
        const double facing = -glm::dot(other, direction);
        if (facing <= 0.0) continue;
        p[count] = pointIn(small, x[2], x[3]);
        const double height = glm::dot(other, p[count] - onPlane);
        if (height <= 0.0) continue;
        q[count] = p[count] + height / facing * direction;
        if (isInside(q[count], tree_.outlineOf(large), other)) ++count;
    }
    block(std::span(p).first(count), normal, std::span(q).first(count), other, between,
          std::span(blocked).first(count));
    for (u32 k = 0; k < count; ++k) {
        ++tally.rays;
        tally.weight += 1.0;
        if (!blocked[k]) tally.open += 1.0;
    }
}

OpenShare LinkRays::openShare(u32 a, u32 b, double transfer, u32 rays, double strength, const KnownRays& known,
                              Between between) const
{
    const std::array<u32, 4> shift = digitalShift(mixSeed(mixSeed(seed_, a), b));
    const bool swap = tree_.nodes[b].area < tree_.nodes[a].area;
    const u32 small = swap ? b : a, large = swap ? a : b;
    const bool near = transfer > kNearFactor * tree_.nodes[small].area;
    Tally tally;
    for (u32 asked = 0;;) {
        const u32 batch = std::min(std::max(asked, rays), kMostRays); // doubles the number, as far as one batch holds
        if (near)
            shootNear(tally, small, large, shift, batch, between);
        else
            shootFar(tally, a, b, shift, batch, between);
        asked += batch;
        const double open = tally.weight > 0.0 ? tally.open / tally.weight : 0.0;
        const u32 agreeing = open >= 1.0 ? known.open : open <= 0.0 ? known.blocked : 0;
        const double n = double(tally.rays + agreeing) + 2.0;
        const bool enough = tally.rays > 0 && strength * (open * (1.0 - open) / n + 1.0 / (n * n)) <= 1.0;
        if (enough || asked >= kEnoughRays) return {open, tally.rays};
    }
}

} // namespace helio
