// SPDX-License-Identifier: Apache-2.0
// The shipped rule files as architecture: what an architect would object to, over plans of every kind.
#include <algorithm>
#include <map>
#include <set>

#include "city/base/file.h"
#include "city/pack/asset_library.h"
#include "tests/unit/grammar_solid_check.h"
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

struct Case
{
    const char* file;
    double scale;                                                           ///< of the plans
    double height;                                                          ///< m, what the file is made for
    double highest;                                                         ///< m, of its attribute's range
    std::vector<std::pair<const char*, std::vector<const char*>>> variants; ///< attribute, values to go through
};

const Case kCases[] = {
    {"midrise.cga",
     1.0,
     19.0,
     170.0,
     {{"roof", {"mansard", "saddle", "penthouse", "flat"}}, {"balconies", {"none", "first", "every", "run"}}}},
    {"rowhouse.cga", 0.6, 6.4, 60.0, {}},
    {"tower.cga", 2.0, 70.0, 300.0, {{"cladding", {"grid", "bands", "fins"}}}},
};

void PrintTo(const Case& rules, std::ostream* out)
{
    *out << rules.file;
}

std::string textOf(const Case& rules)
{
    auto text = readTextFile(std::filesystem::path(HELIO_RULES_DIR) / rules.file);
    EXPECT_TRUE(text.ok()) << (text.ok() ? "" : text.error().message);
    return text.ok() ? *text : std::string();
}

/// The shipped assets' own boxes.
DeriveOptions shippedAssets(u64 seed)
{
    static AssetLibrary library({HELIO_ASSETS_DIR});
    DeriveOptions options;
    options.jobs = 1;
    options.seed = seed;
    options.assetBox = [](const std::string& name) -> Result<AssetBox> {
        const auto mesh = library.find(name);
        if (!mesh) return mesh.error();
        return AssetBox{(*mesh)->boxMin, (*mesh)->boxMax};
    };
    return options;
}

Ring2 scaled(Ring2 ring, double scale)
{
    for (glm::dvec2& p : ring) p *= scale;
    return ring;
}

/// Box, L, courtyard, triangle; then those that rules must survive: oblique, thin, tiny, with a step of a hand's width.
std::vector<Footprint> plans(double scale, double height, size_t count = 8)
{
    const std::vector<std::pair<Ring2, std::vector<Ring2>>> outlines = {
        {{{0, 0}, {18, 0}, {18, 14}, {0, 14}}, {}},
        {{{0, 0}, {22, 0}, {22, 12}, {12, 12}, {12, 22}, {0, 22}}, {}},
        {{{0, 0}, {30, 0}, {30, 26}, {0, 26}}, {{{10, 10}, {10, 16}, {20, 16}, {20, 10}}}},
        {{{0, 0}, {24, 0}, {4, 20}}, {}},
        {{{0, 0}, {14, -3}, {20, 5}, {16, 14}, {4, 15}, {-3, 7}}, {}},
        {{{0, 0}, {30, 0}, {30, 1.2}, {0, 1.2}}, {}},
        {{{0, 0}, {3, 0}, {3, 3}, {0, 3}}, {}},
        {{{0, 0}, {12, 0}, {12, 0.3}, {12.3, 0.3}, {12.3, 9}, {0, 9}}, {}},
    };
    std::vector<Footprint> result;
    for (size_t k = 0; k < count; ++k) {
        std::vector<Ring2> holes;
        for (const Ring2& hole : outlines[k].second) holes.push_back(scaled(hole, scale));
        result.push_back(footprintOf(scaled(outlines[k].first, scale), height, std::move(holes), concat("plan ", k)));
    }
    return result;
}

/// Calls `check` with the derivation of each of the first `count` plans, for each value of each variant and two seeds.
void forEachBuilding(const Case& rules, size_t count, const std::function<void(const Derivation&)>& check)
{
    const std::string text = textOf(rules);
    const auto once = [&](u64 seed, const char* attribute, const char* value) {
        DeriveOptions options = shippedAssets(seed);
        if (attribute != nullptr) options.attributes[attribute] = std::string(value);
        for (const Footprint& plan : plans(rules.scale, rules.height, count)) {
            SCOPED_TRACE(concat(plan.id, " seed ", seed, " ", attribute ? attribute : "", " ", value ? value : ""));
            check(mustDerive(text, {plan}, options));
        }
    };
    for (u64 seed = 0; seed < 4; ++seed) once(seed, nullptr, nullptr);
    for (const auto& [attribute, values] : rules.variants)
        for (const char* value : values) once(7, attribute, value);
}

