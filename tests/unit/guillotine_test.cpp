// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "city/model/guillotine.h"

using namespace helio;

namespace {

PlaneBox box(double x0, double y0, double x1, double y1, u32 item)
{
    return {{x0, y0}, {x1, y1}, (x1 - x0) * (y1 - y0), item};
}

std::vector<u32> lowerItems(std::vector<PlaneBox> boxes)
{
    const u32 cut = guillotineCut(boxes);
    std::vector<u32> items;
    for (u32 i = 0; i < cut; ++i) items.push_back(boxes[i].item);
    std::sort(items.begin(), items.end());
    return items;
}

} // namespace

TEST(Guillotine, CutsARowOfBaysInHalf)
{
    std::vector<PlaneBox> row;
    for (u32 i = 0; i < 6; ++i) row.push_back(box(i, 0, i + 1, 3, i));
    EXPECT_EQ(lowerItems(row), (std::vector<u32>{0, 1, 2}));
}

TEST(Guillotine, TakesTheOnlyCutThatNobodyStraddles)
{
    //  +---+---+   A window (1) in its wall: strip 0 left over the full height, 1 to 3 stacked right of it.
    //  |   | 3 |
    //  | 0 | 1 |
    //  |   | 2 |
    //  +---+---+
    EXPECT_EQ(lowerItems({box(0, 0, 1, 3, 0), box(1, 1, 3, 2, 1), box(1, 0, 3, 1, 2), box(1, 2, 3, 3, 3)}),
              (std::vector<u32>{0}));
}

TEST(Guillotine, APinwheelHasNoCleanCutAndStillEnds)
{
    const std::vector<PlaneBox> wheel{box(0, 0, 2, 1, 0), box(2, 0, 3, 2, 1), box(1, 2, 3, 3, 2), box(0, 1, 1, 3, 3),
                                      box(1, 1, 2, 2, 4)};
    const std::vector<u32> lower = lowerItems(wheel);
    EXPECT_GE(lower.size(), 1u);
    EXPECT_LE(lower.size(), 4u);
}

TEST(Guillotine, EqualBoxesAreStillSeparated)
{
    EXPECT_EQ(lowerItems({box(0, 0, 1, 1, 0), box(0, 0, 1, 1, 1)}).size(), 1u);
}
