// SPDX-License-Identifier: Apache-2.0
#include "city/layout/ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <set>

#include "city/layout/builtin_city.h"
#include "city/layout/polygon_repair.h"
#include "city/model/materials.h"

using namespace helio;

namespace {

Footprint box(double x, double y, double width, double depth)
{
    Footprint footprint;
    footprint.outline.outer = {{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}};
    footprint.height = 10.0;
    return footprint;
}

double totalArea(const Layout& layout)
{
    double sum = 0.0;
    for (const GroundArea& piece : layout.ground) sum += area(piece.polygon);
    return sum;
}

std::map<std::string, double> areaByKind(const Layout& layout)
{
    std::map<std::string, double> sums;
    for (const GroundArea& piece : layout.ground) sums[piece.kind] += area(piece.polygon);
    return sums;
}

// The kind of ground at a point, by looking at every piece; "" where there is none.
std::string kindAt(const Layout& layout, const glm::dvec2& point)
{
    for (const GroundArea& piece : layout.ground) {
        const auto inside = [&](const Ring3& ring) { return contains(Ring2(ring.begin(), ring.end()), point); };
        if (inside(piece.polygon.outer) && std::none_of(piece.polygon.holes.begin(), piece.polygon.holes.end(), inside))
            return piece.kind;
    }
    return "";
}

TEST(Ground, TilesTheRectangleWithoutTheFootprints)
{
    Layout layout;
    layout.footprints = {box(0, 0, 10.5, 7.3), box(10.5, 0, 6.1, 9.9)};
    Footprint slanted;
    slanted.outline.outer = {{30, 3}, {41.7, 8.9}, {37.2, 19.3}, {28.1, 12.4}};
    layout.footprints.push_back(slanted);
    addGround(layout, {.cellSize = 4.0, .margin = 20.0});
    double built = 0.0;
    for (const Footprint& footprint : layout.footprints) built += area(footprint.outline);
    const double rectangle = (41.7 + 40.0) * (19.3 + 40.0);
    EXPECT_NEAR(totalArea(layout), rectangle - built, 1e-6 * rectangle);
    for (const GroundArea& piece : layout.ground) {
        glm::dvec3 low = piece.polygon.outer[0], high = low;
        for (const glm::dvec3& corner : piece.polygon.outer) {
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
        EXPECT_LE(std::max(high.x - low.x, high.y - low.y), 4.0 + 2e-4);
        EXPECT_EQ(low.z, 0.0);
        EXPECT_EQ(high.z, 0.0);
        EXPECT_GT(vectorArea(piece.polygon).z, 0.0);
    }
}

TEST(Ground, PiecesMeetEdgeToEdge)
{
    // Every point of a fine raster off the grid lies in exactly one piece or one footprint.
    Layout layout;
    layout.footprints = {box(0, 0, 10, 10)};
    layout.footprints[0].outline.holes = {{{3, 3}, {3, 7}, {7, 7}, {7, 3}}};
    addGround(layout, {.cellSize = 4.0, .margin = 6.0});
    for (double y = -5.93; y < 16.0; y += 0.51) {
        for (double x = -5.93; x < 16.0; x += 0.51) {
            int count = contains(layout.footprints[0].outline.outer, {x, y}) &&
                                !contains(layout.footprints[0].outline.holes[0], {x, y})
                            ? 1
                            : 0;
            for (const GroundArea& piece : layout.ground) {
                const Ring3& ring = piece.polygon.outer;
                bool inside = contains(Ring2(ring.begin(), ring.end()), {x, y});
                for (const Ring3& hole : piece.polygon.holes)
                    inside = inside && !contains(Ring2(hole.begin(), hole.end()), {x, y});
                count += inside;
            }
            EXPECT_EQ(count, 1) << x << " " << y;
        }
    }
}

TEST(Ground, SurroundsABuildingThatIsSmallerThanACell)
{
    Layout layout; // one cell of 30 m around 1 m2: a piece with a hole
    layout.footprints = {box(0, 0, 1, 1)};
    addGround(layout, {.cellSize = 100.0, .margin = 14.5, .pavementWidth = 0.0});
    ASSERT_EQ(layout.ground.size(), 1u);
    EXPECT_EQ(layout.ground[0].polygon.holes.size(), 1u);
    EXPECT_NEAR(area(layout.ground[0].polygon), 899.0, 1e-6);
}

TEST(Ground, TellsCourtsPavementsAndStreets)
{
    Layout layout; // a ring of houses around a court of 20 x 20 m
    layout.footprints = {box(0, 0, 40, 10), box(0, 10, 10, 20), box(30, 10, 10, 20), box(0, 30, 40, 10)};
    addGround(layout, {.cellSize = 4.0, .margin = 30.0, .pavementWidth = 3.0});
    EXPECT_EQ(kindAt(layout, {20.1, 20.1}), "court");
    EXPECT_EQ(kindAt(layout, {10.2, 29.7}), "court");
    EXPECT_EQ(kindAt(layout, {20.1, -2.9}), "pavement");
    EXPECT_EQ(kindAt(layout, {20.1, -3.1}), "street");
    EXPECT_EQ(kindAt(layout, {5.1, 5.1}), "");
    const auto kinds = areaByKind(layout);
    EXPECT_NEAR(kinds.at("court"), 400.0, 1e-3);
    EXPECT_NEAR(kinds.at("pavement"), 46.0 * 46.0 - 1600.0, 1e-3); // corners stay square
    EXPECT_NEAR(kinds.at("street"), 1e4 - 46.0 * 46.0, 1e-3);
}

TEST(Ground, KeepsTheKindsThatTheLayoutGives)
{
    Layout layout;
    layout.footprints = {box(0, 0, 10, 10)};
    GroundArea lawn;
    lawn.kind = "green";
    lawn.polygon.outer = {{-5, -5, 0}, {15, -5, 0}, {15, 5, 0}, {-5, 5, 0}}; // half of it under the building's edge
    layout.ground = {lawn};
    addGround(layout, {.cellSize = 4.0, .margin = 10.0, .pavementWidth = 0.0});
    EXPECT_NEAR(areaByKind(layout).at("green"), 200.0 - 50.0, 1e-3);
    EXPECT_NEAR(totalArea(layout), 900.0 - 100.0, 1e-3);
}

TEST(Ground, NumbersBlocksOfSixteenCells)
{
    Layout layout; // 40 x 40 cells of 4 m: 3 x 3 blocks
    layout.footprints = {box(70, 70, 20, 20)};
    addGround(layout, {.cellSize = 4.0, .margin = 70.0});
    std::set<u32> blocks;
    u32 last = 0;
    for (const GroundArea& piece : layout.ground) {
        const glm::dvec3 centre = centroid(piece.polygon);
        EXPECT_EQ(piece.block, u32(centre.y / 64.0) * 3 + u32(centre.x / 64.0));
        EXPECT_GE(piece.block, last);
        last = piece.block;
        blocks.insert(piece.block);
    }
    EXPECT_EQ(blocks.size(), 9u);
}

TEST(Ground, KeepsToItsLimitOfCells)
{
    Layout layout;
    layout.footprints = {box(0, 0, 10, 10), box(5000, 5000, 10, 10)};
    addGround(layout, {.cellSize = 4.0, .margin = 30.0, .maxCells = 1000});
    EXPECT_LE(layout.ground.size(), 1100u); // up to 32 x 32 cells, some of them cut by the two houses
    ASSERT_EQ(layout.notes.size(), 1u);
    EXPECT_NE(layout.notes[0].find("256 m instead of 4 m"), std::string::npos) << layout.notes[0];
}

TEST(Ground, IsEmptyWithoutFootprints)
{
    Layout layout;
    addGround(layout);
    EXPECT_TRUE(layout.ground.empty());
    ShapeTree tree;
    appendGround(tree, layout);
    EXPECT_TRUE(tree.shapes.empty());
}

TEST(Ground, BecomesATreeOfBlocks)
{
    Layout layout = builtinCity(7);
    addGround(layout);
    ShapeTree tree;
    tree.surfaces = {groundSurface("street")};
    appendGround(tree, layout);
    std::set<u32> blocks;
    for (const GroundArea& piece : layout.ground) blocks.insert(piece.block);
    ASSERT_EQ(tree.shapes.size(), 1 + blocks.size() + layout.ground.size());
    EXPECT_EQ(tree.polygons.size(), layout.ground.size());
    double sum = 0.0;
    for (u32 i = 0; i < tree.shapes.size(); ++i) {
        const Shape& shape = tree.shapes[i];
        EXPECT_EQ(shape.building, kNoIndex);
        EXPECT_EQ(shape.op, i == 0 ? ShapeOp::Root : ShapeOp::Group);
        EXPECT_TRUE(i == 0 || shape.parent < i);
        if (shape.polygonCount == 0) continue;
        EXPECT_EQ(tree.names[tree.shapes[shape.parent].name], "Block");
        EXPECT_EQ(tree.surfaces[shape.surface].name, tree.names[shape.name]);
        EXPECT_EQ(tree.surfaces[shape.surface], groundSurface(tree.names[shape.name]));
        sum += area(tree.polygons[shape.polygonBegin]);
    }
    EXPECT_NEAR(sum, totalArea(layout), 1e-6);
    std::set<std::string> surfaces;
    for (const Surface& surface : tree.surfaces) surfaces.insert(surface.name);
    EXPECT_EQ(surfaces, (std::set<std::string>{"street", "pavement", "court", "green"}));
    EXPECT_EQ(tree.surfaces.size(), 4u);
}

// Of the built-in city's own kinds and of those that addGround gives.
TEST(Ground, EveryKindIsAMaterial)
{
    for (const u64 seed : {1, 7, 30}) {
        Layout layout = builtinCity(seed);
        addGround(layout);
        ASSERT_FALSE(layout.ground.empty());
        for (const GroundArea& piece : layout.ground)
            ASSERT_TRUE(findMaterial(piece.kind)) << "\"" << piece.kind << "\" of seed " << seed;
    }
    EXPECT_DEATH(groundSurface("nothing known"), "nothing known");
}

TEST(Ground, GreenReflectsMoreOfTheSunThanTheEyeSees)
{
    EXPECT_GT(groundSurface("green").rho.a, solarFromRgb(glm::dvec3(groundSurface("green").rho)));
    EXPECT_EQ(groundSurface("street").rho, glm::dvec4(0.12));
    EXPECT_EQ(groundSurface("pavement").rho, glm::dvec4(0.30));
    EXPECT_EQ(groundSurface("court").rho.a, 0.25);
    EXPECT_EQ(groundSurface("green").rho, glm::dvec4(0.10, 0.16, 0.07, 0.22));
    for (const char* kind : {"street", "pavement", "court", "green", "square", "water", "gravel"})
        EXPECT_EQ(groundSurface(kind).rho, findMaterial(kind)) << kind;
}

} // namespace
