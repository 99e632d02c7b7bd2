// SPDX-License-Identifier: Apache-2.0
// Plane clipping, extrusion and face selection on shapes whose areas and volumes are known by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "city/base/hash.h"
#include "city/grammar/clip.h"
#include "city/grammar/component.h"
#include "tests/unit/grammar_solids.h"

namespace helio::cga {
namespace {

Geometry flat(const std::vector<glm::dvec2>& outer, const std::vector<std::vector<glm::dvec2>>& holes = {})
{
    return flatShape(outer, holes);
}

const std::vector<glm::dvec2> kL = {{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}};             // area 64
const std::vector<glm::dvec2> kU = {{0, 0}, {9, 0}, {9, 6}, {6, 6}, {6, 3}, {3, 3}, {3, 6}, {0, 6}}; // area 45
const std::vector<glm::dvec2> kHole = {{3, 3}, {3, 7}, {7, 7}, {7, 3}};                              // clockwise, 16 m2
const std::vector<glm::dvec2> kSquare = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};

/// Sum of all face areas as vectors: zero for every closed surface.
glm::dvec3 openness(const Geometry& geometry)
{
    glm::dvec3 sum(0.0);
    for (const Face& face : geometry.faces) sum += vectorArea(face.polygon);
    return sum;
}

TEST(GrammarGeometry, ClipOfAConcavePolygon)
{
    const Geometry l = flat(kL);
    EXPECT_NEAR(area(clipSlab(l, 0, 0, 4)), 40, 1e-12);
    EXPECT_NEAR(area(clipSlab(l, 0, 4, 10)), 24, 1e-12);
    // z from -10 to -4 holds the upper arm, 4 x 6.
    EXPECT_NEAR(area(clipSlab(l, 2, -10, -4)), 24, 1e-12);
    // A cut above y = 3 of the U gives its two arms as two polygons of 3 x 3.
    const Geometry arms = clipSlab(flat(kU), 2, -6, -3);
    ASSERT_EQ(arms.faces.size(), 2u);
    EXPECT_NEAR(area(arms.faces[0].polygon), 9, 1e-12);
    EXPECT_NEAR(area(arms.faces[1].polygon), 9, 1e-12);
    // One just below keeps them joined.
    EXPECT_EQ(clipSlab(flat(kU), 2, -6, -2.9).faces.size(), 1u);
}

TEST(GrammarGeometry, ClipOfAPolygonWithAHole)
{
    const Geometry court = flat(kSquare, {kHole});
    const Geometry through = clipSlab(court, 0, 0, 5); // half: 50 - 8, the hole has become a notch
    ASSERT_EQ(through.faces.size(), 1u);
    EXPECT_TRUE(through.faces[0].polygon.holes.empty());
    EXPECT_NEAR(area(through), 42, 1e-12);
    const Geometry around = clipSlab(court, 0, 2, 8); // 60 - 16, the hole is whole
    ASSERT_EQ(around.faces.size(), 1u);
    EXPECT_EQ(around.faces[0].polygon.holes.size(), 1u);
    EXPECT_NEAR(area(around), 44, 1e-12);
    const Geometry middle = clipSlab(court, 0, 4, 6); // two separate bars of 2 x 3
    EXPECT_EQ(middle.faces.size(), 2u);
    EXPECT_NEAR(area(middle), 12, 1e-12);
    const Geometry touching = clipSlab(court, 0, 0, 3); // the cut runs along the hole's edge
    EXPECT_NEAR(area(touching), 30, 1e-12);
    EXPECT_TRUE(touching.faces[0].polygon.holes.empty());
}

TEST(GrammarGeometry, CornersThatTouchTheCutLeaveNoSliver)
{
    // The inner corner of the L lies 0.05 micrometres beyond the cut.
    const Geometry l = flat({{0, 0}, {10, 0}, {10, 4}, {4 + 5e-8, 4}, {4 + 5e-8, 10}, {0, 10}});
    const Geometry piece = clipSlab(l, 0, 4, 10);
    ASSERT_EQ(piece.faces.size(), 1u);
    EXPECT_EQ(piece.faces[0].polygon.outer.size(), 4u);
}

// Random star-shaped polygons with a hole, cut into random slabs: the areas add up, and every piece looks to the same
// side.
TEST(GrammarGeometry, SlabsAddUp)
{
    Random random(7);
    for (int round = 0; round < 200; ++round) {
        std::vector<glm::dvec2> outer, hole;
        const int n = 3 + int(random.uniform() * 20);
        for (int k = 0; k < n; ++k) {
            // A coarse grid of radii makes corners fall onto the cutting planes.
            const double angle = 2 * M_PI * k / n, r = 4 + std::floor(4 * random.uniform());
            outer.emplace_back(std::round(r * std::cos(angle) * 2) / 2, std::round(r * std::sin(angle) * 2) / 2);
            hole.emplace_back(std::cos(-angle), std::sin(-angle));
        }
        const Geometry star = flat(outer, {hole});
        if (vectorArea(star.faces[0].polygon).y < 1.0) continue;
        const auto [low, high] = bounds(star);
        for (const int axis : {0, 2}) {
            double sum = 0.0, at = low[axis];
            while (at < high[axis]) {
                const double next = std::min(high[axis], at + 0.5 + std::floor(4 * random.uniform()) / 2);
                const Geometry piece = clipSlab(star, axis, at, next);
                sum += area(piece);
                for (const Face& face : piece.faces) EXPECT_GT(vectorArea(face.polygon).y, 0.0);
                at = next;
            }
            EXPECT_NEAR(sum, area(star), 1e-9 * area(star)) << "round " << round << " axis " << axis;
        }
    }
}

TEST(GrammarGeometry, ExtrudedSolidIsClosed)
{
    const Geometry solid = extrude(flat(kSquare, {kHole}), {0, 5, 0}, true);
    EXPECT_EQ(solid.faces.size(), 4u + 4u + 2u);
    EXPECT_NEAR(volume(solid), (100 - 16) * 5, 1e-9);
    EXPECT_NEAR(area(solid), 2 * 84 + 5 * (40 + 16), 1e-9);
    EXPECT_NEAR(glm::length(openness(solid)), 0, 1e-9);
    for (u32 k = 0; k < 8; ++k) {
        EXPECT_EQ(solid.faces[k].edge, k);
        EXPECT_EQ(solid.faces[k].outer, k < 4);
    }
    // The wall of the hole's edge x = 3 looks into the court, +x.
    EXPECT_NEAR(unitNormal(solid.faces[4].polygon).x, 1, 1e-12);
}

TEST(GrammarGeometry, FacesThatShareAnEdgeGetNoWallThere)
{
    Geometry two = clipSlab(flat(kSquare), 0, 0, 4);
    two.faces.push_back(clipSlab(flat(kSquare), 0, 4, 10).faces[0]);
    const Geometry solid = extrude(two, {0, 3, 0}, false);
    EXPECT_EQ(solid.faces.size(), 6u + 4u);
    EXPECT_NEAR(volume(solid), 300, 1e-9);
}

TEST(GrammarGeometry, CutSolidsAreClosedAgain)
{
    for (const auto& [base, whole] :
         {std::pair(flat(kSquare, {kHole}), 84.0), std::pair(flat(kL), 64.0), std::pair(flat(kU), 45.0)}) {
        const Geometry solid = extrude(base, {0, 6, 0}, false);
        const auto [low, high] = bounds(solid);
        for (int axis = 0; axis < 3; ++axis) {
            double sum = 0.0;
            const double step = (high[axis] - low[axis]) / 6; // also through corners and along faces
            for (int k = 0; k < 6; ++k) {
                const Geometry piece = clipSlab(solid, axis, low[axis] + k * step, low[axis] + (k + 1) * step);
                EXPECT_TRUE(piece.closed);
                EXPECT_NEAR(glm::length(openness(piece)), 0, 1e-9);
                sum += volume(piece);
            }
            EXPECT_NEAR(sum, whole * 6, 1e-9) << "axis " << axis;
        }
        // A storey of a courtyard house keeps the court as a hole in floor and ceiling.
        const Geometry storey = clipSlab(solid, 1, 2, 4);
        EXPECT_NEAR(area(storey), area(solid) - 4 * (area(solid) - 2 * whole) / 6, 1e-9);
    }
}

// Both halves of many cuts are closed edge by edge, also where the cut runs through corners and along faces.
TEST(GrammarGeometry, EachEdgeOfACutSolidBelongsToTwoFaces)
{
    const std::vector<glm::dvec2> comb = {{0, 0}, {10, 0}, {10, 4}, {8, 4}, {8, 2}, {6, 2},
                                          {6, 4}, {4, 4},  {4, 2},  {2, 2}, {2, 4}, {0, 4}};
    for (const Geometry& solid :
         {extrude(flat(kSquare, {kHole}), {0, 6, 0}, false), extrude(flat(kL), {0, 6, 0}, false),
          extrude(flat(kU), {0, 6, 0}, false), extrude(flat(comb), {0, 6, 0}, false), gabledPrism(8, 6, 3)}) {
        ASSERT_EQ(openEdges(solid), 0u);
        const auto [low, high] = bounds(solid);
        for (int axis = 0; axis < 3; ++axis)
            for (int k = 1; k < 40; ++k) {
                const double at = low[axis] + (high[axis] - low[axis]) * k / 40;
                const Geometry below = clipSlab(solid, axis, low[axis], at),
                               above = clipSlab(solid, axis, at, high[axis]);
                EXPECT_EQ(openEdges(below), 0u) << "axis " << axis << " at " << at;
                EXPECT_EQ(openEdges(above), 0u) << "axis " << axis << " at " << at;
                EXPECT_NEAR(volume(below) + volume(above), volume(solid), 1e-9);
            }
        // Inclined planes, through the middle in eight directions.
        for (int k = 0; k < 8; ++k) {
            const glm::dvec3 normal = glm::normalize(glm::dvec3(std::cos(k), std::sin(2.0 * k) / 2, std::sin(k)));
            const double offset = glm::dot(normal, 0.5 * (low + high));
            const Geometry a = clipPlane(solid, normal, offset), b = clipPlane(solid, -normal, -offset);
            EXPECT_EQ(openEdges(a), 0u) << "plane " << k;
            EXPECT_EQ(openEdges(b), 0u) << "plane " << k;
            EXPECT_NEAR(volume(a) + volume(b), volume(solid), 1e-9);
        }
    }
}

// Two towers on one slab touch the cut at 4 m with their feet: the slab's top is one face with the towers' feet, and
// the towers end there.
TEST(GrammarGeometry, CapsJoinFacesThatLieInTheCut)
{
    Geometry slab = extrude(flat(kU), {0, 6, 0}, false);
    const Geometry low = clipSlab(slab, 1, 0, 4);
    size_t tops = 0;
    for (const Face& face : low.faces) tops += vectorArea(face.polygon).y > 1e-6 ? 1 : 0;
    EXPECT_EQ(tops, 1u);
    // Cut again at the same height: nothing changes.
    EXPECT_EQ(clipSlab(low, 1, 0, 4).faces.size(), low.faces.size());
    EXPECT_TRUE(clipSlab(low, 1, 4, 5).faces.empty());
}

// A prism stands on its edge, which lies in the cut; one of its two slopes is made of two faces. The corner between
// them must stay a corner of the other slope, though that passes it in a straight line. A box beside it is cut.
TEST(GrammarGeometry, CornersOnTheCutAreShared)
{
    const glm::dvec3 p(0, 0, 0), c(2, 0, 0), q(4, 0, 0), a(0, 3, -2), b(4, 3, -2), d(0, 3, 2), e(4, 3, 2), m(2, 3, 2);
    Geometry solid = extrude(flat({{10, 0}, {12, 0}, {12, 2}, {10, 2}}), {0, 3, 0}, false);
    for (Face& face : solid.faces)
        for (glm::dvec3& corner : face.polygon.outer) corner.y -= 2;
    for (const Ring3& ring : {Ring3{p, a, b, q, c}, Ring3{p, c, m, d}, Ring3{c, q, e, m}, Ring3{a, d, m, e, b},
                              Ring3{p, d, a}, Ring3{q, b, e}})
        solid.faces.emplace_back().polygon.outer = ring;
    ASSERT_EQ(openEdges(solid), 0u);
    ASSERT_NEAR(volume(solid), 24 + 12, 1e-9);
    const Geometry high = clipSlab(solid, 1, 0, 3);
    EXPECT_EQ(openEdges(high), 0u);
    EXPECT_NEAR(volume(high), 24 + 4, 1e-9);
}

TEST(GrammarGeometry, PartsOfALotKeepTheNumbersOfTheirEdges)
{
    Geometry lot = flat(kL);
    lot.faces[0].edges = {0, 1, 2, 3, 4, 5};
    const Geometry left = clipSlab(lot, 0, 0, 2);
    ASSERT_EQ(left.faces.size(), 1u);
    const Geometry solid = extrude(left, {0, 3, 0}, false);
    std::vector<u32> numbers;
    for (const Face& face : solid.faces)
        if (std::abs(unitNormal(face.polygon).y) < 0.5) numbers.push_back(face.edge);
    std::sort(numbers.begin(), numbers.end());
    // Of the L's edges, the first, the fifth (upper end) and the last (left side) bound the strip; the cut has none.
    EXPECT_EQ(numbers, (std::vector<u32>{0, 4, 5, kNoIndex}));
    // The top of a tagged extrusion knows the edges below it.
    const Geometry tagged = extrude(flat(kSquare), {0, 3, 0}, true);
    EXPECT_EQ(tagged.faces[4].edges, (std::vector<u32>{0, 1, 2, 3}));
    EXPECT_TRUE(tagged.faces[5].edges.empty());
}

TEST(GrammarGeometry, Measures)
{
    EXPECT_TRUE(isConcave(flat(kL)));
    EXPECT_FALSE(isConcave(flat(kSquare)));
    EXPECT_TRUE(isConcave(flat(kSquare, {kHole})));
    EXPECT_FALSE(isConcave(extrude(flat(kSquare), {0, 2, 0}, false)));
    EXPECT_TRUE(isRectangular(flat(kSquare), 1));
    EXPECT_TRUE(
        isRectangular(flat({{0, 0}, {5, 0}, {10, 0}, {10, 10}, {0, 10}}), 1));    // a collinear corner does not count
    EXPECT_FALSE(isRectangular(flat({{0, 0}, {10, 0}, {10.5, 10}, {0, 10}}), 1)); // 2.9 degrees off
    EXPECT_TRUE(isRectangular(flat({{0, 0}, {10, 0}, {10.5, 10}, {0, 10}}), 5));
    EXPECT_TRUE(isPlanar(flat(kL)));
    EXPECT_FALSE(isPlanar(extrude(flat(kSquare), {0, 2, 0}, false)));
}

// ---- selectors
glm::dvec3 at(double azimuthDeg, double slopeDeg) // azimuth 0 = front (+z), 90 = right (+x)
{
    const double a = azimuthDeg * M_PI / 180, s = slopeDeg * M_PI / 180;
    return {std::cos(s) * std::sin(a), std::sin(s), std::cos(s) * std::cos(a)};
}

TEST(GrammarSelectors, QuadrantsAndTies)
{
    EXPECT_TRUE(selects(Selector::Front, at(44, 0)));
    EXPECT_TRUE(selects(Selector::Right, at(46, 0)));
    EXPECT_TRUE(selects(Selector::Back, at(180, 0)));
    EXPECT_TRUE(selects(Selector::Left, at(270, 0)));
    // Ties at 45 degrees go to front, right, back, left in this order, whatever the rounding.
    for (const double rounding : {-1e-11, 0.0, 1e-11}) {
        EXPECT_TRUE(selects(Selector::Front, at(45 + rounding, 0)));
        EXPECT_TRUE(selects(Selector::Right, at(135 + rounding, 0)));
        EXPECT_TRUE(selects(Selector::Back, at(225 + rounding, 0)));
        EXPECT_TRUE(selects(Selector::Front, at(315 + rounding, 0)));
    }
    EXPECT_TRUE(selects(Selector::Top, at(0, 60)));
    EXPECT_TRUE(selects(Selector::Bottom, at(0, -60)));
    EXPECT_TRUE(selects(Selector::Front, at(0, 30)));
}

TEST(GrammarSelectors, Slopes)
{
    const auto kindAt = [](double slope) {
        std::string kinds;
        for (const auto& [selector, letter] : {std::pair(Selector::Vertical, 'v'),
                                               {Selector::Horizontal, 'h'},
                                               {Selector::Aslant, 'a'},
                                               {Selector::Nutant, 'n'},
                                               {Selector::Side, 's'}})
            if (selects(selector, at(20, slope))) kinds += letter;
        return kinds;
    };
    EXPECT_EQ(kindAt(0), "vs");
    EXPECT_EQ(kindAt(11.2), "vs");
    EXPECT_EQ(kindAt(11.3), "as");
    EXPECT_EQ(kindAt(78.7), "as");
    EXPECT_EQ(kindAt(78.8), "h");
    EXPECT_EQ(kindAt(-11.3), "ns");
    EXPECT_EQ(kindAt(-90), "h");
}

TEST(GrammarSelectors, FaceShapeHasXAlongTheFirstEdgeAndZOutside)
{
    const Geometry solid = extrude(flat({{2, 1}, {10, 1}, {10, 7}, {2, 7}}), {0, 5, 0}, false);
    const auto [scope, geometry] =
        faceShape(Scope{}, solid.faces[1]); // the wall at x = 10, from y = 1 to 7 (z = -1 to -7)
    EXPECT_NEAR(glm::distance(scope.origin, glm::dvec3(10, 0, -1)), 0, 1e-12);
    EXPECT_NEAR(glm::distance(scope.axes[0], glm::dvec3(0, 0, -1)), 0, 1e-12);
    EXPECT_NEAR(glm::distance(scope.axes[1], glm::dvec3(0, 1, 0)), 0, 1e-12);
    EXPECT_NEAR(glm::distance(scope.axes[2], glm::dvec3(1, 0, 0)), 0, 1e-12);
    EXPECT_NEAR(glm::distance(scope.size, glm::dvec3(6, 5, 0)), 0, 1e-12);
    EXPECT_NEAR(vectorArea(geometry.faces[0].polygon).z, 30, 1e-12);
}

} // namespace
} // namespace helio::cga
