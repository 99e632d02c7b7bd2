// SPDX-License-Identifier: Apache-2.0
#include "city/light/link_refiner.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "city/base/lanes.h"

namespace helio {
namespace {

constexpr u32 kParts = NodeParts::kMost;
// Shares of the worst case that turned out to be typical (scenes S and M of the reference set).
constexpr double kWholeLinkError = 0.3;  // of the power of a link: its error if nothing is known about its inside
constexpr double kVisibilityError = 0.1; // of the variance that few rays leave
constexpr double kSurelyTooCoarse =
    300.0;                              // tolerances: power x (size / distance)^2 that no link was ever accepted with
constexpr double kFarDistance = 1.5;    // in sums of radii: from here on the factor varies little over both nodes
constexpr float kExactDistance = 1.25f; // in sums of radii: nearer parts exchange what their outlines say
constexpr u32 kFirstRays = 16;          // of a pair of which nothing is known
constexpr u32 kKnown = 24;              // rays of the pairs above, all open or all blocked, after which few more do
constexpr u32 kFewRays = 2;
constexpr size_t kMostBetween = 256; // nodes that may stand between a pair; where there are more,
constexpr double kRetry = 0.5;       // they are looked for again when the pair has shrunk to this size
constexpr u32 kWholeRays = 8;        // of a link that is not judged by its parts

double squaredRatio(double a, double b)
{
    return b > 0.0 ? std::min(1.0, a * a / (b * b)) : 1.0;
}

} // namespace

const NodeParts& LinkRefiner::partsOf(u32 node)
{
    if (!s_.tree.isLeaf(node)) return s_.parts[node - s_.tree.patchCount()];
    if (leaf_.count == 0 || leaf_.node[0] != node) putLeaf(s_.tree, s_.transfer, s_.weight, node, leaf_);
    return leaf_;
}

double LinkRefiner::strength(u32 receiver, u32 sender, double exchange) const
{
    return exchange * exchange * double(s_.training.power[sender]) * s_.weight[receiver] / s_.tree.nodes[receiver].area;
}

void LinkRefiner::link(u32 direction, Directions directions, const NodeLink& link)
{
    if (!(link.factor > 0.0f)) return;
    if ((directions.fine & direction) != 0) links_.push_back(link);
    if ((directions.coarse & direction) != 0) coarseLinks_.push_back(link);
}

void LinkRefiner::weighNearParts(Pair& pair) const
{
    const NodeParts &a = *pair.partsA, &b = *pair.partsB;
    if (double(pair.distance) >
        (1.0 + double(kExactDistance)) * (s_.transfer.radius(pair.a) + s_.transfer.radius(pair.b)))
        return; // the parts are as far from each other
    const glm::vec3 between(s_.tree.nodes[pair.b].centroid - s_.tree.nodes[pair.a].centroid);
    pair.total = 0.0f;
    for (u32 i = 0; i < a.count; ++i) {
        for (u32 j = 0; j < b.count; ++j) {
            const glm::vec3 d = between + glm::vec3(b.x[j] - a.x[i], b.y[j] - a.y[i], b.z[j] - a.z[i]);
            const float reach = kExactDistance * (a.radius[i] + b.radius[j]);
            if (glm::dot(d, d) < reach * reach) {
                pair.exchange[i][j] = float(s_.transfer.between(a.node[i], b.node[j]));
                pair.touches = pair.touches || pair.exchange[i][j] > 0.0f;
            }
            pair.total += pair.exchange[i][j];
        }
    }
}

void LinkRefiner::look(Pair& pair, u32 rays, const Sight& sight) const
{
    const NodeParts &a = *pair.partsA, &b = *pair.partsB;
    std::array<u32, LinkRays::kMostRays> cell;
    u32 count = 0;
    const float step = rays > 0 ? pair.total / float(rays) : 0.0f;
    float upTo = 0.0f;
    for (u32 i = 0; i < a.count; ++i) {
        for (u32 j = 0; j < b.count; ++j) {
            const float part = pair.exchange[i][j];
            if (part <= 0.0f) continue;
            if (rays == 0) {
                cell[count++] = i * kParts + j;
                continue;
            }
            upTo += part;
            while (count < rays && (float(count) + 0.5f) * step <= upTo) cell[count++] = i * kParts + j;
        }
    }
    std::array<u32, LinkRays::kMostRays> from, to;
    std::array<RayFate, LinkRays::kMostRays> fate;
    for (u32 k = 0; k < count; ++k) {
        from[k] = a.node[cell[k] / kParts];
        to[k] = b.node[cell[k] % kParts];
    }
    s_.rays.shoot(std::span(from).first(count), std::span(to).first(count), pair.shot, betweenOf(sight),
                  std::span(fate).first(count));
    pair.shot += count;
    for (u32 k = 0; k < count; ++k) {
        if (fate[k] == RayFate::Missed) continue;
        ++pair.rays;
        pair.asked[cell[k] / kParts][cell[k] % kParts] += 1.0f;
        if (fate[k] == RayFate::Open) pair.seen[cell[k] / kParts][cell[k] % kParts] += 1.0f;
    }
    weighRays(pair, sight.rays);
}

HELIO_LANES void LinkRefiner::weighRays(Pair& pair, const KnownRays& above)
{
    NodeParts::Row rowSeen, rowAsked;
    Float8 columnSeen{}, columnAsked{}, row;
    for (u32 i = 0; i < kParts; ++i) {
        load(row, pair.seen[i]);
        columnSeen += row;
        rowSeen[i] = sumOf(row);
        load(row, pair.asked[i]);
        columnAsked += row;
        rowAsked[i] = sumOf(row);
    }
    const float seen = sumOf(columnSeen), asked = sumOf(columnAsked);
    const float mean = asked > 0.0f ? seen / asked : above.blocked > 0 ? 0.0f : 1.0f;
    if (mean <= 0.0f || mean >= 1.0f) {
        for (NodeParts::Row& open : pair.open) open.fill(mean);
        pair.mean = double(mean);
        return;
    }
    // A pair of parts sees what its own rays say, drawn by one ray's worth towards what its row and column say.
    const Float8 one = Float8{} + 1.0f, byColumn = (columnSeen + mean) / (columnAsked + 1.0f) / mean;
    double visible = 0.0;
    for (u32 i = 0; i < kParts; ++i) {
        Float8 ownSeen, ownAsked, exchange;
        load(ownSeen, pair.seen[i]);
        load(ownAsked, pair.asked[i]);
        load(exchange, pair.exchange[i]);
        const Float8 said = (rowSeen[i] + mean) / (rowAsked[i] + 1.0f) * byColumn, guess = said < one ? said : one;
        const Float8 open = (ownSeen + guess) / (ownAsked + 1.0f);
        store(pair.open[i], open);
        visible += double(sumOf(exchange * open));
    }
    pair.mean = visible / double(pair.total);
}

LinkRefiner::Sight LinkRefiner::sightOf(Pair& pair, const Sight& above)
{
    Sight sight = above;
    if (pair.rays > 0) {
        sight.rays = {};
        if (pair.mean >= 1.0) sight.rays.open = above.rays.open + pair.rays;
        if (pair.mean <= 0.0) sight.rays.blocked = above.rays.blocked + pair.rays;
    }
    pair.known = std::max(pair.rays, sight.known());
    return sight;
}

LinkRefiner::Verdict LinkRefiner::judge(const Pair& pair, bool toA) const
{
    const u32 receiver = toA ? pair.a : pair.b, sender = toA ? pair.b : pair.a;
    PartMatrix exchange;
    for (u32 i = 0; i < kParts; ++i) {
        Float8 whole, open;
        load(whole, pair.exchange[i]);
        load(open, pair.open[i]);
        store(exchange[i], whole * open);
    }
    const Training& training = s_.training;
    Verdict v;
    v.error = toA ? linkError(*pair.partsA, *pair.partsB, exchange, pair.open, pair.distance, training.power[sender],
                              training.slopePower[sender])
                  : linkError(*pair.partsB, *pair.partsA, transposed(exchange), transposed(pair.open), pair.distance,
                              training.power[sender], training.slopePower[sender]);
    const double n = double(pair.known) + 2.0;
    v.visibilityError = pair.clear ? 0.0
                                   : strength(receiver, sender, double(pair.total)) *
                                         (pair.mean * (1.0 - pair.mean) / n + 1.0 / (n * n));
    const double error = double(v.error.sender) + double(v.error.receiver) + kVisibilityError * v.visibilityError;
    const bool mayEnd = (!s_.leafReceivers && !pair.touches) || s_.tree.isLeaf(receiver);
    v.good = mayEnd && error <= s_.tolerance;
    v.goodCoarse = mayEnd && error <= kCoarser * kCoarser * s_.tolerance;
    return v;
}

bool LinkRefiner::isFaint(u32 receiver, u32 sender, double exchange) const
{
    return (!s_.leafReceivers || s_.tree.isLeaf(receiver)) &&
           kWholeLinkError * strength(receiver, sender, exchange) <= s_.tolerance;
}

u32 LinkRefiner::faintDirections(u32 a, u32 b, double distance, double exchange) const
{
    // Only between nodes that are far apart does the whole exchange say how large its parts can be.
    if (distance <= kFarDistance * (s_.transfer.radius(a) + s_.transfer.radius(b))) return 0;
    return (isFaint(a, b, exchange) ? kToA : 0) | (isFaint(b, a, exchange) ? kToB : 0);
}

bool LinkRefiner::isSurelyTooCoarse(const Pair& pair, u32 directions, Sight sight) const
{
    const double ra = s_.tree.isLeaf(pair.a) ? 0.0 : s_.transfer.radius(pair.a),
                 rb = s_.tree.isLeaf(pair.b) ? 0.0 : s_.transfer.radius(pair.b),
                 ratio = squaredRatio(std::max(ra, rb), double(pair.distance)), total = double(pair.total);
    const double limit = kSurelyTooCoarse * s_.tolerance;
    if ((directions & kToA) != 0 && strength(pair.a, pair.b, total) * ratio <= limit) return false;
    if ((directions & kToB) != 0 && strength(pair.b, pair.a, total) * ratio <= limit) return false;
    // Only a pair that sees something: what is blocked is better judged as a whole.
    return sight.isClear() || sight.rays.open > 0 ||
           s_.rays.openShare(pair.a, pair.b, total, kWholeRays, 0.0, {}, betweenOf(sight)).open > 0.0;
}

void LinkRefiner::linkWhole(u32 a, u32 b, double transfer, Directions directions, Sight sight)
{
    double power = 0.0;
    if ((directions.fine & kToA) != 0) power = std::max(power, strength(a, b, transfer));
    if ((directions.fine & kToB) != 0) power = std::max(power, strength(b, a, transfer));
    double open = 1.0;
    if (!sight.isClear()) {
        // Where the pairs above were wholly open or blocked a few rays are enough.
        const OpenShare share =
            s_.rays.openShare(a, b, transfer, sight.known() >= kKnown ? kFewRays : kWholeRays,
                              kVisibilityError * power / s_.tolerance, sight.rays, betweenOf(sight));
        open = share.rays > 0 ? share.open : sight.rays.blocked > 0 ? 0.0 : 1.0;
    }
    const double exchange = transfer * open;
    link(kToA, directions, {a, b, float(exchange / s_.tree.nodes[a].area)});
    link(kToB, directions, {b, a, float(exchange / s_.tree.nodes[b].area)});
}

void LinkRefiner::linkOrOpen(u32 a, u32 b, Directions directions, Sight sight)
{
    const double transfer = s_.transfer.between(a, b);
    if (transfer <= 0.0) return;
    const u32 faint =
        faintDirections(a, b, glm::distance(s_.tree.nodes[a].centroid, s_.tree.nodes[b].centroid), transfer);
    if ((directions.fine & faint) != 0) linkWhole(a, b, transfer, directions.only(faint), sight);
    const Directions open = directions.only(~faint);
    const bool splitA = s_.tree.isLeaf(b) || (!s_.tree.isLeaf(a) && s_.transfer.radius(a) >= s_.transfer.radius(b));
    split(a, b, splitA ? open : Directions{}, splitA ? Directions{} : open, sight);
}

bool LinkRefiner::splitsReceiver(const Verdict& v, bool touches, u32 receiver, u32 sender) const
{
    if (s_.tree.isLeaf(receiver)) return false;
    if (s_.tree.isLeaf(sender) || s_.leafReceivers) return true;
    if (touches && s_.transfer.radius(receiver) >= s_.transfer.radius(sender)) return true;
    if (kVisibilityError * v.visibilityError > double(v.error.sender + v.error.receiver))
        return s_.tree.nodes[receiver].area >= s_.tree.nodes[sender].area;
    // Halving the larger one helps the later levels more than the errors of this one say.
    return double(v.error.receiver) * s_.transfer.radius(receiver) >
           double(v.error.sender) * s_.transfer.radius(sender);
}

LinkRefiner::Directions LinkRefiner::linkGood(const Pair& pair, const Verdict& toA, const Verdict& toB,
                                              Directions directions)
{
    Directions now;
    now.fine = directions.fine & ((toA.good ? kToA : 0) | (toB.good ? kToB : 0));
    now.coarse = directions.coarse & ((toA.goodCoarse ? kToA : 0) | (toB.goodCoarse ? kToB : 0));
    if ((now.fine | now.coarse) != 0) {
        // The parts tell how the exchange is spread, the outlines how much it is.
        const double transfer = s_.transfer.between(pair.a, pair.b), scale = transfer / double(pair.total);
        const auto linkOf = [&](u32 receiver, u32 sender, const LinkError& error) {
            const double area = s_.tree.nodes[receiver].area;
            return NodeLink{receiver, sender, float(transfer * pair.mean / area),
                            glm::vec2(scale * double(error.momentX) / area, scale * double(error.momentY) / area)};
        };
        link(kToA, now, linkOf(pair.a, pair.b, toA.error));
        link(kToB, now, linkOf(pair.b, pair.a, toB.error));
    }
    return {directions.fine & ~now.fine, directions.coarse & ~now.coarse};
}

LinkRays::Between LinkRefiner::betweenOf(const Sight& sight) const
{
    return {std::span(between_).subspan(sight.begin, sight.end - sight.begin), sight.listed};
}

void LinkRefiner::refine(u32 a, u32 b)
{
    between_.clear();
    refine(a, b, {kToA | kToB, kToA | kToB}, Sight{});
}

void LinkRefiner::refine(u32 a, u32 b, Directions directions, Sight sight)
{
    ++evaluated_;
    if (!s_.transfer.faceEachOther(a, b)) return;
    const size_t mark = between_.size();
    if (sight.listed) {
        s_.occluders.narrow(a, b, sight.begin, sight.end, between_);
    } else if (const double size = s_.transfer.radius(a) + s_.transfer.radius(b); size < kRetry * sight.size) {
        sight.listed = s_.occluders.find(a, b, kMostBetween, between_);
        sight.size = size;
    }
    sight.begin = mark;
    sight.end = between_.size();
    refineSeen(a, b, directions, sight);
    between_.resize(mark);
}

void LinkRefiner::refineSeen(u32 nodeA, u32 nodeB, Directions directions, Sight sight)
{
    const NodeTree& tree = s_.tree;
    const bool leafA = tree.isLeaf(nodeA), leafB = tree.isLeaf(nodeB);
    if (leafA && leafB) {
        const double transfer = s_.transfer.between(nodeA, nodeB);
        if (transfer > 0.0) linkWhole(nodeA, nodeB, transfer, directions, sight);
        return;
    }
    Pair pair;
    pair.a = nodeA;
    pair.b = nodeB;
    pair.partsA = &partsOf(nodeA);
    pair.partsB = &partsOf(nodeB);
    const glm::vec3 between(tree.nodes[nodeB].centroid - tree.nodes[nodeA].centroid);
    pair.distance = glm::length(between);
    pair.total = partExchange(*pair.partsA, *pair.partsB, between, glm::vec3(tree.nodes[nodeA].normal),
                              glm::vec3(tree.nodes[nodeB].normal), pair.exchange);
    // Where no centroid faces another, what there is stands at the horizon.
    if (pair.total <= 0.0f) return linkOrOpen(nodeA, nodeB, directions, sight);
    if ((faintDirections(nodeA, nodeB, double(pair.distance), double(pair.total)) & directions.fine) ==
        directions.fine) {
        linkWhole(nodeA, nodeB, s_.transfer.between(nodeA, nodeB), directions, sight);
        return;
    }
    // A node with more children than fit cannot be judged from its parts: it is opened unseen.
    const bool wideA = pair.partsA->count == 1 && !leafA, wideB = pair.partsB->count == 1 && !leafB;
    const bool coarse = !wideA && !wideB && isSurelyTooCoarse(pair, directions.fine, sight);
    if (wideA || wideB || coarse) {
        const bool larger = s_.transfer.radius(nodeA) >= s_.transfer.radius(nodeB);
        const bool splitA = coarse ? leafB || (!leafA && larger) : wideA;
        split(nodeA, nodeB, splitA ? directions : Directions{}, splitA ? Directions{} : directions, sight);
        return;
    }
    weighNearParts(pair);
    if (pair.total <= 0.0f) return linkOrOpen(nodeA, nodeB, directions, sight);
    pair.clear = sight.isClear();
    if (pair.clear) {
        for (NodeParts::Row& row : pair.open) row.fill(1.0f);
    } else {
        const u32 known = sight.known();
        pair.seen = pair.asked = {};
        look(pair, known == 0 ? kFirstRays : known < kKnown ? kWholeRays : kFewRays, sight);
    }
    Sight below = sightOf(pair, sight);
    Verdict toA, toB;
    const auto judgeBoth = [&] {
        if ((directions.fine & kToA) != 0) toA = judge(pair, true);
        if ((directions.fine & kToB) != 0) toB = judge(pair, false);
    };
    judgeBoth();
    // Good enough to be a link: more rays sharpen its visibility where few are not enough.
    const bool mixed = pair.mean > 0.0 && pair.mean < 1.0;
    const auto isUnsure = [&](const Verdict& v) { return v.good && (mixed || v.visibilityError > s_.tolerance); };
    if (isUnsure(toA) || isUnsure(toB)) {
        for (u32 k = 0; k < s_.raysPerPart; ++k) look(pair, 0, sight);
        below = sightOf(pair, sight);
        judgeBoth();
    }
    const Directions open = linkGood(pair, toA, toB, directions);
    u32 openA = 0, openB = 0;
    if ((open.fine & kToA) != 0) (splitsReceiver(toA, pair.touches, nodeA, nodeB) ? openA : openB) |= kToA;
    if ((open.fine & kToB) != 0) (splitsReceiver(toB, pair.touches, nodeB, nodeA) ? openB : openA) |= kToB;
    split(nodeA, nodeB, open.only(openA), open.only(openB), below);
}

void LinkRefiner::split(u32 nodeA, u32 nodeB, Directions openA, Directions openB, Sight sight)
{
    if (openA.fine != 0)
        for (const u32 child : s_.tree.childrenOf(nodeA)) refine(child, nodeB, openA, sight);
    if (openB.fine != 0)
        for (const u32 child : s_.tree.childrenOf(nodeB)) refine(nodeA, child, openB, sight);
}

} // namespace helio
