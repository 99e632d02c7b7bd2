// SPDX-License-Identifier: Apache-2.0
#include "city/geometry/wavefront.h"

#include <algorithm>
#include <cmath>

#include "city/base/check.h"

namespace helio {

namespace {

/// Two places closer than this are one, grid steps: far above the rounding of Real, far below the grid.
constexpr Real kSame = 1e-6L;
/// Spikes wait until every event of their moment has been handled: then both of their edges have their true ends.
constexpr Real kSpikeDelay = 1e-8L;

Real dot(const WavePoint& a, const WavePoint& b)
{
    return a.x * b.x + a.y * b.y;
}
WavePoint operator-(const WavePoint& a, const WavePoint& b)
{
    return {a.x - b.x, a.y - b.y};
}

} // namespace

bool Wavefront::Event::operator<(const Event& b) const
{
    if (time != b.time) return time > b.time;
    if (kind != b.kind) return kind > b.kind;
    if (corner != b.corner) return corner > b.corner;
    return other > b.other;
}

Wavefront::Wavefront(std::vector<WaveEdge> edges) : edges_(std::move(edges))
{
    for (WaveEdge& edge : edges_) {
        HELIO_CHECK(edge.dx != 0 || edge.dy != 0, edge.x, " ", edge.y);
        edge.length = std::hypot(Real(edge.dx), Real(edge.dy));
        edge.along = {Real(edge.dx) / edge.length, Real(edge.dy) / edge.length};
        edge.normal = {-edge.along.y, edge.along.x};
        nodes_.push_back({{Real(edge.x), Real(edge.y)}, 0});
    }
    arcs_.resize(edges_.size());
    segments_.resize(edges_.size());
    std::vector<u32> before(edges_.size());
    for (u32 i = 0; i < edges_.size(); ++i) before[edges_[i].next] = i;
    for (u32 i = 0; i < edges_.size(); ++i) {
        arcs_[i].push_back({i, edges_[i].next});
        addCorner(before[i], i, i);
    }
    for (u32 i = 0; i < edges_.size(); ++i) link(i, edges_[i].next);
}

int Wavefront::turn(u32 a, u32 b) const
{
    const __int128 value = __int128(edges_[a].dx) * edges_[b].dy - __int128(edges_[a].dy) * edges_[b].dx;
    return value > 0 ? 1 : (value < 0 ? -1 : 0);
}

bool Wavefront::sameWay(u32 a, u32 b) const
{
    return dot(edges_[a].along, edges_[b].along) > 0;
}

WavePoint Wavefront::at(const Corner& corner, Real time) const
{
    if (corner.spike) return corner.origin;
    return {corner.origin.x + corner.velocity.x * (time - corner.start),
            corner.origin.y + corner.velocity.y * (time - corner.start)};
}

u32 Wavefront::addNode(const WavePoint& position, Real time)
{
    nodes_.push_back({position, time});
    return u32(nodes_.size() - 1);
}

u32 Wavefront::addCorner(u32 in, u32 out, u32 node)
{
    Corner corner{in, out, node, kNoIndex, kNoIndex, nodes_[node].position, nodes_[node].time, {}, false, true};
    const WaveEdge& a = edges_[in];
    const WaveEdge& b = edges_[out];
    if (turn(in, out) == 0) {
        corner.spike = !sameWay(in, out);
        corner.velocity = {a.normal.x * a.speed, a.normal.y * a.speed};
    } else if (a.speed == b.speed && sameWay(in, out)) {
        // The bisector; well-conditioned however flat the corner is.
        const Real factor = a.speed / (1 + dot(a.normal, b.normal));
        corner.velocity = {(a.normal.x + b.normal.x) * factor, (a.normal.y + b.normal.y) * factor};
    } else {
        // velocity . normal = speed for both edges. The determinant is exact but for one rounding: it decides how fast
        // corners between almost antiparallel edges are.
        const __int128 cross = __int128(a.dx) * b.dy - __int128(a.dy) * b.dx;
        const Real determinant = Real(cross) / (a.length * b.length);
        corner.velocity = {(b.along.x * a.speed - a.along.x * b.speed) / determinant,
                           (b.along.y * a.speed - a.along.y * b.speed) / determinant};
    }
    corners_.push_back(corner);
    const u32 index = u32(corners_.size() - 1);
    segments_[out].push_back(index);
    ++alive_;
    return index;
}

void Wavefront::addArc(const Corner& corner, u32 toNode)
{
    arcs_[corner.in].push_back({corner.node, toNode});
    arcs_[corner.out].push_back({toNode, corner.node});
}

void Wavefront::link(u32 a, u32 b)
{
    corners_[a].next = b;
    corners_[b].prev = a;
}

void Wavefront::scheduleCollapse(u32 corner)
{
    const Corner& v = corners_[corner];
    const Corner& u = corners_[v.next];
    if (v.spike || u.spike) return; // the spike's own event shortens its edges
    const WavePoint& along = edges_[v.out].along;
    const Real length = dot(at(u, now_) - at(v, now_), along);
    const Real growth = dot(u.velocity - v.velocity, along);
    if (length <= kSame) {
        // Without length already: gone, unless it grows. It cannot grow where its neighbours turn away from it by half
        // a turn or more in all: they would cross.
        const bool crossing = turn(v.in, v.out) < 0 && turn(u.in, u.out) < 0 && turn(v.in, u.out) >= 0;
        if (growth <= 0 || crossing) events_.push({now_, EventKind::Collapse, corner, v.next});
    } else if (growth < 0) {
        events_.push({now_ + length / -growth, EventKind::Collapse, corner, v.next});
    }
}

void Wavefront::scheduleSplits(u32 corner)
{
    const Corner& v = corners_[corner];
    if (v.spike || turn(v.in, v.out) >= 0) return;
    for (u32 e = 0; e < edges_.size(); ++e) {
        if (e == v.in || e == v.out) continue;
        const WaveEdge& edge = edges_[e];
        const WavePoint from{v.origin.x - Real(edge.x), v.origin.y - Real(edge.y)};
        const Real distance = dot(from, edge.normal) - edge.speed * now_;
        const Real approach = edge.speed - dot(v.velocity, edge.normal);
        if (approach <= 0 || distance < -kSame) continue;
        events_.push({now_ + std::max(distance, Real(0)) / approach, EventKind::Split, corner, e});
    }
}

void Wavefront::schedule(u32 corner)
{
    const Corner& v = corners_[corner];
    if (v.spike) {
        events_.push({now_ + kSpikeDelay, EventKind::Spike, corner, 0});
        return;
    }
    scheduleCollapse(v.prev);
    scheduleCollapse(corner);
    scheduleSplits(corner);
}

void Wavefront::settle(u32 corner)
{
    Corner& v = corners_[corner];
    if (!v.alive) return;
    Corner& other = corners_[v.next];
    if (v.next == v.prev) {
        addArc(v, other.node);
        v.alive = other.alive = false;
        alive_ -= 2;
        return;
    }
    schedule(corner);
}

void Wavefront::collapse(u32 corner, u32 other, const WavePoint& position)
{
    const u32 node = addNode(position, now_);
    addArc(corners_[corner], node);
    addArc(corners_[other], node);
    corners_[corner].alive = corners_[other].alive = false;
    alive_ -= 2;
    const u32 before = corners_[corner].prev, after = corners_[other].next;
    const u32 in = corners_[corner].in, out = corners_[other].out;
    if (in == out) {
        // Two pieces of one edge meet again.
        if (before == after) {
            problem_ = "a front of one edge";
            return;
        }
        link(before, after);
        if (corners_[after].next == before)
            settle(before);
        else
            scheduleCollapse(before);
        return;
    }
    const u32 fresh = addCorner(in, out, node);
    link(before, fresh);
    link(fresh, after);
    settle(fresh);
}

void Wavefront::split(u32 corner, u32 edge)
{
    const WavePoint p = at(corners_[corner], now_);
    const WavePoint& along = edges_[edge].along;
    std::vector<u32>& starts = segments_[edge];
    std::erase_if(starts, [&](u32 c) { return !corners_[c].alive; });
    u32 best = kNoIndex;
    Real bestMargin = -kSame;
    for (const u32 start : starts) {
        const Real behind = dot(p - at(corners_[start], now_), along);
        const Real ahead = dot(at(corners_[corners_[start].next], now_) - p, along);
        const Real margin = std::min(behind, ahead);
        if (margin >= bestMargin) {
            bestMargin = margin;
            best = start;
        }
    }
    if (best == kNoIndex) return; // passes the edge's end
    const u32 end = corners_[best].next;
    const u32 node = addNode(p, now_);
    addArc(corners_[corner], node);
    corners_[corner].alive = false;
    --alive_;
    const u32 before = corners_[corner].prev, after = corners_[corner].next;
    const u32 in = corners_[corner].in, out = corners_[corner].out;
    const u32 left = addCorner(in, edge, node);
    const u32 right = addCorner(edge, out, node);
    link(before, left);
    link(left, end);
    link(best, right);
    link(right, after);
    settle(left);
    settle(right);
}

void Wavefront::resolveSpike(u32 corner)
{
    const Corner& v = corners_[corner];
    const Real back = dot(v.origin - at(corners_[v.prev], now_), edges_[v.in].along);
    const Real ahead = dot(at(corners_[v.next], now_) - v.origin, edges_[v.out].along);
    // The edges lie on each other: the shorter one is swept at once, up to its other end.
    if (back <= ahead)
        collapse(v.prev, corner, at(corners_[v.prev], now_));
    else
        collapse(corner, v.next, at(corners_[v.next], now_));
}

bool Wavefront::run()
{
    for (u32 i = 0; i < edges_.size(); ++i) {
        if (corners_[i].spike) {
            problem_ = "two edges lie on each other";
            return false;
        }
        scheduleCollapse(i);
        scheduleSplits(i);
    }
    // Each event ends a corner or cuts a front in two; a sound front needs fewer than four per edge.
    const std::size_t limit = 16 * edges_.size() + 64;
    std::size_t handled = 0;
    while (!events_.empty() && problem_.empty() && alive_ > 0) {
        const Event event = events_.top();
        events_.pop();
        const Corner& v = corners_[event.corner];
        if (!v.alive) continue;
        if (event.kind == EventKind::Collapse && (v.next != event.other || !corners_[event.other].alive)) continue;
        now_ = std::max(now_, event.time);
        if (corners_.size() > limit || ++handled > 64 * limit * edges_.size()) {
            problem_ = "the front does not shrink";
            break;
        }
        if (event.kind == EventKind::Collapse) {
            const Corner& u = corners_[event.other];
            // The slower of both is known better.
            const bool slower = dot(v.velocity, v.velocity) <= dot(u.velocity, u.velocity);
            collapse(event.corner, event.other, at(slower ? v : u, now_));
        } else if (event.kind == EventKind::Split) {
            split(event.corner, event.other);
        } else {
            resolveSpike(event.corner);
        }
    }
    if (problem_.empty() && alive_ > 0) problem_ = "the front did not close";
    return problem_.empty();
}

} // namespace helio
