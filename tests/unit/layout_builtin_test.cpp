// SPDX-License-Identifier: Apache-2.0
#include "city/layout/builtin_city.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <set>

#include "city/layout/city_blocks.h"
#include "city/layout/ground.h"
#include "city/layout/polygon_repair.h"

using namespace helio;

namespace {

std::string useOf(const Footprint& footprint)
{
    return std::get<std::string>(footprint.attributes.at("use"));
}

glm::dvec2 corner(const Footprint& footprint, size_t k)
{
    return footprint.outline.outer[k % footprint.outline.outer.size()];
}

bool isCovered(const Footprint& footprint, size_t edge)
{
    return !footprint.covered[edge].empty();
}

// Distance of two segments that do not cross.
double distanceBetween(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d)
{
    const auto toSegment = [](const glm::dvec2& p, const glm::dvec2& s, const glm::dvec2& e) {
        const double t = std::clamp(glm::dot(p - s, e - s) / glm::dot(e - s, e - s), 0.0, 1.0);
        return glm::distance(p, s + t * (e - s));
    };
    return std::min({toSegment(a, c, d), toSegment(b, c, d), toSegment(c, a, b), toSegment(d, a, b)});
}

double distanceBetween(const Footprint& f, const Footprint& g)
{
    double least = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < f.outline.outer.size(); ++i)
        for (size_t k = 0; k < g.outline.outer.size(); ++k)
            least = std::min(least, distanceBetween(corner(f, i), corner(f, i + 1), corner(g, k), corner(g, k + 1)));
    return least;
}

// Kind of the ground at a point; empty where a building stands or only streets are left.
std::string groundAt(const Layout& layout, const glm::dvec2& point)
{
    const auto isIn = [&](const Ring3& ring) { return contains(Ring2(ring.begin(), ring.end()), point); };
    for (const GroundArea& area : layout.ground)
        if (isIn(area.polygon.outer) && std::none_of(area.polygon.holes.begin(), area.polygon.holes.end(), isIn))
            return area.kind;
    return {};
}

TEST(BuiltinCity, IsTheSameForOneSeedAndAnotherForAnother)
{
    const Layout a = builtinCity(3), b = builtinCity(3), c = builtinCity(4);
    ASSERT_EQ(a.footprints.size(), b.footprints.size());
    for (size_t i = 0; i < a.footprints.size(); ++i) {
        EXPECT_EQ(a.footprints[i].id, b.footprints[i].id);
        EXPECT_EQ(a.footprints[i].outline.outer, b.footprints[i].outline.outer);
        EXPECT_EQ(a.footprints[i].height, b.footprints[i].height);
        EXPECT_EQ(a.footprints[i].covered.size(), b.footprints[i].covered.size());
    }
    EXPECT_EQ(a.streets, b.streets);
    EXPECT_NE(a.footprints[0].outline.outer, c.footprints[0].outline.outer);
}

class BuiltinCitySeeds : public testing::TestWithParam<u64>
{
};
INSTANTIATE_TEST_SUITE_P(Seeds, BuiltinCitySeeds, testing::Range<u64>(0, 12));
// Seeds whose first throw puts houses into each other, or crosses one with itself.
INSTANTIATE_TEST_SUITE_P(Clashes, BuiltinCitySeeds, testing::Values<u64>(17, 142));

TEST_P(BuiltinCitySeeds, IsAnOrderlyTown)
{
    const Layout city = builtinCity(GetParam());
    EXPECT_GE(city.footprints.size(), 100u);
    EXPECT_LE(city.footprints.size(), 180u);
    const std::map<std::string, std::pair<double, double>> heights{{"house", {12.0, 27.0}},
                                                                   {"rowhouse", {6.0, 9.5}},
                                                                   {"tower", {40.0, 70.0}},
                                                                   {"workshop", {4.0, 8.0}},
                                                                   {"hall", {5.0, 8.0}}};
    std::set<std::string> ids;
    std::map<std::string, u32> count;
    glm::dvec2 low(1e9), high(-1e9);
    for (const Footprint& footprint : city.footprints) {
        ids.insert(footprint.id);
        ++count[useOf(footprint)];
        EXPECT_TRUE(isSimple(footprint.outline)) << footprint.id;
        EXPECT_GT(signedArea(footprint.outline.outer), 40.0) << footprint.id;
        for (size_t i = 0; i < footprint.outline.outer.size(); ++i)
            EXPECT_GT(glm::distance(corner(footprint, i), corner(footprint, i + 1)), 0.4)
                << footprint.id << " edge " << i;
        EXPECT_EQ(footprint.covered.size(), footprint.outline.outer.size());
        EXPECT_EQ(footprint.onStreet.size(), footprint.outline.outer.size());
        ASSERT_TRUE(heights.contains(useOf(footprint))) << useOf(footprint);
        EXPECT_GE(footprint.height, heights.at(useOf(footprint)).first) << footprint.id;
        EXPECT_LE(footprint.height, heights.at(useOf(footprint)).second) << footprint.id;
        for (const glm::dvec2& p : footprint.outline.outer) {
            low = glm::min(low, p);
            high = glm::max(high, p);
            EXPECT_NEAR(p.x * 1000.0, std::round(p.x * 1000.0), 1e-6);
            EXPECT_NEAR(p.y * 1000.0, std::round(p.y * 1000.0), 1e-6);
        }
    }
    EXPECT_EQ(ids.size(), city.footprints.size());
    EXPECT_GE(count["house"], 70u);
    EXPECT_GE(count["rowhouse"], 24u);
    EXPECT_GE(count["tower"], 2u);
    EXPECT_LE(count["tower"], 4u);
    EXPECT_GT(std::min(high.x - low.x, high.y - low.y), 230.0);
    EXPECT_LT(std::max(high.x - low.x, high.y - low.y), 380.0);
}

