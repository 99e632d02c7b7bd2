// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "city/base/result.h"
#include "city/base/types.h"
#include "city/grammar/program.h"

namespace helio::cga {

/// One entry of a split's block: a size, or a repeated pattern.
struct SplitItem
{
    SizeKind kind = SizeKind::Absolute;
    double value = 0.0;             ///< m; for Relative in units of the scope's size
    u32 element = 0;                ///< what the part is made for; returned with it
    std::vector<SplitItem> pattern; ///< not empty: `{ .. }*`, the fields above are unused
};

/// A part of the scope, m from its start.
struct SplitPart
{
    u32 element = 0;
    double begin = 0.0, end = 0.0;
};

/// Lays out a split along an extent of `size` metres.
/// Absolute and relative parts take their size in order; the first that does not fit is cut, later ones are never made.
/// Floating parts and repeats share the rest: a repeat with floating parts is made the whole number of times (at least
/// once) for which the one common stretch of all floating parts is nearest to 1 (halves to the even number); a repeat
/// without is made as often as it fits, the last time cut if it ends the split. Several repeats share the rest evenly.
/// Negative sizes count as 0. A repeat inside a pattern is laid out inside the extent that the pattern gives it.
/// Errors: a repeat without extent, more than kMaxParts parts.
Result<std::vector<SplitPart>> splitParts(double size, const std::vector<SplitItem>& items);

} // namespace helio::cga
