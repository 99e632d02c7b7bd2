// SPDX-License-Identifier: Apache-2.0
#include "engine/view/patch_values.h"

#include <gtest/gtest.h>

#include "engine/view/legend.h"
#include "tests/support/tile_builder.h"

namespace helio {

namespace {

TEST(PatchValues, LevelsCountAncestors)
{
    TileBuilder b;
    for (int i = 0; i < 4; ++i) b.patch({0, 0, 1}, 1.0f, glm::vec4(0.5f));
    const u32 pair = b.group({0, 1});
    b.group({pair, 2});
    const std::vector<glm::vec4> levels = patchLevels(b.view());
    EXPECT_EQ(levels[0].x, 2.0f);
    EXPECT_EQ(levels[1].x, 2.0f);
    EXPECT_EQ(levels[2].x, 1.0f);
    EXPECT_EQ(levels[3].x, 0.0f);
}

TEST(PatchValues, LinksSpreadOverWhatASenderHolds)
{
    // Patch 0 takes 0.3 from patch 3; its parent takes 0.2 from the pair of 2 and 3, of 4 m2.
    TileBuilder b;
    for (const float area : {1.0f, 1.0f, 1.0f, 3.0f}) b.patch({0, 0, 1}, area, glm::vec4(0.5f));
    const u32 own = b.group({0, 1}), other = b.group({2, 3});
    b.link(0, 3, 0.3f);
    b.link(own, other, 0.2f);
    const std::vector<glm::vec4> values = linksOfPatch(b.view(), 0);
    EXPECT_FLOAT_EQ(values[1].x, 0.0f);
    EXPECT_FLOAT_EQ(values[2].x, 0.05f);
    EXPECT_FLOAT_EQ(values[3].x, 0.15f);
    EXPECT_FLOAT_EQ(values[0].x, 0.15f) << "the picked one shows";
    EXPECT_FLOAT_EQ(linksOfPatch(b.view(), 1)[3].x, 0.05f);
}

TEST(Legend, LiesInACornerAndLeavesSmallPicturesAlone)
{
    Picture picture;
    picture.width = 320;
    picture.height = 100;
    picture.display.assign(size_t(320) * 100 * 4, 77);
    drawLegend(picture, 12.5, "W/m2");
    u32 changed = 0, below = 0;
    for (u32 y = 0; y < 100; ++y)
        for (u32 x = 0; x < 320; ++x) {
            const bool drawn = picture.display[(size_t(y) * 320 + x) * 4] != 77;
            changed += drawn;
            below += drawn && y > 30;
        }
    EXPECT_GT(changed, 1000u);
    EXPECT_EQ(below, 0u);
    Picture small;
    small.width = small.height = 32;
    small.display.assign(32 * 32 * 4, 77);
    drawLegend(small, 1.0, "/m2");
    for (const u8 byte : small.display) EXPECT_EQ(byte, 77);
}

TEST(PatchValues, ExpectedErrorsAreSharesOfTheMeanOfAllLight)
{
    TileBuilder b;
    b.patch({0, 0, 1}, 1.0f, glm::vec4(0.5f));
    b.patch({0, 0, 1}, 3.0f, glm::vec4(0.5f));
    TileView tile = b.view();
    const std::vector<glm::vec4> indirect{{9, 9, 9, 20}, {9, 9, 9, 40}}; // mean 35 in the solar channel
    EXPECT_TRUE(expectedErrors(tile, indirect).empty()) << "the pack knows none";
    const std::vector<float> shares{0.1f, 0.02f};
    tile.patchErrors = shares;
    const std::vector<glm::vec4> errors = expectedErrors(tile, indirect);
    EXPECT_FLOAT_EQ(errors[0].x, 3.5f);
    EXPECT_FLOAT_EQ(errors[1].x, 0.7f);
}

} // namespace

} // namespace helio
