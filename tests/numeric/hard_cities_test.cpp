// SPDX-License-Identifier: Apache-2.0
// Footprints that are hard on a city, from the import to the solved light.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <numbers>
#include <sstream>

#include "city/grammar/derive.h"
#include "city/layout/ground.h"
#include "city/layout/import.h"
#include "city/light/sun.h"
#include "tests/numeric/lit_scene.h"

using namespace helio;
using namespace helio::test;

namespace {

constexpr const char* kRules = "attr height = 10\nLot --> extrude(height) comp(f) { side : Wall. | top : Roof. }\n";

struct House
{
    Ring2 outline;
    double height;
};

House box(double x, double y, double width, double depth, double height)
{
    return {{{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}}, height};
}

House turnedBox(const glm::dvec2& centre, double width, double depth, double height, double angle)
{
    House house = box(-width / 2, -depth / 2, width, depth, height);
    for (glm::dvec2& p : house.outline) {
        const double c = std::cos(angle), s = std::sin(angle);
        p = centre + glm::dvec2(c * p.x - s * p.y, s * p.x + c * p.y);
    }
    return house;
}

std::string geoJson(const std::vector<House>& houses, const glm::dvec2& offset)
{
    std::ostringstream out;
    out.precision(17);
    out << R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:32633"}},"features":[)";
    for (size_t k = 0; k < houses.size(); ++k) {
        out << (k > 0 ? "," : "") << R"({"type":"Feature","id":"h)" << k << R"(","properties":{"height":)"
            << houses[k].height << R"(},"geometry":{"type":"Polygon","coordinates":[[)";
        Ring2 ring = houses[k].outline;
        ring.push_back(ring.front());
        for (size_t i = 0; i < ring.size(); ++i)
            out << (i > 0 ? "," : "") << '[' << ring[i].x + offset.x << ',' << ring[i].y + offset.y << ']';
        out << "]]}}";
    }
    out << "]}";
    return out.str();
}

struct City
{
    Layout layout;
    LitScene scene;
    double openArea = 0.0; ///< of the rectangle that ground and buildings fill, m2
};

City lightCity(const std::vector<House>& houses, const Daylight& daylight, const glm::dvec2& offset = {0, 0})
{
    City city;
    Result<Layout> layout = parseCity(geoJson(houses, offset), "city.geojson");
    EXPECT_TRUE(layout.ok()) << (layout.ok() ? "" : layout.error().message);
    if (!layout.ok()) return city;
    city.layout = std::move(*layout);
    addGround(city.layout, {.cellSize = 5.0});
    const Result<RuleSet> rules = parseRules(kRules, "hard.cga");
    EXPECT_TRUE(rules.ok()) << (rules.ok() ? "" : rules.error().message);
    Result<Derivation> derived = derive(*rules, city.layout.footprints, {});
    EXPECT_TRUE(derived.ok()) << (derived.ok() ? "" : derived.error().message);
    if (!derived.ok()) return city;
    appendGround(derived->shapes, city.layout);
    for (const GroundArea& area : city.layout.ground) city.openArea += glm::length(vectorArea(area.polygon));
    for (const Footprint& footprint : city.layout.footprints) city.openArea += area(footprint.outline);
    city.scene = lightScene(buildNodes(derived->shapes, {}).tree, daylight);
    return city;
}

Daylight afternoon()
{
    Daylight light;
    light.toSun = sunDirection(3.6, 0.66);
    return light;
}

/// Shadows end on the ground, so the sun that falls on its outline falls on something.
void expectWholeCity(const City& city, const Daylight& light)
{
    ASSERT_GT(city.scene.tree.patchCount(), 100u);
    expectPhysical(city.scene, light);
    EXPECT_NEAR(city.scene.flux([&](u32 i) { return city.scene.sun[i]; }) / (light.dni * light.toSun.z * city.openArea),
                1.0, 5e-3);
    for (u32 i = 0; i < city.scene.tree.patchCount(); ++i) {
        if (!city.scene.tree.patches[i].covered) continue;
        EXPECT_EQ(city.scene.irradiance(i), 0.0) << "covered patch " << i;
    }
}

/// Fluxes of sun, sky and patches, W, that arrive on the roofs, the ground, and the walls to the four sides.
std::array<double, 6> fluxesOf(const City& city)
{
    std::array<double, 6> out{};
    for (u32 i = 0; i < city.scene.tree.patchCount(); ++i) {
        const Node& node = city.scene.tree.nodes[i];
        size_t kind = 0;
        if (node.normal.z > 0.5)
            kind = city.scene.tree.patches[i].building == kNoIndex ? 1 : 0;
        else if (std::abs(node.normal.x) > std::abs(node.normal.y))
            kind = node.normal.x > 0.0 ? 2 : 3;
        else
            kind = node.normal.y > 0.0 ? 4 : 5;
        out[kind] += node.area * city.scene.irradiance(i);
    }
    return out;
}

void expectSameCity(const City& a, const City& b, double tolerance)
{
    const std::array<double, 6> fluxA = fluxesOf(a), fluxB = fluxesOf(b);
    const char* const names[] = {"roofs", "ground", "east", "west", "north", "south"};
    for (size_t k = 0; k < 6; ++k) {
        EXPECT_GT(fluxA[k], 0.0) << names[k];
        EXPECT_NEAR(fluxB[k] / fluxA[k], 1.0, tolerance) << names[k];
    }
}

} // namespace

TEST(HardCities, TouchingHousesAreOneHouse)
{
    const Daylight light = afternoon();
    const City one = lightCity({box(0, 0, 20, 10, 10)}, light),
               two = lightCity({box(0, 0, 10, 10, 10), box(10, 0, 10, 10, 10)}, light);
    expectWholeCity(one, light);
    expectWholeCity(two, light);
    expectSameCity(one, two, 0.01);
    u32 covered = 0;
    for (const Patch& patch : two.scene.tree.patches) covered += patch.covered;
    EXPECT_GT(covered, 0u) << "the walls between them";
}

