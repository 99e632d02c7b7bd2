// SPDX-License-Identifier: Apache-2.0
// The shipped rule file, with the shipped assets' names and boxes.
#include "city/base/file.h"
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

const std::string& midrise()
{
    static const std::string text = [] {
        auto file = readTextFile(HELIO_RULES_DIR "/midrise.cga");
        EXPECT_TRUE(file.ok());
        return file.ok() ? *file : std::string();
    }();
    return text;
}

/// Fixed attributes, so that counts do not hang on the seed.
DeriveOptions plain()
{
    DeriveOptions options = unitAssets();
    options.attributes = {{"groundH", 4.0},
                          {"floorH", 3.2},
                          {"winW", 1.2},
                          {"pierW", 1.4},
                          {"shops", 0.0},
                          {"balconies", std::string("none")},
                          {"windows", std::string("sash")},
                          {"hoods", 0.0},
                          {"roof", std::string("flat")}};
    return options;
}

double lowest(const Polygon3& polygon)
{
    double low = INFINITY;
    for (const glm::dvec3& p : polygon.outer) low = std::min(low, p.z);
    return low;
}

double reportOf(const Derivation& d, const std::string& key)
{
    const auto found = d.reports.find(key);
    return found == d.reports.end() ? 0.0 : found->second;
}

double wallArea(const Footprint& f)
{
    double sum = 0.0;
    const auto walls = [&](const Ring2& ring) {
        for (size_t k = 0; k < ring.size(); ++k) sum += f.height * glm::distance(ring[k], ring[(k + 1) % ring.size()]);
    };
    walls(f.outline.outer);
    for (const Ring2& hole : f.outline.holes) walls(hole);
    return sum;
}

// Windows of a free-standing box of 18 x 14 x 21 m, by hand. Front (18 m) and both sides (14 m) are street facades, the
// back a court.
//   Street: 4 m ground floor, 0.6 m cornice, 16.4 m for floors of ~3.2 m: 16.4 / 3.2 = 5.1 -> 5 floors of 3.28 m.
//     A floor is { ~1.4 pier | 1.2 window }* with a closing ~1.4 pier: (18 - 1.4) / 2.6 = 6.4 -> 6 windows; (14 - 1.4)
//     / 2.6 = 4.8 -> 5. 5 x (6 + 5 + 5) = 80.
//   Ground: ~1.4 | { 1.4 window | ~1.4 }* | 1.5 door | ~0.98: (18 - 1.5 - 2.38) / 2.8 = 5.04 -> 5; (14 - 1.5 - 2.38)
//   / 2.8 = 3.6 -> 4.
//     5 + 4 + 4 = 13, and 3 doors.
//   Back: 21 - 0.5 = 20.5 m for floors of ~3.2 m: 6.4 -> 6. A floor is { ~2.1 | 1.2 }* ~2.1: (18 - 2.1) / 3.3 = 4.8
//   -> 5. 6 x 5 = 30. 80 + 13 + 30 = 123.
TEST(Midrise, WindowsOfAPlainBoxAgreeWithACountByHand)
{
    const Derivation d = mustDerive(midrise(), {boxFootprint(18, 14, 21)}, plain());
    EXPECT_EQ(reportOf(d, "windows"), 123);
    EXPECT_EQ(reportOf(d, "doors"), 3);
    EXPECT_EQ(leavesOf(d, "Window").size(), 123u);
    EXPECT_NEAR(reportOf(d, "facade.street.area"), 21 * (18 + 14 + 14), 1e-9);
    EXPECT_TRUE(d.warnings.empty()) << d.warnings[0];
}

// A neighbour covers the left side to 10 m. Bays that it touches have no windows: ground (0-4), 4-7.28 and 7.28-10.56 lose
// 4 + 5 + 5. One that is as high as the wall takes all: 4 + 5 x 5.
TEST(Midrise, CoveredWallsAreBlank)
{
    Footprint box = boxFootprint(18, 14, 21);
    cover(box, 3, 10);
    EXPECT_EQ(reportOf(mustDerive(midrise(), {box}, plain()), "windows"), 123 - 14);
    cover(box, 3, 21);
    EXPECT_EQ(reportOf(mustDerive(midrise(), {box}, plain()), "windows"), 123 - 29);
    // Only 5 of 14 m, from the front corner: each floor is pier, window, .. of 1.375 + 1.2 m, and of the windows that
    // begin at 1.375, 3.95 and 6.525 m from a corner two are touched; the ground floor is mirrored by its door.
    box.covered.at(3) = {{0.0, 5.0, 21.0}};
    const double windows = reportOf(mustDerive(midrise(), {box}, plain()), "windows");
    EXPECT_GE(windows, 123 - 5 * 2 - 2);
    EXPECT_LE(windows, 123 - 5 * 2 - 1);
}

TEST(Midrise, ShopsAndBalconies)
{
    DeriveOptions options = plain();
    options.attributes["shops"] = 1.0;
    options.attributes["balconies"] = std::string("first");
    const Derivation d = mustDerive(midrise(), {boxFootprint(18, 14, 21)}, options);
    // Front: ~0.45 | { ~2.9 shop | ~0.45 }* | 1.5 door | ~0.45: (18 - 1.5 - 0.9) / 3.35 = 4.7 -> 5 shops instead of 5
    // windows.
    EXPECT_EQ(reportOf(d, "shops"), 5);
    EXPECT_EQ(reportOf(d, "windows"), 123 - 5);
    EXPECT_EQ(reportOf(d, "balconies"), 6 + 5 + 5); // the first floor of front and sides
    EXPECT_TRUE(d.warnings.empty()) << d.warnings[0];
}

