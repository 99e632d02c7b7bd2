// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "city/base/types.h"

// The moving front of a straight skeleton. Lengths and times in steps of the 0.1 mm grid.
namespace helio {

/// 64-bit mantissa: almost antiparallel edges make corners some 1e6 times as fast as the edges.
using Real = long double;

struct WavePoint
{
    Real x = 0, y = 0;
};

/// A corner of the polygon on the grid, and the edge that starts at it.
struct WaveEdge
{
    i64 x = 0, y = 0;    ///< first corner
    i64 dx = 0, dy = 0;  ///< to the second corner; interior on the left
    u32 next = kNoIndex; ///< edge that starts at the second corner
    Real speed = 1;      ///< of the front along its normal, >= 0
    Real length = 0;     ///< of (dx, dy)
    WavePoint along{};   ///< unit direction
    WavePoint normal{};  ///< unit, to the interior
};

struct WaveNode
{
    WavePoint position;
    Real time = 0;
};

/// Moves the edges inwards until nothing is left, and records the arcs that its corners trace.
class Wavefront
{
public:
    /// Closed loops by WaveEdge::next; dx, dy not both 0. `edges` with x, y, dx, dy, next and speed set.
    explicit Wavefront(std::vector<WaveEdge> edges);

    /// False when the events did not close the front; `problem()` says why.
    bool run();

    const std::string& problem() const { return problem_; }
    const std::vector<WaveEdge>& edges() const { return edges_; }
    /// First the corners.
    const std::vector<WaveNode>& nodes() const { return nodes_; }
    /// Per edge its directed arcs (from, to), with the face on their left; the edge itself is the first of them.
    const std::vector<std::vector<std::pair<u32, u32>>>& arcs() const { return arcs_; }

private:
    struct Corner
    {
        u32 in, out;        ///< edges
        u32 node;           ///< where it started
        u32 prev, next;     ///< corners of the front
        WavePoint origin{}; ///< at time `start`
        Real start = 0;
        WavePoint velocity{};
        bool spike = false; ///< between antiparallel edges that lie on each other: no position, gone at once
        bool alive = true;
    };
    enum class EventKind : u8
    {
        Collapse, ///< the edge between corner and other has no length left
        Split,    ///< a reflex corner reaches edge `other`
        Spike     ///< corner is between two edges that met along a line
    };
    struct Event
    {
        Real time;
        EventKind kind;
        u32 corner, other;
        bool operator<(const Event& b) const; ///< true: later, as std::priority_queue wants it
    };

    int turn(u32 a, u32 b) const; ///< sign of the cross product of two edges' directions, exact
    bool sameWay(u32 a, u32 b) const;
    WavePoint at(const Corner& corner, Real time) const;
    u32 addCorner(u32 in, u32 out, u32 node);
    u32 addNode(const WavePoint& position, Real time);
    void addArc(const Corner& corner, u32 toNode);
    void link(u32 a, u32 b);
    /// Events of a corner whose neighbours are linked.
    void schedule(u32 corner);
    void scheduleCollapse(u32 corner);
    void scheduleSplits(u32 corner);
    /// A loop of two corners is an arc between them; otherwise schedules.
    void settle(u32 corner);
    void collapse(u32 corner, u32 other, const WavePoint& position);
    void split(u32 corner, u32 edge);
    void resolveSpike(u32 corner);

    std::vector<WaveEdge> edges_;
    std::vector<WaveNode> nodes_;
    std::vector<std::vector<std::pair<u32, u32>>> arcs_;
    std::vector<Corner> corners_;
    std::vector<std::vector<u32>> segments_; ///< per edge the corners that a piece of it starts at, dead ones too
    std::priority_queue<Event> events_;
    Real now_ = 0;
    std::size_t alive_ = 0;
    std::string problem_;
};

} // namespace helio