class Architecture : public testing::TestWithParam<Case>
{
};

TEST_P(Architecture, HasOverTwentyFiveRules)
{
    const auto rules = parseRules(textOf(GetParam()), GetParam().file);
    ASSERT_TRUE(rules.ok());
    EXPECT_GT(rules->ruleCount(), 25u);
}

// No warning, no polygon without area, nothing that is not finite, whatever the plan and the height.
TEST_P(Architecture, DerivesAnyPlanAtAnyHeightCleanly)
{
    const std::string text = textOf(GetParam());
    for (const double scale : {0.4, 1.0, 2.2})
        for (const double height : {2.2, 4.6, 4.7, 6.0, 9.0, 21.0, 44.9, 45.1, 80.0, 170.0})
            for (u64 seed = 0; seed < 2; ++seed) {
                if (height > GetParam().highest) continue;
                const Derivation d = mustDerive(text, plans(scale, height), shippedAssets(seed));
                EXPECT_TRUE(d.warnings.empty()) << d.warnings[0] << ", height " << height << " scale " << scale;
                for (const Polygon3& polygon : d.shapes.polygons) {
                    ASSERT_TRUE(std::isfinite(area(polygon)));
                    ASSERT_GT(area(polygon), 1e-8);
                }
                for (const Shape& shape : d.shapes.shapes) { // what fills a tile reflects by its own materials
                    if (shape.surface == kNoIndex || shape.asset != kNoIndex) continue;
                    EXPECT_FALSE(d.shapes.surfaces[shape.surface].name.empty()) << d.shapes.names[shape.name];
                }
            }
}

// What a leaf looks at is the front of something, or the sky: a leaf that looked into its own building would see the
// back of another. Rules leave out the undersides of what stands on something, so the check is made on the four plans
// that the files are drawn for.
TEST_P(Architecture, NoLeafLooksIntoItsOwnBuilding)
{
    forEachBuilding(GetParam(), 4, [](const Derivation& d) { EXPECT_EQ(leavesThatSeeABack(d.shapes), ""); });
}

TEST_P(Architecture, EveryAssetTouchesItsBuilding)
{
    forEachBuilding(GetParam(), 8, [](const Derivation& d) {
        for (const SolidBox& box : assetBoxes(d.shapes, shippedAssets(0).assetBox))
            EXPECT_TRUE(touches(box, d.shapes, 0.01)) << box.what << " stands free at " << box.where();
    });
}

TEST_P(Architecture, NoTwoAssetsOverlap)
{
    forEachBuilding(GetParam(), 8, [](const Derivation& d) {
        const std::vector<SolidBox> boxes = assetBoxes(d.shapes, shippedAssets(0).assetBox);
        for (size_t a = 0; a < boxes.size(); ++a)
            for (size_t b = a + 1; b < boxes.size(); ++b)
                EXPECT_FALSE(overlap(boxes[a], boxes[b], 0.01))
                    << boxes[a].what << " and " << boxes[b].what << " at " << boxes[b].where();
    });
}

// A window is a whole rectangle with wall, or another window, to its left and right.
TEST_P(Architecture, NoWindowIsCutAtACorner)
{
    size_t building = 0;
    forEachBuilding(GetParam(), 8, [&](const Derivation& d) {
        size_t checked = 0;
        for (const Shape& shape : d.shapes.shapes) {
            if (shape.asset == kNoIndex) continue;
            const std::string& asset = d.shapes.assets[shape.asset];
            for (const char* kind : {"window_", "door_", "curtain_"}) { // these fill their tiles, and are checked
                if (asset.find(kind) == std::string::npos) continue;
                EXPECT_NE(shape.placement, AssetPlacement::Overlay) << asset;
            }
            if (shape.placement != AssetPlacement::Fill) continue;
            ++checked;
            ASSERT_EQ(shape.polygonCount, 1u);
            const Polygon3& tile = d.shapes.polygons[shape.polygonBegin];
            ASSERT_EQ(tile.outer.size(), 4u) << d.shapes.assets[shape.asset];
            const glm::dvec3 across = tile.outer[1] - tile.outer[0], up = tile.outer[3] - tile.outer[0];
            EXPECT_NEAR(glm::dot(glm::normalize(across), glm::normalize(up)), 0.0, 1e-6);
            expectNear(tile.outer[2], tile.outer[0] + across + up, 1e-6);
            const glm::dvec3 side = 0.03 * glm::normalize(std::abs(across.z) < std::abs(up.z) ? across : up);
            const glm::dvec3 middle = 0.5 * (tile.outer[0] + tile.outer[2]);
            const glm::dvec3 half = 0.5 * (std::abs(across.z) < std::abs(up.z) ? across : up);
            for (const double sign : {-1.0, 1.0})
                EXPECT_TRUE(liesOnALeaf(d.shapes, middle + sign * (half + side), vectorArea(tile)))
                    << d.shapes.assets[shape.asset] << " ends at a corner at " << middle.x << " " << middle.y << " "
                    << middle.z;
        }
        const bool drawnFor = building++ % 8 < 4; // tiny and thin plans may have no windows
        EXPECT_TRUE(checked > 0 || !drawnFor) << "no window";
    });
}