TEST_P(BuiltinCitySeeds, NamesTheRuleOfEachKind)
{
    const std::map<std::string, std::string> rules{{"house", "midrise.Lot"},
                                                   {"workshop", "midrise.Lot"},
                                                   {"hall", "midrise.Lot"},
                                                   {"rowhouse", "rowhouse.Lot"},
                                                   {"tower", "tower.Lot"}};
    for (const Footprint& footprint : builtinCity(GetParam()).footprints)
        EXPECT_EQ(footprint.rule, rules.at(useOf(footprint))) << footprint.id;
}

// How far the first block border lies from a point, along a unit vector; infinity if none is met within 40 m.
double wayToBlock(const CityPlan& plan, const glm::dvec2& from, const glm::dvec2& direction)
{
    double least = 40.0;
    bool met = false;
    for (const CityBlock& block : plan.blocks)
        for (size_t i = 0; i < block.outline.size(); ++i) {
            const glm::dvec2 a = block.outline[i], b = block.outline[(i + 1) % block.outline.size()];
            const double side = cross(direction, a - from), other = cross(direction, b - from);
            if ((side > 0.0) == (other > 0.0)) continue;
            const double t = glm::dot(direction, a + (b - a) * (side / (side - other)) - from);
            if (t < 0.0 || t >= least) continue;
            least = t;
            met = true;
        }
    return met ? least : std::numeric_limits<double>::infinity();
}

TEST_P(BuiltinCitySeeds, HasAnAvenueStreetsAndLanes)
{
    Random random(GetParam());
    const CityPlan plan = planCity(random);
    std::map<StreetKind, u32> measured;
    std::set<double> widths;
    for (const CityStreet& street : plan.streets) {
        for (size_t i = 0; i + 1 < street.line.size(); ++i) {
            const glm::dvec2 a = street.line[i], b = street.line[i + 1], left = leftNormal(a, b);
            // Away from the crossings with their cut corners; the median, because lanes open into some streets.
            std::vector<double> samples;
            for (double t = 0.0; t < 1.0; t += 0.05) {
                const glm::dvec2 p = a + t * (b - a);
                if (glm::distance(p, street.line.front()) < 22.0 || glm::distance(p, street.line.back()) < 22.0)
                    continue;
                samples.push_back(wayToBlock(plan, p, left) + wayToBlock(plan, p, -left));
            }
            if (samples.empty()) continue;
            std::sort(samples.begin(), samples.end());
            const double width = samples[samples.size() / 2];
            if (!std::isfinite(width)) continue; // at the border of the town
            ++measured[street.kind];
            widths.insert(std::round(width * 100.0) / 100.0);
            const auto [low, high] = street.kind == StreetKind::Avenue   ? std::pair(20.0, 24.0)
                                     : street.kind == StreetKind::Street ? std::pair(11.0, 14.0)
                                                                         : std::pair(7.0, 8.0);
            EXPECT_GE(width, low - 2e-3) << a.x << " " << a.y;
            EXPECT_LE(width, high + 2e-3) << a.x << " " << a.y;
        }
    }
    EXPECT_EQ(measured[StreetKind::Avenue], 3u); // straight: one part between two crossings
    EXPECT_GE(measured[StreetKind::Street], 6u);
    EXPECT_GE(measured[StreetKind::Lane], 7u);
    EXPECT_GE(widths.size(), 3u);
}

