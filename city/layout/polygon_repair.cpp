// SPDX-License-Identifier: Apache-2.0
#include "city/layout/polygon_repair.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

#include "city/base/check.h"
#include "city/geometry/clip.h"
#include "city/layout/validity.h"

namespace helio {

namespace {

constexpr double kSameCorner = 1e-3;    // m
constexpr double kStraightAngle = 0.01; // rad
constexpr double kStraightSag = 0.02;   // m: a finely drawn curve turns little at each corner but must stay a curve
constexpr double kShortEdge = 0.1;      // m
constexpr double kSmallPiece = 1.0;     // m2
constexpr double kSliverWidth = 0.1;    // m, twice the area over the perimeter

double distanceToLine(const glm::dvec2& point, const glm::dvec2& a, const glm::dvec2& b)
{
    const double length = glm::distance(a, b);
    return length > 0.0 ? std::abs(cross(b - a, point - a)) / length : glm::distance(point, a);
}

u32 dropRepeats(Ring2& ring)
{
    Ring2 kept;
    for (const glm::dvec2& corner : ring)
        if (kept.empty() || glm::distance(kept.back(), corner) >= kSameCorner) kept.push_back(corner);
    while (kept.size() > 1 && glm::distance(kept.front(), kept.back()) < kSameCorner) kept.pop_back();
    const u32 dropped = u32(ring.size() - kept.size());
    ring = std::move(kept);
    return dropped;
}

// A spike goes out and comes back along the same line; removing its tip may uncover the next one, hence the repetition.
u32 dropSpikes(Ring2& ring)
{
    u32 dropped = 0;
    for (size_t i = 0, checked = 0; ring.size() >= 3 && checked < ring.size();) {
        const size_t n = ring.size();
        const glm::dvec2 before = ring[(i + n - 1) % n], tip = ring[i % n], after = ring[(i + 1) % n];
        const bool turnsBack = glm::dot(tip - before, after - tip) < 0.0;
        const bool beforeIsNearer = glm::distance(before, tip) < glm::distance(after, tip);
        const double gap = beforeIsNearer ? distanceToLine(before, tip, after) : distanceToLine(after, before, tip);
        if (turnsBack && gap < kSameCorner) {
            ring.erase(ring.begin() + long(i % n));
            dropped += 1 + dropRepeats(ring);
            i = ring.empty() ? 0 : (i + ring.size() - 1) % ring.size();
            checked = 0;
        } else {
            i = (i + 1) % n;
            ++checked;
        }
    }
    return dropped;
}

bool turnsSharply(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c)
{
    return std::abs(std::atan2(cross(b - a, c - b), glm::dot(b - a, c - b))) >= kStraightAngle;
}

// Corners marked by `keeps` stay.
u32 dropStraightCorners(Ring2& ring, const std::vector<bool>& keeps)
{
    const size_t n = ring.size();
    if (n <= 3) return 0;
    const auto stays = [&](size_t i) {
        return (i < keeps.size() && keeps[i]) || turnsSharply(ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
    };
    size_t start = 0; // a true corner, so that no straight stretch runs over the ring's end
    while (start < n && !stays(start)) ++start;
    if (start == n) start = 0;
    Ring2 kept{ring[start]};
    size_t pendingBegin = 1; // corners dropped since the last kept one: [pendingBegin, k)
    for (size_t k = 1; k < n; ++k) {
        const size_t i = (start + k) % n;
        const glm::dvec2 corner = ring[i], next = ring[(i + 1) % n];
        bool straight = !(i < keeps.size() && keeps[i]) && !turnsSharply(kept.back(), corner, next);
        for (size_t p = pendingBegin; straight && p <= k; ++p)
            straight = distanceToLine(ring[(start + p) % n], kept.back(), next) < kStraightSag;
        if (straight) continue;
        kept.push_back(corner);
        pendingBegin = k + 1;
    }
    const u32 dropped = u32(n - kept.size());
    if (kept.size() < 3) return 0;
    // The ring keeps its first corner where it can: the order of edges means something to rules.
    const auto first = std::find(kept.begin(), kept.end(), ring[0]);
    if (first != kept.end()) std::rotate(kept.begin(), first, kept.end());
    ring = std::move(kept);
    return dropped;
}

// Removes, for the shortest edge below the limit, that one of its two corners which changes the area less.
u32 collapseShortEdges(Ring2& ring)
{
    u32 collapsed = 0;
    for (;;) {
        const size_t n = ring.size();
        size_t shortest = 0;
        double length = kShortEdge;
        for (size_t i = 0; i < n; ++i) {
            const double edge = glm::distance(ring[i], ring[(i + 1) % n]);
            if (edge < length) length = edge, shortest = i;
        }
        if (length >= kShortEdge || n <= 3) return collapsed;
        const size_t a = shortest, b = (shortest + 1) % n;
        const auto change = [&](size_t i) {
            return std::abs(cross(ring[i] - ring[(i + n - 1) % n], ring[(i + 1) % n] - ring[i]));
        };
        ring.erase(ring.begin() + long(change(a) < change(b) ? a : b));
        ++collapsed;
    }
}

// The union of the rings. Parts that touch in a corner only are drawn apart by a millimetre each, so that all is
// simple.
std::vector<Polygon2> uniteRings(const Polygon2& polygon)
{
    ClipperLib::Paths holes;
    for (const Ring2& hole : polygon.holes) {
        holes.push_back(toGrid(hole));
        if (!ClipperLib::Orientation(holes.back())) ClipperLib::ReversePath(holes.back());
    }
    std::vector<Polygon2> pieces;
    for (Polygon2& piece : subtractToPolygons({toGrid(polygon.outer)}, holes)) {
        if (isSimple(piece)) {
            pieces.push_back(std::move(piece));
            continue;
        }
        for (Polygon2& apart : subtractToPolygons(offset(toPaths(piece), -kSameCorner), {}))
            pieces.push_back(std::move(apart));
    }
    return pieces;
}

void orient(Ring2& ring, bool counterClockwise, RepairReport& report)
{
    if ((signedArea(ring) > 0.0) == counterClockwise) return;
    // The first edge stays the first.
    std::reverse(ring.begin(), ring.end());
    std::rotate(ring.begin(), ring.end() - std::min<long>(2, long(ring.size())), ring.end());
    ++report.reversedRings;
}

// Returns false when nothing with an area is left of the outer ring.
bool tidyRings(Polygon2& polygon, RepairReport& report, bool keepsFirstEdge)
{
    const auto tidy = [&](Ring2& ring, const std::vector<bool>& keeps) {
        report.repeatedCorners += dropRepeats(ring);
        report.spikes += dropSpikes(ring);
        if (ring.size() < 3) return false;
        report.straightCorners += dropStraightCorners(ring, keeps);
        return ring.size() >= 3;
    };
    if (!tidy(polygon.outer, keepsFirstEdge ? std::vector<bool>{true, true} : std::vector<bool>{})) return false;
    const size_t holes = polygon.holes.size();
    std::erase_if(polygon.holes, [&](Ring2& hole) { return !tidy(hole, {}); });
    report.lostHoles += u32(holes - polygon.holes.size());
    return true;
}

double perimeter(const Ring2& ring)
{
    double sum = 0.0;
    for (size_t i = 0; i < ring.size(); ++i) sum += glm::distance(ring[i], ring[(i + 1) % ring.size()]);
    return sum;
}

void collapse(Polygon2& polygon, RepairReport& report)
{
    report.shortEdges += collapseShortEdges(polygon.outer);
    for (Ring2& hole : polygon.holes) report.shortEdges += collapseShortEdges(hole);
}

} // namespace

bool isSimple(const Polygon2& polygon)
{
    const PolygonFindings findings = polygonFindings(polygon, 0);
    return !findings.defect && findings.meetings == 0;
}

bool isStraightCorner(const glm::dvec2& before, const glm::dvec2& corner, const glm::dvec2& after)
{
    return !turnsSharply(before, corner, after) && distanceToLine(corner, before, after) < kStraightSag;
}

std::vector<Polygon2> cleanPolygon(Polygon2 polygon, RepairReport& report)
{
    if (!tidyRings(polygon, report, true)) return {};
    orient(polygon.outer, true, report);
    for (Ring2& hole : polygon.holes) orient(hole, false, report);
    std::vector<Polygon2> pieces;
    const bool isUnited = !isSimple(polygon);
    if (isUnited) {
        report.crossing = true;
        pieces = uniteRings(polygon);
    } else {
        pieces.push_back(std::move(polygon));
    }
    std::vector<Polygon2> result;
    for (Polygon2& piece : pieces) {
        RepairReport unnamed; // repeats and spikes that uniting leaves on the grid are of our own making
        if (isUnited && !tidyRings(piece, unnamed, false)) continue;
        const Polygon2 before = piece;
        const u32 shortEdges = report.shortEdges;
        collapse(piece, report);
        if (report.shortEdges > shortEdges) tidyRings(piece, unnamed, !isUnited);
        // Collapsing may, rarely, push an outline through itself; then the short edges are the lesser evil.
        if (!isSimple(piece)) piece = before;
        std::erase_if(piece.holes, [](const Ring2& hole) { return std::abs(signedArea(hole)) < 1e-2; });
        if (area(piece) >= kSmallPiece && 2.0 * area(piece) >= kSliverWidth * perimeter(piece.outer))
            result.push_back(std::move(piece));
        else
            ++report.smallPieces;
    }
    return result;
}

std::vector<ImportNotes::Item> repairItems(const RepairReport& report)
{
    std::vector<ImportNotes::Item> items;
    const auto count = [](u32 n, const char* what) { return concat(n, " ", what, n == 1 ? "" : "s"); };
    if (report.repeatedCorners)
        items.emplace_back("repaired.duplicate_corners", "dropped " + count(report.repeatedCorners, "repeated corner"));
    if (report.spikes) items.emplace_back("repaired.spikes", "removed " + count(report.spikes, "spike corner"));
    if (report.crossing) items.emplace_back("repaired.united", "united crossing or touching rings");
    if (report.lostHoles)
        items.emplace_back("repaired.lost_holes", "dropped " + count(report.lostHoles, "hole") + " without area");
    if (report.shortEdges)
        items.emplace_back("repaired.short_edges", "collapsed " + count(report.shortEdges, "edge") + " below 0.1 m");
    if (report.smallPieces)
        items.emplace_back("repaired.small_pieces",
                           "dropped " + count(report.smallPieces, "piece") + " below 1 m2 or 0.1 m of width");
    return items;
}

} // namespace helio
