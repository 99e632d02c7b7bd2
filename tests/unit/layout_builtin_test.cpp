// SPDX-License-Identifier: Apache-2.0
#include "city/layout/builtin_city.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <set>

#include "city/layout/ground.h"
#include "city/layout/polygon_repair.h"

using namespace helio;

namespace {

TEST(BuiltinCity, IsTheSameForOneSeedAndAnotherForAnother)
{
    const Layout a = builtinCity(3), b = builtinCity(3), c = builtinCity(4);
    ASSERT_EQ(a.footprints.size(), b.footprints.size());
    for (size_t i = 0; i < a.footprints.size(); ++i) {
        EXPECT_EQ(a.footprints[i].id, b.footprints[i].id);
        EXPECT_EQ(a.footprints[i].outline.outer, b.footprints[i].outline.outer);
        EXPECT_EQ(a.footprints[i].height, b.footprints[i].height);
        EXPECT_EQ(a.footprints[i].coveredHeight, b.footprints[i].coveredHeight);
    }
    EXPECT_NE(a.footprints[0].outline.outer, c.footprints[0].outline.outer);
}

class BuiltinCitySeeds : public testing::TestWithParam<u64>
{
};
INSTANTIATE_TEST_SUITE_P(Seeds, BuiltinCitySeeds, testing::Range<u64>(0, 12));
// Seeds whose first throw puts houses into each other, or crosses one with itself.
INSTANTIATE_TEST_SUITE_P(Clashes, BuiltinCitySeeds, testing::Values<u64>(37, 308));

TEST_P(BuiltinCitySeeds, IsAnOrderlyTown)
{
    const Layout city = builtinCity(GetParam());
    EXPECT_GE(city.footprints.size(), 60u);
    EXPECT_LE(city.footprints.size(), 120u);
    std::set<std::string> ids;
    u32 towers = 0;
    glm::dvec2 low(1e9), high(-1e9);
    for (const Footprint& footprint : city.footprints) {
        ids.insert(footprint.id);
        EXPECT_TRUE(isSimple(footprint.outline)) << footprint.id;
        EXPECT_GT(signedArea(footprint.outline.outer), 40.0) << footprint.id;
        EXPECT_EQ(footprint.coveredHeight.size(), footprint.outline.outer.size());
        const bool isYard = std::get<std::string>(footprint.attributes.at("use")) == "workshop";
        EXPECT_GE(footprint.height, isYard ? 4.0 : 12.0) << footprint.id;
        EXPECT_LE(footprint.height, 36.0) << footprint.id;
        towers += footprint.height > 26.0;
        for (const glm::dvec2& corner : footprint.outline.outer) {
            low = glm::min(low, corner);
            high = glm::max(high, corner);
            EXPECT_NEAR(corner.x * 1000.0, std::round(corner.x * 1000.0), 1e-6);
        }
    }
    EXPECT_EQ(ids.size(), city.footprints.size());
    EXPECT_GE(towers, 1u);
    EXPECT_LE(towers, 8u);
    EXPECT_GT(std::min(high.x - low.x, high.y - low.y), 200.0);
    EXPECT_LT(std::max(high.x - low.x, high.y - low.y), 350.0);
}

TEST_P(BuiltinCitySeeds, TilesItsGroundAndOverlapsNowhere)
{
    Layout city = builtinCity(GetParam());
    double built = 0.0;
    glm::dvec2 low(1e9), high(-1e9);
    for (const Footprint& footprint : city.footprints) {
        built += area(footprint.outline);
        for (const glm::dvec2& corner : footprint.outline.outer) {
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
    }
    addGround(city, {.margin = 30.0});
    double ground = 0.0;
    std::set<std::string> kinds;
    for (const GroundArea& piece : city.ground) {
        ground += area(piece.polygon);
        kinds.insert(piece.kind);
    }
    EXPECT_EQ(kinds, (std::set<std::string>{"court", "green", "pavement", "street"}));
    // Houses that overlapped would leave more ground than rectangle less sum.
    const double rectangle = (high.x - low.x + 60.0) * (high.y - low.y + 60.0);
    EXPECT_NEAR(ground, rectangle - built, 1e-6 * rectangle + 0.05 * 8);
}

TEST_P(BuiltinCitySeeds, SharesTheCornersOfPartyWalls)
{
    // Each covered edge runs between the same two corners as an edge of a neighbour, in the other direction.
    const Layout city = builtinCity(GetParam());
    std::map<std::array<double, 4>, double> heightOf;
    const auto key = [](const glm::dvec2& a, const glm::dvec2& b) { return std::array<double, 4>{a.x, a.y, b.x, b.y}; };
    const auto edges = [&](auto&& visit) {
        for (const Footprint& footprint : city.footprints) {
            const Ring2& ring = footprint.outline.outer;
            for (size_t i = 0; i < ring.size(); ++i) visit(footprint, i, ring[i], ring[(i + 1) % ring.size()]);
        }
    };
    edges(
        [&](const Footprint& f, size_t, const glm::dvec2& a, const glm::dvec2& b) { heightOf[key(a, b)] = f.height; });
    u32 shared = 0;
    edges([&](const Footprint& f, size_t i, const glm::dvec2& a, const glm::dvec2& b) {
        const auto twin = heightOf.find(key(b, a));
        EXPECT_EQ(f.coveredHeight[i], twin == heightOf.end() ? 0.0 : twin->second) << f.id << " edge " << i;
        shared += twin != heightOf.end();
    });
    EXPECT_GT(shared, city.footprints.size());
    for (const Footprint& footprint : city.footprints) EXPECT_EQ(footprint.coveredHeight[0], 0.0) << footprint.id;
}

} // namespace
