// SPDX-License-Identifier: Apache-2.0
// A search over pairs of levels across the axis: for a lower and an upper level the widest strip between them that no
// edge enters. First all pairs of up to kLevels levels (evenly spaced, and those of the corners where they are few),
// then steps around the best pair, halved down to 1e-9 of the height. The area of a convex polygon's rectangle is
// logarithmically concave in the two levels, so for these the steps end at the largest one.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "city/base/check.h"
#include "city/geometry/offset.h"

namespace helio {

namespace {

constexpr size_t kLevels = 64; ///< evenly spaced ones
constexpr double kSmallest = 1e-3;

/// Open x ranges between levels.
struct Span
{
    double begin, end;

    double width() const { return end - begin; }
};

struct Side
{
    glm::dvec2 a, b;
};

struct Best
{
    double area = 0.0;
    double low = 0.0, high = 0.0;
    Span span{0.0, 0.0};
};

class Search
{
public:
    Search(const Polygon2& polygon, const glm::dvec2& axis) : axis_(axis)
    {
        add(polygon.outer);
        for (const Ring2& hole : polygon.holes) add(hole);
    }

    Best run() const
    {
        const std::vector<double> levels = chooseLevels();
        const size_t count = levels.size() - 1;
        std::vector<std::vector<Span>> rows;
        for (size_t k = 0; k < count; ++k) rows.push_back(freeSpans(levels[k], levels[k + 1]));

        Best best;
        for (size_t from = 0; from < count; ++from) {
            std::vector<Span> spans = rows[from];
            for (size_t to = from; to < count && !spans.empty(); ++to) {
                if (to > from) spans = common(spans, rows[to]);
                for (const Span& span : spans) consider(best, levels[from], levels[to + 1], span);
            }
        }
        if (best.area > 0.0) refine(best, (levels.back() - levels.front()) / double(kLevels));
        return best;
    }

private:
    glm::dvec2 toFrame(const glm::dvec2& p) const { return {glm::dot(axis_, p), cross(axis_, p)}; }

    void add(const Ring2& ring)
    {
        for (size_t k = 0; k < ring.size(); ++k)
            sides_.push_back({toFrame(ring[k]), toFrame(ring[(k + 1) % ring.size()])});
    }

    std::vector<double> chooseLevels() const
    {
        double low = sides_[0].a.y, high = low;
        for (const Side& side : sides_) {
            low = std::min(low, side.a.y);
            high = std::max(high, side.a.y);
        }
        std::vector<double> levels;
        for (size_t k = 0; k <= kLevels; ++k) levels.push_back(low + (high - low) * double(k) / double(kLevels));
        if (sides_.size() <= 2 * kLevels)
            for (const Side& side : sides_) levels.push_back(side.a.y);
        std::sort(levels.begin(), levels.end());
        levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
        return levels;
    }

    /// x ranges whose rectangle between the levels lies inside: no side enters it, and its middle is inside.
    std::vector<Span> freeSpans(double low, double high) const
    {
        std::vector<Span> blocked, spans;
        std::vector<double> crossings; // of the middle level
        const double middle = 0.5 * (low + high);
        for (const Side& side : sides_) {
            const double bottom = std::min(side.a.y, side.b.y), top = std::max(side.a.y, side.b.y);
            if (top <= low || bottom >= high) continue;
            const auto at = [&](double y) {
                if (bottom == top) return side.a.x;
                return side.a.x + (side.b.x - side.a.x) * ((y - side.a.y) / (side.b.y - side.a.y));
            };
            const double p = bottom == top ? side.a.x : at(std::max(low, bottom));
            const double q = bottom == top ? side.b.x : at(std::min(high, top));
            blocked.push_back({std::min(p, q), std::max(p, q)});
            if ((side.a.y <= middle) != (side.b.y <= middle)) crossings.push_back(at(middle));
        }
        const auto byBegin = [](const Span& a, const Span& b) { return a.begin < b.begin; };
        std::sort(blocked.begin(), blocked.end(), byBegin);
        std::sort(crossings.begin(), crossings.end());
        double reached = blocked.empty() ? 0.0 : blocked[0].end;
        for (const Span& block : blocked) {
            if (block.begin > reached) {
                const double x = 0.5 * (reached + block.begin);
                const auto passed = std::lower_bound(crossings.begin(), crossings.end(), x) - crossings.begin();
                if (passed % 2 == 1) spans.push_back({reached, block.begin});
            }
            reached = std::max(reached, block.end);
        }
        return spans;
    }

    static std::vector<Span> common(const std::vector<Span>& a, const std::vector<Span>& b)
    {
        std::vector<Span> both;
        for (size_t i = 0, k = 0; i < a.size() && k < b.size();) {
            const Span span{std::max(a[i].begin, b[k].begin), std::min(a[i].end, b[k].end)};
            if (span.width() > 0.0) both.push_back(span);
            ++(a[i].end < b[k].end ? i : k);
        }
        return both;
    }

    static bool consider(Best& best, double low, double high, const Span& span)
    {
        const double area = (high - low) * span.width();
        // Rounding must not decide between equal ones: the first stays.
        if (std::min(high - low, span.width()) < kSmallest || area <= best.area * (1.0 + 1e-12)) return false;
        best = {area, low, high, span};
        return true;
    }

    void refine(Best& best, double step) const
    {
        for (const double least = step * 1e-8; step > least;) {
            const Best from = best;
            for (int down = -1; down <= 1; ++down)
                for (int up = -1; up <= 1; ++up) {
                    const double low = from.low + step * down, high = from.high + step * up;
                    if (high - low < kSmallest) continue;
                    for (const Span& span : freeSpans(low, high)) consider(best, low, high, span);
                }
            if (best.area == from.area) step *= 0.5;
        }
    }

    glm::dvec2 axis_;
    std::vector<Side> sides_;
};

} // namespace

std::optional<InnerRectangle> innerRectangle(const Polygon2& polygon, const glm::dvec2& axis)
{
    HELIO_CHECK(std::abs(glm::length(axis) - 1.0) < 1e-6, axis.x, " ", axis.y);
    if (polygon.outer.size() < 3) return std::nullopt;
    const Best best = Search(polygon, axis).run();
    if (best.area <= 0.0) return std::nullopt;
    const glm::dvec2 across(-axis.y, axis.x);
    return InnerRectangle{axis * best.span.begin + across * best.low, axis, {best.span.width(), best.high - best.low}};
}

} // namespace helio