TEST(HardCities, AMillimetreBetweenHousesIsNone)
{
    const Daylight light = afternoon();
    const City touching = lightCity({box(0, 0, 10, 10, 10), box(10, 0, 10, 10, 14)}, light),
               apart = lightCity({box(0, 0, 10, 10, 10), box(10.001, 0, 10, 10, 14)}, light);
    expectWholeCity(touching, light);
    expectWholeCity(apart, light);
    expectSameCity(touching, apart, 0.01);
}

TEST(HardCities, OverlappingHousesAreTheirUnion)
{
    // The lower house loses what both share.
    const Daylight light = afternoon();
    const City overlapping = lightCity({box(0, 0, 10, 10, 10), box(5, 5, 10, 10, 15)}, light);
    const House ell{{{0, 0}, {10, 0}, {10, 5}, {5, 5}, {5, 10}, {0, 10}}, 10};
    const City separate = lightCity({ell, box(5, 5, 10, 10, 15)}, light);
    expectWholeCity(overlapping, light);
    expectWholeCity(separate, light);
    expectSameCity(separate, overlapping, 0.01);
}

TEST(HardCities, InterpenetratingHousesKeepTheSun)
{
    const Daylight light = afternoon();
    const City city = lightCity({box(0, 0, 16, 12, 9), turnedBox({8, 6}, 11, 19, 13, 0.5),
                                 turnedBox({14, 10}, 9, 8, 13, 1.1), box(0, 0, 16, 12, 9)},
                                light);
    expectWholeCity(city, light);
    EXPECT_FALSE(city.layout.notes.empty()) << "what was cut, and the house that was there twice";
}

TEST(HardCities, SliverHousesAreLitOrLeftOut)
{
    // A wall of 0.15 x 12 m beside a house; one of 0.05 m, and one of 0.5 m2, which are none.
    const Daylight light = afternoon();
    const City city = lightCity(
        {box(0, 0, 10, 12, 9), box(10, 0, 0.15, 12, 11), box(20, 0, 0.05, 12, 9), box(24, 0, 0.5, 1, 3)}, light);
    expectWholeCity(city, light);
    EXPECT_EQ(city.layout.footprints.size(), 2u);
    EXPECT_GE(city.layout.notes.size(), 2u);
}

TEST(HardCities, HousesOfOneFacadeShareItsLight)
{
    // Coplanar facades of two houses, and the facade of one: equal light on all of it but its ends.
    const Daylight light = afternoon();
    const City city = lightCity({box(0, 0, 8, 10, 10), box(8, 0, 8, 10, 10), box(0, -14, 16, 6, 7)}, light);
    expectWholeCity(city, light);
    const auto meanOf = [&](double x0, double x1) {
        return city.scene.mean([&](u32 i) { return city.scene.irradiance(i); },
                               [&](u32 i) {
                                   const Node& node = city.scene.tree.nodes[i];
                                   const glm::dvec3 c = node.centroid + city.layout.origin;
                                   return node.normal.y < -0.9 && c.y > -1.0 && c.x > x0 && c.x < x1;
                               });
    };
    EXPECT_GT(meanOf(0, 8), 1.0);
    EXPECT_NEAR(meanOf(8, 16) / meanOf(0, 8), 1.0, 0.1);
    // Patches of one plane exchange nothing, whichever house they belong to.
    const std::vector<double> dense = denseFactors(city.scene.tree, city.scene.bake.links);
    const u32 n = city.scene.tree.patchCount();
    for (u32 i = 0; i < n; ++i)
        for (u32 j = 0; j < n; ++j) {
            const Node &a = city.scene.tree.nodes[i], &b = city.scene.tree.nodes[j];
            const bool level = glm::dot(a.normal, b.normal) > 1.0 - 1e-9 &&
                               std::abs(glm::dot(a.normal, b.centroid - a.centroid)) < 1e-9;
            if (level) {
                ASSERT_EQ(dense[size_t(i) * n + j], 0.0) << i << " " << j;
            }
        }
}

TEST(HardCities, FiveMillionMetresAwayNothingChanges)
{
    const Daylight light = afternoon();
    const std::vector<House> houses{box(0, 0, 10, 10, 10), box(10, 2, 8, 10, 14), box(30, 5, 9, 9, 12)};
    const City here = lightCity(houses, light), there = lightCity(houses, light, {5e6, 5e6});
    expectWholeCity(there, light);
    const glm::dvec3 way = there.layout.origin - here.layout.origin;
    EXPECT_EQ(way, glm::dvec3(5e6, 5e6, 0.0));
    ASSERT_EQ(here.scene.tree.patchCount(), there.scene.tree.patchCount());
    double worst = 0.0;
    for (u32 i = 0; i < here.scene.tree.patchCount(); ++i)
        raise(worst, std::abs(here.scene.irradiance(i) - there.scene.irradiance(i)));
    EXPECT_LE(worst, 1e-6) << "W/m2; all corners are whole metres";
}

TEST(HardCities, NoHouseIsAnErrorInOneLine)
{
    const std::string none = R"({"type":"FeatureCollection","features":[]})";
    for (const std::string& text : {none, geoJson({box(0, 0, 0.05, 12, 9)}, {0, 0})}) {
        const Result<Layout> layout = parseCity(text, "city.geojson");
        ASSERT_FALSE(layout.ok());
        EXPECT_EQ(layout.error().message.find('\n'), std::string::npos);
        EXPECT_NE(layout.error().message.find("city.geojson"), std::string::npos) << layout.error().message;
    }
}