INSTANTIATE_TEST_SUITE_P(Shipped, Architecture, testing::ValuesIn(kCases), [](const auto& which) {
    return std::string(which.param.file).substr(0, std::string(which.param.file).find('.'));
});

/// A rule file in which the solid that a rule is given becomes a leaf, instead of what the rule makes of it.
std::string keepSolid(std::string text, const std::string& rule)
{
    const size_t at = text.find("\n" + rule + " -->");
    EXPECT_NE(at, std::string::npos) << rule;
    if (at != std::string::npos) text.replace(at, rule.size() + 5, "\n" + rule + " --> Solid.\nRest -->");
    return text;
}

// Before comp(f) takes it apart, a roof is closed: each edge is used once in each direction.
TEST(Roofs, AreClosed)
{
    const std::pair<const Case*, std::vector<const char*>> roofs[] = {{&kCases[0], {"MansardBody", "SaddleBody"}},
                                                                      {&kCases[1], {"Roof"}}};
    for (const auto& [rules, names] : roofs)
        for (const char* name : names) {
            const std::string text = keepSolid(textOf(*rules), name);
            DeriveOptions options = shippedAssets(3);
            if (rules == &kCases[0])
                options.attributes["roof"] = std::string(name == std::string("SaddleBody") ? "saddle" : "mansard");
            for (const Footprint& plan : plans(rules->scale, rules->height, 5)) {
                const Derivation d = mustDerive(text, {plan}, options);
                const auto solids = leavesOf(d, "Solid");
                EXPECT_EQ(solids.size(), 1u) << name << " " << plan.id;
                for (const Shape* solid : solids) EXPECT_EQ(openEdges(d.shapes, *solid), 0u) << name << " " << plan.id;
            }
        }
}

double reportOf(const Derivation& d, const std::string& key)
{
    const auto found = d.reports.find(key);
    return found == d.reports.end() ? 0.0 : found->second;
}

// A row-house of 7 x 9 m, by hand. Its walls end 0.3 m sin(45) = 0.212 m below 6.4 m: 6.188 m.
//   Front: 0.35 + 3 m ground floor, 0.25 and 0.2 m bands, 2.388 m left: one floor. Ground floor: ~0.6 | 1.05 door |
//   ~0.6 |
//     { 1.25 window | ~0.8 }*: (7 - 2.25) / 2.05 = 2.3 -> 2. Upper: (7 - 0.8) / 2.05 = 3.02 -> 3.
//   Back and sides: (6.188 - 0.2) / 3 = 1.996 -> 2 floors of ~1 | { 1.25 | ~1.2 }* | ~0.2: (7 - 1.2) / 2.45 = 2.4 -> 2;
//     (9 - 1.2) / 2.45 = 3.2 -> 3. 2 x (2 + 3 + 3) = 16. One window in each of the two gables.
//   2 + 3 + 16 + 2 = 23; a door; a dormer on each of the two slopes.
TEST(Rowhouse, WindowsOfABoxAgreeWithACountByHand)
{
    DeriveOptions options = shippedAssets(1);
    options.attributes = {{"floorH", 3.0},    {"pitch", 45.0}, {"dormers", 1.0}, {"chimneys", 0.0},
                          {"bayWindow", 0.0}, {"houseW", 6.2}, {"gardenD", 0.0}};
    const Derivation d = mustDerive(textOf(kCases[1]), {boxFootprint(7, 9, 6.4)}, options);
    EXPECT_EQ(reportOf(d, "windows"), 23);
    EXPECT_EQ(leavesOf(d, "Window").size(), 23u);
    EXPECT_EQ(reportOf(d, "doors"), 1);
    EXPECT_EQ(leavesOf(d, "Dormer").size(), 2u);
    EXPECT_EQ(leavesOf(d, "Chimney").size(), 0u);
    options.attributes["chimneys"] = 1.0;
    EXPECT_EQ(leavesOf(mustDerive(textOf(kCases[1]), {boxFootprint(7, 9, 6.4)}, options), "Chimney").size(), 2u);
}

