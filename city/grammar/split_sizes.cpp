// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/split_sizes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "city/grammar/limits.h"

namespace helio::cga {

namespace {

constexpr double kEpsilon = 1e-9; ///< m: smaller parts are not made

/// Sums of a list of items: what is fixed and what floats, m.
struct Extent
{
    double fixed = 0.0, floating = 0.0;
};

double fixedSize(const SplitItem& item, double size)
{
    return std::max(0.0, item.kind == SizeKind::Relative ? item.value * size : item.value);
}

Extent extentOf(const std::vector<SplitItem>& items, double size);

/// A nested pattern inside a pattern counts as one part: floating if anything in it floats.
Extent extentOf(const SplitItem& item, double size)
{
    if (!item.pattern.empty()) {
        const Extent inner = extentOf(item.pattern, size);
        if (inner.floating > 0.0) return {0.0, inner.fixed + inner.floating};
        return inner;
    }
    if (item.kind == SizeKind::Floating) return {0.0, std::max(0.0, item.value)};
    return {fixedSize(item, size), 0.0};
}

Extent extentOf(const std::vector<SplitItem>& items, double size)
{
    Extent sum;
    for (const SplitItem& item : items) {
        const Extent extent = extentOf(item, size);
        sum.fixed += extent.fixed;
        sum.floating += extent.floating;
    }
    return sum;
}

class Layout
{
public:
    /// Lays the items out over [begin, begin + size]; relative sizes refer to `whole`.
    void run(double begin, double size, double whole, const std::vector<SplitItem>& items)
    {
        Extent plain;
        size_t patternCount = 0;
        for (const SplitItem& item : items) {
            patternCount += item.pattern.empty() ? 0 : 1;
            if (!item.pattern.empty()) continue;
            const Extent extent = extentOf(item, whole);
            plain.fixed += extent.fixed;
            plain.floating += extent.floating;
        }
        const double rest = size - plain.fixed, share = patternCount > 0 ? rest / double(patternCount) : 0.0;
        Extent repeated;
        std::vector<double> counts(items.size(), 1.0);
        for (size_t k = 0; k < items.size() && !failed(); ++k) {
            if (items[k].pattern.empty()) continue;
            const Extent once = extentOf(items[k].pattern, whole);
            counts[k] = repeats(once, share - plain.floating, share, plain.floating <= 0.0 && k + 1 == items.size());
            repeated.fixed += counts[k] * once.fixed;
            repeated.floating += counts[k] * once.floating;
        }
        if (failed()) return;
        const double floating = plain.floating + repeated.floating;
        const double stretch = floating > 0.0 ? std::max(0.0, (rest - repeated.fixed) / floating) : 1.0;
        double at = 0.0;
        for (size_t k = 0; k < items.size(); ++k) {
            if (items[k].pattern.empty()) {
                add(items[k], begin, at, size, whole, stretch);
                continue;
            }
            for (double n = 0.0; n < counts[k]; ++n)
                for (const SplitItem& item : items[k].pattern) add(item, begin, at, size, whole, stretch);
        }
    }

    bool failed() const { return error.has_value(); }

    std::vector<SplitPart> parts;
    std::optional<Error> error;

private:
    /// How often a pattern is made in `share` metres, of which `room` are left after the floating parts outside it.
    double repeats(const Extent& once, double room, double share, bool cutLast)
    {
        if (once.fixed + once.floating <= kEpsilon) {
            error = Error{"the repeated block has no extent: give its parts sizes above 0"};
            return 0.0;
        }
        double count;
        if (once.floating > 0.0) {
            // nearbyint rounds halves to the even number, as in the reference.
            count = std::max(1.0, std::nearbyint(room / (once.fixed + once.floating)));
            if (count <= kMaxParts)
                while (count > 1.0 && share - count * once.fixed <= kEpsilon) --count;
        } else {
            count = std::max(0.0, cutLast ? std::ceil(room / once.fixed - kEpsilon)
                                          : std::floor(room / once.fixed + kEpsilon));
        }
        if (count > kMaxParts) {
            error = Error{concat("the block would be repeated ", u64(std::min(count, 1e18)), " times; at most ",
                                 kMaxParts, " parts are made: use larger sizes")};
            return 0.0;
        }
        return count;
    }

    void add(const SplitItem& item, double begin, double& at, double size, double whole, double stretch)
    {
        if (failed()) return;
        const Extent extent = extentOf(item, whole);
        const double width = std::min(extent.fixed + extent.floating * stretch, size - at);
        if (width <= kEpsilon) return;
        if (!item.pattern.empty()) {
            run(begin + at, width, whole, {item});
        } else if (parts.size() >= kMaxParts) {
            error = Error{concat("the split makes more than ", kMaxParts, " parts: use larger sizes")};
        } else {
            parts.push_back({item.element, begin + at, begin + at + width});
        }
        at += width;
    }
};

} // namespace

Result<std::vector<SplitPart>> splitParts(double size, const std::vector<SplitItem>& items)
{
    if (size <= kEpsilon) return std::vector<SplitPart>{};
    Layout layout;
    layout.run(0.0, size, size, items);
    if (layout.error) return *layout.error;
    return std::move(layout.parts);
}

} // namespace helio::cga
