// SPDX-License-Identifier: Apache-2.0
// Rule files written for CityEngine's language, unchanged, with counts that were worked out by hand.
#include "city/base/file.h"
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

Derivation deriveFile(const std::string& name, Footprint footprint, double height,
                      const std::map<std::string, Attribute>& attributes = {})
{
    const auto text = readTextFile(HELIO_TEST_DATA_DIR "/rules/" + name);
    EXPECT_TRUE(text.ok()) << name;
    footprint.height = height;
    DeriveOptions options = unitAssets();
    options.attributes = attributes;
    return mustDerive(text.ok() ? *text : "", {footprint}, options);
}

double windowsOf(const Derivation& d)
{
    const auto found = d.reports.find("windows");
    return found == d.reports.end() ? 0.0 : found->second;
}

// 18 x 14 x 21 m, without neighbours and streets: the front is the first edge, the other three walls are rear facades.
//   Front: 21 m = 4.2 ground + 2.8 mezzanine + noble + { floors } + noble + 0.7 cornice; the rest of 13.3 m holds
//   noble, two floors and noble of ~3.3 m each: with the mezzanine 5 rows of openings. A row is (width - 1) / 2.6 bays.
//   14 m front: 5 bays, 25 windows. Rear: (21 - 0.3) / 3.3 -> 6 floors; (18 - 1.6) / 3.12 -> 5, (14 - 1.6) / 3.12 -> 4:
//   6 x (5 + 5 + 4) = 84. 25 + 84 = 109.
//   18 m front: (18 - 1) / 2.6 = 6.5 -> 7 by the nearer count, 5 x 7 = 35; rear 6 x (4 + 4 + 5) = 78. 35 + 78 = 113.
TEST(ReferenceRules, HaussmannWindows)
{
    const Footprint narrow = footprintOf({{0, 0}, {14, 0}, {14, 18}, {0, 18}}, 21), wide = boxFootprint(18, 14, 21);
    EXPECT_EQ(windowsOf(deriveFile("haussmann_midrise.cga", narrow, 21)), 109);
    EXPECT_EQ(windowsOf(deriveFile("haussmann_midrise.cga", wide, 21)), 113);
}

// 6 x 9 x 6.2 m: two storeys of 2.9 and 3.3 m, bays of ~2.7 m.
//   6 m walls: front 2 bays beside the door and 2 above, back 2 + 2; 9 m walls: 3 + 3 each: 4 + 4 + 6 + 6 = 20. With
//   the 9 m side first: front 3 + 3, back 3 + 3, sides 2 + 2 each: 20 again.
//   Each gable is (3 + 0.35 cos(pitch)) tan(pitch) high, eaves included. GableWall puts a window into one that is more
//   than 2.4 m high: at the file's own pitch of 42 degrees they are 2.94 m high and have one each, at 34 degrees 2.22 m
//   and none.
TEST(ReferenceRules, RowhouseWindows)
{
    for (const Footprint& footprint : {boxFootprint(6, 9, 6.2), boxFootprint(9, 6, 6.2)}) {
        EXPECT_EQ(windowsOf(deriveFile("gabled_rowhouse.cga", footprint, 6.2, {{"pitch", 34.0}})), 20);
        EXPECT_EQ(windowsOf(deriveFile("gabled_rowhouse.cga", footprint, 6.2)), 20 + 2);
    }
}

TEST(ReferenceRules, CountsDoNotHangOnTheSeed)
{
    for (u64 seed = 1; seed < 4; ++seed) {
        DeriveOptions options = unitAssets();
        options.seed = seed;
        for (const auto& [name, footprint, windows] :
             {std::tuple("haussmann_midrise.cga", boxFootprint(18, 14, 21), 113.0),
              std::tuple("gabled_rowhouse.cga", boxFootprint(6, 9, 6.2), 22.0)}) {
            const auto text = readTextFile(std::string(HELIO_TEST_DATA_DIR "/rules/") + name);
            ASSERT_TRUE(text.ok());
            EXPECT_EQ(windowsOf(mustDerive(*text, {footprint}, options)), windows) << name << " seed " << seed;
        }
    }
}

// Neighbours on both sides leave no opening on the walls that they cover, and count no window there.
TEST(ReferenceRules, CoveredWallsHaveNoOpenings)
{
    Footprint box = boxFootprint(18, 14, 21);
    cover(box, 1, 21);
    cover(box, 3, 21);
    EXPECT_EQ(windowsOf(deriveFile("haussmann_midrise.cga", box, 21)), 35 + 30);
    // A neighbour that covers only a part of a rear wall makes it a party wall all the same: the rules ask touches().
    box = boxFootprint(18, 14, 21);
    box.covered[2] = {{2.0, 5.0, 6.0}};
    EXPECT_EQ(windowsOf(deriveFile("haussmann_midrise.cga", box, 21)), 113 - 30);
}

} // namespace
} // namespace helio::test