TEST_P(BuiltinCitySeeds, LeavesItsSquareOpen)
{
    const Layout city = builtinCity(GetParam());
    // The widest place without buildings inside the town, found by steps of 2 m, is a green round place.
    glm::dvec2 low(1e9), high(-1e9);
    for (const Footprint& f : city.footprints)
        for (const glm::dvec2& p : f.outline.outer) low = glm::min(low, p), high = glm::max(high, p);
    double widest = 0.0;
    glm::dvec2 centre(0.0);
    for (double x = low.x + 70.0; x < high.x - 70.0; x += 2.0)
        for (double y = low.y + 70.0; y < high.y - 70.0; y += 2.0) {
            const glm::dvec2 p(x, y);
            double nearest = 1e9;
            for (const Footprint& f : city.footprints)
                for (size_t i = 0; i < f.outline.outer.size() && nearest > widest; ++i)
                    nearest = std::min(nearest, distanceBetween(p, p + 1e-6, corner(f, i), corner(f, i + 1)));
            if (nearest > widest) widest = nearest, centre = p;
        }
    EXPECT_GT(widest, 28.0);
    u32 green = 0, paved = 0, looks = 0;
    for (double radius = 2.0; radius < 26.0; radius += 3.0)
        for (double angle = 0.0; angle < 6.28; angle += 0.3, ++looks) {
            const std::string kind = groundAt(city, centre + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
            green += kind == "green";
            paved += kind == "pavement";
        }
    EXPECT_GT(green, looks / 3);
    EXPECT_GT(paved, looks / 10);
}

TEST_P(BuiltinCitySeeds, HasRowsOfHousesBetweenGardens)
{
    const Layout city = builtinCity(GetParam());
    u32 rowEnds = 0, houses = 0;
    for (const Footprint& house : city.footprints) {
        if (useOf(house) != "rowhouse") continue;
        ++houses;
        ASSERT_EQ(house.outline.outer.size(), 4u) << house.id;
        const glm::dvec2 a = corner(house, 0), b = corner(house, 1), along = (b - a) / glm::distance(a, b);
        const double depth = glm::distance(b, corner(house, 2));
        EXPECT_NEAR(glm::distance(a, b), 6.0, 2e-3) << house.id;
        EXPECT_GE(depth, 9.0 - 2e-3) << house.id;
        EXPECT_LE(depth, 10.0 + 2e-3) << house.id;
        // Front and back are free, at least one side is a party wall over its whole depth.
        EXPECT_TRUE(!isCovered(house, 0) && !isCovered(house, 2)) << house.id;
        u32 walls = 0;
        for (const size_t side : {1u, 3u}) {
            if (!isCovered(house, side)) continue;
            EXPECT_NEAR(house.covered[side][0].end - house.covered[side][0].begin, depth, 0.02) << house.id;
            ++walls;
        }
        EXPECT_GE(walls, 1u) << house.id;
        rowEnds += 2 - walls;
        const glm::dvec2 outward(along.y, -along.x);
        EXPECT_EQ(groundAt(city, 0.5 * (a + b) + 1.5 * outward), "green") << house.id;
        EXPECT_EQ(groundAt(city, 0.5 * (a + b) - (depth + 2.0) * outward), "green") << house.id;
    }
    // Two ends a row, and rows of three to eight houses.
    EXPECT_EQ(rowEnds % 2, 0u);
    EXPECT_GE(rowEnds / 2, houses / 8);
    EXPECT_LE(rowEnds / 2, houses / 3);
}

TEST_P(BuiltinCitySeeds, StandsItsTowersFree)
{
    const Layout city = builtinCity(GetParam());
    for (const Footprint& tower : city.footprints) {
        if (useOf(tower) != "tower") continue;
        double widest = 0.0;
        for (size_t i = 0; i < 4; ++i) widest = std::max(widest, glm::distance(corner(tower, i), corner(tower, i + 1)));
        EXPECT_GT(tower.height, 1.8 * widest) << tower.id;
        for (const Footprint& other : city.footprints) {
            if (&other == &tower) continue;
            EXPECT_GE(distanceBetween(tower, other), useOf(other) == "tower" ? 14.99 : 9.99)
                << tower.id << " " << other.id;
        }
    }
}

TEST_P(BuiltinCitySeeds, TurnsItsFrontsToTheStreets)
{
    for (const Footprint& footprint : builtinCity(GetParam()).footprints) {
        const bool isYard = useOf(footprint) == "workshop" || useOf(footprint) == "hall";
        EXPECT_TRUE(isYard || footprint.onStreet[0]) << footprint.id;
        EXPECT_FALSE(isCovered(footprint, 0)) << footprint.id;
    }
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
    for (const Footprint& f : city.footprints)
        for (size_t i = 0; i < f.outline.outer.size(); ++i) heightOf[key(corner(f, i), corner(f, i + 1))] = f.height;
    u32 shared = 0;
    for (const Footprint& f : city.footprints)
        for (size_t i = 0; i < f.outline.outer.size(); ++i) {
            const auto twin = heightOf.find(key(corner(f, i + 1), corner(f, i)));
            ASSERT_EQ(isCovered(f, i), twin != heightOf.end()) << f.id << " edge " << i;
            if (twin == heightOf.end()) continue;
            ASSERT_EQ(f.covered[i].size(), 1u) << f.id << " edge " << i;
            EXPECT_EQ(f.covered[i][0].height, twin->second) << f.id << " edge " << i;
            ++shared;
        }
    EXPECT_GT(shared, city.footprints.size());
}

} // namespace
