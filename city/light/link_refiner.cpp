// SPDX-License-Identifier: Apache-2.0
#include "city/light/link_refiner.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "city/base/hash.h"
#include "city/light/sequence.h"

namespace helio {
namespace {

// Shares of the worst case that turned out to be typical (scenes S and M of the reference set).
constexpr double kWholeLinkError = 0.3;   // of the power of a link: its error if nothing is known about its inside
constexpr double kInsidePartError = 0.1;  // of a part's variance: what the parts do not resolve
constexpr double kVisibilityError = 0.1;  // of the variance that few rays leave
constexpr double kSurelyTooCoarse = 30.0; // tolerances: power x (size / distance)^2 that no link was ever accepted with
constexpr double kFarDistance = 1.5;      // in sums of radii: from here on the factor varies little over both nodes
constexpr double kNearFactor = 0.1;       // form factor from which on rays are aimed by the cosine
constexpr u32 kMaxRaysPerCell = 64;

double squaredRatio(double a, double b)
{
    return b > 0.0 ? std::min(1.0, a * a / (b * b)) : 1.0;
}

/// Even-odd test in the coordinate plane that the polygon's plane is nearest to.
bool isInside(const glm::dvec3& point, std::span<const Ring3> rings, const glm::dvec3& normal)
{
    const glm::dvec3 n = glm::abs(normal);
    const glm::length_t u = n.x >= n.y && n.x >= n.z ? 1 : 0, v = n.z > n.x && n.z > n.y ? 1 : 2;
    bool inside = false;
    for (const Ring3& ring : rings) {
        for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
            const glm::dvec3 &a = ring[i], &b = ring[j];
            if ((a[v] > point[v]) != (b[v] > point[v]) &&
                point[u] < a[u] + (point[v] - a[v]) / (b[v] - a[v]) * (b[u] - a[u]))
                inside = !inside;
        }
    }
    return inside;
}

} // namespace

LinkRefiner::Parts LinkRefiner::partsOf(u32 node) const
{
    Parts parts{{node}, 1};
    while (true) {
        // The largest part that can be opened; gaps count as size, for a full outline is what the factors are exact
        // for.
        u32 best = kNoIndex;
        double bestArea = 0.0;
        for (u32 i = 0; i < parts.count; ++i) {
            const Node& n = tree_.nodes[parts.node[i]];
            if (n.childCount == 0 || parts.count - 1 + n.childCount > kMaxParts) continue;
            const double size = n.area / (n.coverage * n.coverage);
            if (size > bestArea) {
                bestArea = size;
                best = i;
            }
        }
        if (best == kNoIndex) return parts;
        const std::span<const u32> children = tree_.childrenOf(parts.node[best]);
        parts.node[best] = children[0];
        for (u32 c = 1; c < children.size(); ++c) parts.node[parts.count++] = children[c];
    }
}