// A tower of 36 x 28 x 70 m, by hand. A shaft of 30 x 22 m on a podium of 9 m; 70 - 9 - 4.5 = 56.5 m for two tiers: the
// first has 4 rint(0.62 x 56.5 / 4) = 36 m, the second 20.5 m on 24 x 16 m.
//   Podium: 5.2 m lobby, 0.8 m parapet wall, 3 m: one floor. ~1.1 | { 1.7 window | ~1.1 }*: (36 - 1.1) / 2.8 = 12.5 ->
//   12;
//     (28 - 1.1) / 2.8 = 9.6 -> 10: 44 windows. Entrance: 6.6 m of ~0.3 | { 1.8 door | ~0.3 }*: 3 doors.
//   Tiers: corners of 0.7 m, bands of panels of ~4 m in storeys of ~4 m below 0.6 m. First: (36 - 0.6) / 4 = 8.9 -> 9
//     storeys of 28.6 / 4 -> 7 and 20.6 / 4 -> 5 panels; second: 19.9 / 4 -> 5 of 22.6 / 4 -> 6 and 14.6 / 4 -> 4.
//     9 x 2 x (7 + 5) + 5 x 2 x (6 + 4) = 316.
TEST(Tower, PanelsOfABoxAgreeWithACountByHand)
{
    DeriveOptions options = shippedAssets(1);
    options.attributes = {{"podiumH", 9.0}, {"step", 3.0},   {"tiers", 2.0},
                          {"floorH", 4.0},  {"panelW", 2.0}, {"cladding", std::string("bands")}};
    const Derivation d = mustDerive(textOf(kCases[2]), {boxFootprint(36, 28, 70)}, options);
    EXPECT_EQ(reportOf(d, "windows"), 44);
    EXPECT_EQ(reportOf(d, "panels"), 316);
    EXPECT_EQ(reportOf(d, "doors"), 3);
}

// Mansards of 2.8 m behind slopes of 70 degrees on a free box: all four slopes carry dormers of 1.5 m between ~1.4 m.
// The hips lean inwards by 2.8 / tan(70) = 1.02 m, so the rows are as long as the walls: (18 - 1.4) / 2.9 = 5.7 -> 6
// and (14 - 1.4) / 2.9 = 4.3 -> 4, twice each.
TEST(MidriseAttic, DormersOfABoxAgreeWithACountByHand)
{
    DeriveOptions options = shippedAssets(1);
    options.attributes = {{"roof", std::string("mansard")}, {"atticH", 2.8}};
    const Derivation d = mustDerive(textOf(kCases[0]), {boxFootprint(18, 14, 21)}, options);
    EXPECT_EQ(reportOf(d, "dormers"), 20);
    EXPECT_EQ(leavesOf(d, "Dormer").size(), 20u);
}

// All windows lit, or none: the light hangs on the material, and only windows have it.
TEST(Night, WindowsShineByTheirShare)
{
    for (const Case& rules : kCases)
        for (const double share : {0.0, 1.0}) {
            DeriveOptions options = shippedAssets(1);
            options.attributes = {{"litShare", share}};
            const Derivation d = mustDerive(textOf(rules), {plans(rules.scale, rules.height)[0]}, options);
            size_t lit = 0;
            for (const Shape& shape : d.shapes.shapes) {
                if (shape.surface == kNoIndex || d.shapes.surfaces[shape.surface].emission == glm::dvec4(0.0)) continue;
                ++lit;
                EXPECT_EQ(d.shapes.names[shape.name], "Window");
                EXPECT_EQ(d.shapes.surfaces[shape.surface].name, "lit_window");
            }
            EXPECT_EQ(lit > 20, share == 1.0) << rules.file << " " << lit;
        }
}

} // namespace
} // namespace helio::test