TEST(Midrise, EveryShapeOfFootprintIsCoveredOnce)
{
    const Ring2 square = {{0, 0}, {24, 0}, {24, 24}, {0, 24}};
    std::vector<std::pair<Ring2, std::vector<Ring2>>> outlines = {
        {{{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 20}, {0, 20}}, {}},         // L
        {square, {{{8, 8}, {8, 16}, {16, 16}, {16, 8}}}},                   // courtyard
        {{{0, 0}, {15, 0}, {0, 9}}, {}},                                    // triangle
        {{{0, 0}, {12, 0}, {12, 0.3}, {12.3, 0.3}, {12.3, 9}, {0, 9}}, {}}, // edges of 0.3 m
        {{{0, 0}, {30, 0}, {30, 1.2}, {0, 1.2}}, {}},                       // thin
        {{{0, 0}, {3, 0}, {3, 3}, {0, 3}}, {}},                             // shed
        {{{0, 0}, {14, -3}, {20, 5}, {16, 14}, {4, 15}, {-3, 7}}, {}},      // oblique
    };
    for (const double height : {2.2, 4.6, 4.7, 6.0, 9.0, 21.0, 44.9, 45.1, 170.0})
        for (size_t k = 0; k < outlines.size(); ++k)
            for (u64 seed = 0; seed < 3; ++seed) {
                DeriveOptions options = unitAssets();
                options.seed = seed;
                options.attributes["roof"] = std::string("flat");
                const Footprint footprint = footprintOf(outlines[k].first, height, outlines[k].second);
                const Derivation d = mustDerive(midrise(), {footprint}, options);
                EXPECT_TRUE(d.warnings.empty()) << d.warnings[0];
                // Walls end at the height; above it are parapets of 0.7 m, which take the roof's place.
                double walls = 0.0, level = 0.0, parapets = 0.0;
                for (const Polygon3& polygon : d.shapes.polygons) {
                    const glm::dvec3 normal = vectorArea(polygon);
                    const double low = lowest(polygon);
                    level += std::max(0.0, normal.z);
                    if (low < height - 1e-6) walls += area(polygon);
                    if (low > height + 0.6) parapets += normal.z;
                }
                EXPECT_NEAR(walls, wallArea(footprint), 1e-7 * walls) << "outline " << k << " height " << height;
                // Setbacks and offsets are on a grid of 0.1 mm.
                const double grid = 1e-4 * wallArea(footprint) / height;
                EXPECT_NEAR(level, area(footprint.outline), grid) << "outline " << k << " height " << height;
                // Closed but for the ground at z = 0, which adds nothing to the sum: every leaf looks outward.
                const double volume = area(footprint.outline) * height + 0.7 * parapets;
                EXPECT_NEAR(enclosedVolume(d), volume, grid * height) << "outline " << k << " height " << height;
            }
}

// No opening within 0.25 m of an upright edge of its wall, and none narrower than 0.8 m or lower than 0.6 m.
TEST(Midrise, OpeningsKeepClearOfCorners)
{
    for (double width = 0.3; width < 30; width *= 1.15)
        for (const double height : {4.7, 7.5, 12.0, 21.0, 60.0})
            for (u64 seed = 0; seed < 2; ++seed) {
                DeriveOptions options = unitAssets();
                options.seed = seed;
                const Derivation d = mustDerive(midrise(), {boxFootprint(width, 13, height)}, options);
                for (const Shape& shape : d.shapes.shapes) {
                    if (shape.placement != AssetPlacement::Fill) continue;
                    const auto [low, high] = boundsOf(d, shape);
                    const bool alongX = high.x - low.x > high.y - low.y;
                    const double margin = alongX ? std::min(low.x, width - high.x) : std::min(low.y, 13 - high.y);
                    EXPECT_GT(margin, height > 45 ? 0.1 : 0.25) << "width " << width << " height " << height;
                    EXPECT_GT(std::max(high.x - low.x, high.y - low.y), 0.8)
                        << "width " << width << " height " << height;
                    EXPECT_GT(high.z - low.z, 0.6) << "width " << width << " height " << height;
                }
            }
}

TEST(Midrise, BuildingsDifferInColour)
{
    std::vector<Footprint> row;
    for (int k = 0; k < 200; ++k) {
        row.push_back(boxFootprint(12, 12, 15));
        row.back().id = concat("house ", k);
    }
    const Derivation d = mustDerive(midrise(), row);
    std::map<std::string, int> walls; // name and red : blue in tenths
    std::vector<bool> seen(row.size(), false);
    for (const Shape& shape : d.shapes.shapes) {
        if (d.shapes.names[shape.name] != "Render" && d.shapes.names[shape.name] != "Wall") continue;
        if (shape.surface == kNoIndex || seen[shape.building]) continue;
        const Surface& surface = d.shapes.surfaces[shape.surface];
        if (surface.name != "render" && surface.name != "brick_red") continue;
        seen[shape.building] = true;
        ++walls[concat(surface.name, " ", int(10 * surface.rho.r / surface.rho.b))];
    }
    EXPECT_GE(walls.size(), 6u); // ochre, cream, rose, grey, brick, sage
    for (const auto& [wall, count] : walls) EXPECT_LT(count, 100) << wall;
}

TEST(Midrise, HasTwentyRulesAndItsAttributes)
{
    const auto rules = parseRules(midrise(), "midrise.cga");
    ASSERT_TRUE(rules.ok());
    EXPECT_GE(rules->ruleCount(), 20u);
    const auto names = rules->attributeNames();
    EXPECT_NE(std::find(names.begin(), names.end(), "height"), names.end());
}

} // namespace
} // namespace helio::test