glm::dvec3 LinkRefiner::pointIn(u32 node, double u, double v) const
{
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

void LinkRefiner::shoot(Cell& cell, u32 a, u32 b, u32 rays) const
{
    const std::array<u32, 4> shift = digitalShift(mixSeed(mixSeed(limits_.seed, a), b));
    const bool swap = tree_.nodes[b].area < tree_.nodes[a].area;
    const u32 small = swap ? b : a, large = swap ? a : b;
    if (cell.transfer > kNearFactor * tree_.nodes[small].area) {
        shootNear(cell, small, large, shift, rays);
        return;
    }
    const glm::dvec3 &na = tree_.nodes[a].normal, &nb = tree_.nodes[b].normal;
    for (const u32 end = cell.next + rays; cell.next < end; ++cell.next) {
        const std::array<double, 4> x = shiftedSobol4(cell.next, shift);
        const glm::dvec3 p = pointIn(a, x[0], x[1]), q = pointIn(b, x[2], x[3]), d = q - p;
        const double ca = glm::dot(na, d), cb = -glm::dot(nb, d), d2 = glm::dot(d, d);
        if (ca <= 0.0 || cb <= 0.0) continue;
        const double kernel = ca * cb / (d2 * d2);
        ++cell.rays;
        cell.weight += kernel;
        if (!visibility_.isBlocked(p, na, q, nb)) cell.open += kernel;
    }
}

void LinkRefiner::shootNear(Cell& cell, u32 small, u32 large, const std::array<u32, 4>& shift, u32 rays) const
{
    // Points that are uniform on both would seldom be near each other, yet near points exchange most: directions by the
    // cosine from the smaller one find them. All that reach the larger one's outline count alike.
    const glm::dvec3 &normal = tree_.nodes[small].normal, &other = tree_.nodes[large].normal,
                     &onPlane = tree_.nodes[large].centroid;
    const PlaneFrame frame = planeFrame(normal);
    const u32 end = cell.rays + rays;
    for (u32 tries = u32(2.0 * double(rays) / kNearFactor); tries > 0 && cell.rays < end; --tries, ++cell.next) {
        const std::array<double, 4> x = shiftedSobol4(cell.next, shift);
        const double r = std::sqrt(x[0]), phi = 2.0 * std::numbers::pi * x[1];
        const glm::dvec3 direction =
            r * std::cos(phi) * frame.u + r * std::sin(phi) * frame.v + std::sqrt(1.0 - x[0]) * normal;
        const double facing = -glm::dot(other, direction);
        if (facing <= 0.0) continue;
        const glm::dvec3 p = pointIn(small, x[2], x[3]);
        const double height = glm::dot(other, p - onPlane);
        if (height <= 0.0) continue;
        const glm::dvec3 q = p + height / facing * direction;
        if (!isInside(q, tree_.outlineOf(large), other)) continue;
        ++cell.rays;
        cell.weight += 1.0;
        if (!visibility_.isBlocked(p, normal, q, other)) cell.open += 1.0;
    }
}

double LinkRefiner::power(u32 a, u32 b, double exchange) const
{
    const double squared = exchange * exchange;
    return squared * (double(training_.power[b]) * weight_[a] / tree_.nodes[a].area +
                      double(training_.power[a]) * weight_[b] / tree_.nodes[b].area);
}

void LinkRefiner::link(u32 a, u32 b, double exchange)
{
    if (exchange > 0.0) pairs_.push_back({a, b, float(exchange)});
}

void LinkRefiner::addErrors(const Parts& mine, const Parts& theirs, u32 receiver, u32 sender, bool mineIsA,
                            double meanOpen, double& senderError, double& receiverError) const
{
    const auto cellOf = [&](u32 i, u32 j) -> const Cell& {
        return cells_[mineIsA ? i * kMaxParts + j : j * kMaxParts + i];
    };
    // Few rays a cell: its visibility is drawn towards the mean by one ray's worth.
    const auto seen = [&](const Cell& cell) {
        const double own = cell.weight > 0.0 ? cell.open / cell.weight : meanOpen;
        return (own * double(cell.rays) + meanOpen) / double(cell.rays + 1);
    };
    const u32 lights = training_.lightCount;
    const std::span<const float> senderMean = training_.of(sender);
    double total = 0.0;
    std::array<double, kMaxParts> received{};
    for (u32 i = 0; i < mine.count; ++i) {
        const double area = tree_.nodes[mine.node[i]].area, weight = weight_[mine.node[i]];
        std::array<double, kMaxParts> g{};
        for (u32 j = 0; j < theirs.count; ++j) {
            const Cell& cell = cellOf(i, j);
            if (cell.transfer <= 0.0) continue;
            const double open = seen(cell);
            g[j] = cell.transfer * open;
            received[i] += g[j];
            const double inside = kInsidePartError * double(training_.variance[theirs.node[j]]);
            if (inside > 0.0) {
                const double distance =
                    glm::distance(tree_.nodes[mine.node[i]].centroid, tree_.nodes[theirs.node[j]].centroid);
                const double partial = 0.25 * 4.0 * open * (1.0 - open);
                senderError += weight * inside * g[j] * g[j] / area *
                               (squaredRatio(transfer_.radius(theirs.node[j]), distance) + partial);
            }
        }
        total += received[i];
        double squares = 0.0;
        for (u32 l = 0; l < lights && theirs.count > 1; ++l) {
            double difference = 0.0;
            for (u32 j = 0; j < theirs.count; ++j)
                difference += g[j] * double(training_.of(theirs.node[j])[l] - senderMean[l]);
            squares += difference * difference;
        }
        senderError += weight * squares / (double(lights) * area);
    }
    const double mean = total / tree_.nodes[receiver].area;
    for (u32 i = 0; i < mine.count && mine.count > 1; ++i) {
        const double area = tree_.nodes[mine.node[i]].area, difference = received[i] / area - mean;
        receiverError += weight_[mine.node[i]] * area * difference * difference * double(training_.power[sender]);
    }
}

LinkRefiner::Estimate LinkRefiner::estimate(const Parts& a, const Parts& b, u32 nodeA, u32 nodeB) const
{
    Estimate e;
    double transfer = 0.0, seen = 0.0, unseen = 0.0;
    u32 rays = 0;
    for (u32 i = 0; i < a.count; ++i) {
        for (u32 j = 0; j < b.count; ++j) {
            const Cell& cell = cells_[i * kMaxParts + j];
            transfer += cell.transfer;
            rays += cell.rays;
            if (cell.weight > 0.0)
                seen += cell.transfer * cell.open / cell.weight;
            else
                unseen += cell.transfer;
        }
    }
    if (transfer <= 0.0) return e;
    // Cells without a usable ray take the mean of the others; without any ray at all the pair counts as open.
    const double meanOpen = transfer > unseen ? seen / (transfer - unseen) : 1.0;
    e.exchange = meanOpen * transfer;
    addErrors(a, b, nodeA, nodeB, true, meanOpen, e.errorB, e.errorA);
    addErrors(b, a, nodeB, nodeA, false, meanOpen, e.errorA, e.errorB);
    const double n = double(rays) + 2.0;
    e.visibilityError = power(nodeA, nodeB, transfer) * (meanOpen * (1.0 - meanOpen) / n + 1.0 / (n * n));
    return e;
}

bool LinkRefiner::isSurelyTooCoarse(u32 a, u32 b, double transfer) const
{
    const double ra = tree_.isLeaf(a) ? 0.0 : transfer_.radius(a), rb = tree_.isLeaf(b) ? 0.0 : transfer_.radius(b);
    const double distance = glm::distance(tree_.nodes[a].centroid, tree_.nodes[b].centroid);
    if (power(a, b, transfer) * squaredRatio(std::max(ra, rb), distance) <= kSurelyTooCoarse * limits_.tolerance)
        return false;
    // Only a pair that sees something: what is blocked is better judged as a whole.
    Cell cell;
    cell.transfer = transfer;
    shoot(cell, a, b, limits_.raysPerPart);
    return cell.open > 0.0;
}

void LinkRefiner::refine(u32 nodeA, u32 nodeB)
{
    ++evaluated_;
    const double whole = transfer_.between(nodeA, nodeB);
    if (whole <= 0.0) return;
    const bool leaves = tree_.isLeaf(nodeA) && tree_.isLeaf(nodeB);
    // Only between nodes that are far apart does the whole exchange say how large its parts can be.
    const double reach = kFarDistance * (transfer_.radius(nodeA) + transfer_.radius(nodeB));
    const bool faint = kWholeLinkError * power(nodeA, nodeB, whole) <= limits_.tolerance &&
                       glm::distance(tree_.nodes[nodeA].centroid, tree_.nodes[nodeB].centroid) > reach;
    if (leaves || faint) {
        Cell cell;
        cell.transfer = whole;
        const double strength = kVisibilityError * power(nodeA, nodeB, whole);
        for (u32 asked = 0;;) {
            const u32 batch = std::max(asked, limits_.raysPerPart); // doubles the number
            shoot(cell, nodeA, nodeB, batch);
            asked += batch;
            const double open = cell.weight > 0.0 ? cell.open / cell.weight : 1.0, n = double(cell.rays) + 2.0;
            if (asked >= kMaxRaysPerCell || strength * (open * (1.0 - open) / n + 1.0 / (n * n)) <= limits_.tolerance) {
                link(nodeA, nodeB, whole * open);
                return;
            }
        }
    }

    if (isSurelyTooCoarse(nodeA, nodeB, whole)) {
        const bool larger = transfer_.radius(nodeA) >= transfer_.radius(nodeB);
        split(nodeA, nodeB, tree_.isLeaf(nodeB) || (!tree_.isLeaf(nodeA) && larger));
        return;
    }
    const Parts a = partsOf(nodeA), b = partsOf(nodeB);
    // A node with more children than fit cannot be judged from its parts: it is opened unseen.
    const bool wideA = a.count == 1 && !tree_.isLeaf(nodeA), wideB = b.count == 1 && !tree_.isLeaf(nodeB);
    if (wideA || wideB) {
        split(nodeA, nodeB, wideA);
        return;
    }
    const auto shootAll = [&](u32 rays) {
        for (u32 i = 0; i < a.count; ++i)
            for (u32 j = 0; j < b.count; ++j)
                if (Cell& cell = cells_[i * kMaxParts + j]; cell.transfer > 0.0)
                    shoot(cell, a.node[i], b.node[j], rays);
    };
    for (u32 i = 0; i < a.count; ++i) {
        for (u32 j = 0; j < b.count; ++j) {
            Cell& cell = cells_[i * kMaxParts + j] = Cell();
            cell.transfer = transfer_.between(a.node[i], b.node[j]);
        }
    }
    shootAll(1);
    Estimate e = estimate(a, b, nodeA, nodeB);
    if (e.errorA + e.errorB + kVisibilityError * e.visibilityError <= limits_.tolerance) {
        // Good enough to be a link: the remaining rays sharpen its visibility where that is mixed.
        if (e.visibilityError > limits_.tolerance && limits_.raysPerPart > 1) {
            shootAll(limits_.raysPerPart - 1);
            e = estimate(a, b, nodeA, nodeB);
        }
        if (e.errorA + e.errorB + kVisibilityError * e.visibilityError <= limits_.tolerance) {
            link(nodeA, nodeB, e.exchange);
            return;
        }
    }
    // Halving the larger one helps the later levels more than the errors of this one say.
    bool splitA = e.errorA * transfer_.radius(nodeA) > e.errorB * transfer_.radius(nodeB);
    if (kVisibilityError * e.visibilityError > e.errorA + e.errorB)
        splitA = tree_.nodes[nodeA].area >= tree_.nodes[nodeB].area;
    if (tree_.isLeaf(nodeA)) splitA = false;
    if (tree_.isLeaf(nodeB)) splitA = true;
    split(nodeA, nodeB, splitA);
}

void LinkRefiner::split(u32 nodeA, u32 nodeB, bool splitA)
{
    if (splitA) {
        for (const u32 child : tree_.childrenOf(nodeA)) refine(child, nodeB);
    } else {
        for (const u32 child : tree_.childrenOf(nodeB)) refine(nodeA, child);
    }
}

} // namespace helio
