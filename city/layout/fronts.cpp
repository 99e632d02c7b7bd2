// SPDX-License-Identifier: Apache-2.0
#include "city/layout/fronts.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "city/layout/courts.h"
#include "city/layout/polygon_repair.h"
#include "city/layout/shared_walls.h"
#include "city/layout/streets.h"

namespace helio {

namespace {

constexpr double kSameDistance = 1.0; // m: streets as near as that are equally near
constexpr double kShortFront = 2.0;   // m: no front where there is a longer edge on the street

// A straight stretch of the outer ring: edges first, first + 1, ... (count of them).
struct Run
{
    size_t first, count;
    double length = 0.0;
    double street = std::numeric_limits<double>::infinity(); ///< m, distance of the nearest street that it faces
    int rank = 0;                                            ///< 4 street line, 3 street side, 2 court, 1 partly free
    double size = 0.0;                                       ///< m, or m2 of free wall for rank 1
};

// Whether one of the first edge's ends is none but for its being marked by the input: those are the straight corners
// that cleanPolygon leaves.
bool isStraight(const Ring2& ring, size_t corner)
{
    const size_t n = ring.size();
    return n > 3 && corner <= 1 && isStraightCorner(ring[(corner + n - 1) % n], ring[corner], ring[(corner + 1) % n]);
}

std::vector<Run> straightRuns(const Ring2& ring)
{
    const size_t n = ring.size();
    std::vector<Run> runs;
    for (size_t k = 0; k < n; ++k) {
        const size_t edge = (k + 2) % n; // corner 2 is a true one
        if (runs.empty() || !isStraight(ring, edge)) runs.push_back({edge, 0});
        ++runs.back().count;
        runs.back().length += glm::distance(ring[edge], ring[(edge + 1) % n]);
    }
    // Ties go to what came first in the ring: the first edge's own run leads.
    const auto place = [&](const Run& run) { return run.first + run.count > n ? 0 : run.first; };
    std::stable_sort(runs.begin(), runs.end(), [&](const Run& a, const Run& b) { return place(a) < place(b); });
    return runs;
}

class FrontChooser
{
public:
    explicit FrontChooser(const Layout& layout) : courts_(enclosedCourts(layout.footprints))
    {
        if (!layout.streets.empty()) distances_ = streetDistances(layout);
    }

    void choose(Footprint& footprint, size_t index) const
    {
        const Ring2& ring = footprint.outline.outer;
        std::vector<Run> runs = straightRuns(ring);
        for (Run& run : runs) measure(run, footprint, index);
        const Run& best = bestOf(runs);
        const bool holdsFirst = best.first == 0 || best.first + best.count > ring.size();
        if (holdsFirst && glm::distance(ring[0], ring[1]) >= 0.5 * best.length) return;
        const Ring2 before = ring;
        rotate(footprint, best.first);
        for (const size_t corner : {size_t(1), size_t(0)})
            if (isStraight(before, corner)) join(footprint, (corner + before.size() - best.first) % before.size());
    }

private:
    void measure(Run& run, const Footprint& footprint, size_t index) const
    {
        const Ring2& ring = footprint.outline.outer;
        double exposedArea = 0.0, freeLength = 0.0;
        for (size_t k = 0; k < run.count; ++k) {
            const size_t edge = (run.first + k) % ring.size();
            const double length = glm::distance(ring[edge], ring[(edge + 1) % ring.size()]);
            const double covered = coveredHalf(footprint.covered[edge], length);
            exposedArea += length * std::max(0.0, footprint.height - covered);
            if (covered == 0.0) freeLength += length;
            if (!distances_.empty()) run.street = std::min(run.street, distances_[index][edge]);
        }
        const glm::dvec2 a = ring[run.first], b = ring[(run.first + run.count) % ring.size()];
        const glm::dvec2 outward = glm::dvec2(b.y - a.y, a.x - b.x) / glm::distance(a, b);
        const bool isFree = freeLength > 0.5 * run.length;
        if (isFree && run.street < std::numeric_limits<double>::infinity())
            run.rank = 4;
        else if (isFree)
            run.rank = courts_.contains(0.5 * (a + b) + 0.5 * outward) ? 2 : 3;
        else
            run.rank = exposedArea > 0.0 ? 1 : 0;
        run.size = run.rank == 1 ? exposedArea : run.length;
    }

    static const Run& bestOf(const std::vector<Run>& runs)
    {
        int rank = 0;
        double nearest = std::numeric_limits<double>::infinity();
        bool isLong = false;
        for (const Run& run : runs) rank = std::max(rank, run.rank);
        for (const Run& run : runs) isLong = isLong || (run.rank == rank && run.length >= kShortFront);
        const auto counts = [&](const Run& run) {
            return run.rank == rank && (rank < 4 || !isLong || run.length >= kShortFront);
        };
        for (const Run& run : runs)
            if (counts(run)) nearest = std::min(nearest, run.street);
        const Run* best = nullptr;
        for (const Run& run : runs) {
            if (!counts(run) || (rank == 4 && run.street > nearest + kSameDistance)) continue;
            // A hair of preference for what came first keeps the choice stable for equal edges.
            if (!best || run.size > best->size * (1.0 + 1e-6)) best = &run;
        }
        return *best;
    }

    static void rotate(Footprint& footprint, size_t front)
    {
        const auto turn = [&](auto& list) {
            const auto begin = list.begin();
            std::rotate(begin, begin + long(front), begin + long(footprint.outline.outer.size()));
        };
        turn(footprint.covered);
        if (!footprint.onStreet.empty()) turn(footprint.onStreet);
        turn(footprint.outline.outer);
    }

    // Joins the edges before and after a corner, which is not the first.
    static void join(Footprint& footprint, size_t i)
    {
        Ring2& ring = footprint.outline.outer;
        if (ring.size() <= 3) return;
        const double before = glm::distance(ring[i - 1], ring[i]);
        std::vector<CoveredSpan>& spans = footprint.covered[i - 1];
        for (CoveredSpan span : footprint.covered[i]) {
            span.begin += before, span.end += before;
            if (!spans.empty() && spans.back().height == span.height && span.begin - spans.back().end < 0.01)
                spans.back().end = span.end;
            else
                spans.push_back(span);
        }
        footprint.covered.erase(footprint.covered.begin() + long(i));
        if (!footprint.onStreet.empty()) {
            footprint.onStreet[i - 1] = footprint.onStreet[i - 1] || footprint.onStreet[i];
            footprint.onStreet.erase(footprint.onStreet.begin() + long(i));
        }
        ring.erase(ring.begin() + long(i));
    }

    PolygonIndex courts_;
    std::vector<std::vector<double>> distances_;
};

} // namespace

void chooseFronts(Layout& layout)
{
    const FrontChooser chooser(layout);
    for (size_t f = 0; f < layout.footprints.size(); ++f) chooser.choose(layout.footprints[f], f);
}

} // namespace helio
