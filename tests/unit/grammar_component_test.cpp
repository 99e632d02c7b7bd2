// SPDX-License-Identifier: Apache-2.0
// comp(f), comp(e), comp(fe), comp(v), street sides and trim planes, on shapes whose parts are counted by hand.
#include "city/grammar/component.h"

#include <glm/matrix.hpp>

#include "city/grammar/trim.h"
#include "tests/unit/grammar_solids.h"
#include "tests/unit/grammar_support.h"

namespace helio::cga {
namespace {

using test::areaOf;
using test::boxFootprint;
using test::errorOf;
using test::leavesOf;
using test::mustDerive;

size_t count(const std::vector<Component>& components, RoofEdge kind)
{
    size_t n = 0;
    for (const Component& component : components) n += component.roofEdge == kind ? 1 : 0;
    return n;
}

TEST(GrammarComponent, SelectorsNameThemselves)
{
    const auto d = mustDerive("Lot --> extrude(6) comp(f) { object.front : S | world.north : S | street.left : S | "
                              "object.top : S | 5 : S | side : S }\nS --> report(comp.sel, 1) X.",
                              {boxFootprint(10, 8, 6)});
    const std::map<std::string, double> expected = {{"object.front", 1}, {"world.north", 1}, {"street.left", 1},
                                                    {"object.top", 1},   {"other", 1},       {"side", 1}};
    EXPECT_EQ(d.reports, expected);
}

TEST(GrammarComponent, EdgesOfAGabledPrism)
{
    const Geometry prism = gabledPrism(8, 6, 3);
    const auto edges = meshEdges(prism);
    EXPECT_EQ(edges.size(), 18u); // 4 + 4 + 3 + 3 + 4, each edge twice
    const auto all = componentsOf(prism, edges, ComponentKind::Edges, glm::dmat3(1.0));
    EXPECT_EQ(all.size(), 9u);
    EXPECT_EQ(count(all, RoofEdge::Ridge), 1u);
    EXPECT_EQ(count(all, RoofEdge::Eave), 2u);
    EXPECT_EQ(count(all, RoofEdge::Hip), 0u);
    EXPECT_EQ(componentsOf(prism, edges, ComponentKind::FaceEdges, glm::dmat3(1.0)).size(), 18u);
    EXPECT_EQ(componentsOf(prism, edges, ComponentKind::Vertices, glm::dmat3(1.0)).size(), 6u);
    for (const Component& component : all) {
        EXPECT_FALSE(component.border);
        if (component.roofEdge != RoofEdge::Ridge) continue;
        const Scope scope = edgeScope(Scope{}, component);
        EXPECT_NEAR(scope.size.x, 8, 1e-12);
        EXPECT_EQ(scope.size.y, 0.0);
        EXPECT_EQ(scope.size.z, 0.0);
        EXPECT_NEAR(scope.axes[1].y, 1, 1e-12); // up, between two slopes of equal steepness
    }
}

// Two slopes that meet in a valley: the same prism with its ridge pushed below the eaves.
TEST(GrammarComponent, ValleyHipAndRidgeByTheirFaces)
{
    const glm::dvec3 along(1, 0, 0), inclined = glm::normalize(glm::dvec3(1, 1, 1));
    const glm::dvec3 back = glm::normalize(glm::dvec3(0, 1, -1)), front = glm::normalize(glm::dvec3(0, 1, 1));
    // Seen from outside the face lies to the left of its edge: walking to +x, that is the side of -z.
    EXPECT_EQ(roofEdge(along, back, &front), RoofEdge::Ridge);
    EXPECT_EQ(roofEdge(along, front, &back), RoofEdge::Valley);
    const glm::dvec3 left = glm::normalize(glm::dvec3(-1, 1, 0));
    // The corner of a hip roof at x = z = 0: its edge rises to (1, 1, 1) between the slopes that face -x and -z.
    EXPECT_EQ(roofEdge(-inclined, back, &left), RoofEdge::Valley);
    EXPECT_EQ(roofEdge(inclined, back, &left), RoofEdge::Hip);
    const glm::dvec3 wall(0, 0, 1), down(0, -1, 0);
    EXPECT_EQ(roofEdge(along, front, &wall), RoofEdge::Eave);
    EXPECT_EQ(roofEdge(-along, wall, &front), RoofEdge::Eave);
    EXPECT_EQ(roofEdge(along, front, &down), RoofEdge::Eave);
    EXPECT_EQ(roofEdge(along, front, nullptr), RoofEdge::Eave);
    EXPECT_EQ(roofEdge(-along, front, &wall), RoofEdge::None); // the upper end of a shed's slope
    EXPECT_EQ(roofEdge(along, front, &front), RoofEdge::None); // one plane
}

TEST(GrammarComponent, BorderAndInside)
{
    // Three strips side by side: each has border edges; the middle one of three by three has none.
    Geometry grid;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            grid.faces.push_back(
                flatShape(
                    {{i * 2.0, j * 2.0}, {i * 2.0 + 2, j * 2.0}, {i * 2.0 + 2, j * 2.0 + 2}, {i * 2.0, j * 2.0 + 2}})
                    .faces[0]);
    const auto faces = componentsOf(grid, meshEdges(grid, true), ComponentKind::Faces, glm::dmat3(1.0));
    for (size_t k = 0; k < 9; ++k) EXPECT_EQ(faces[k].border, k != 4);
    // A long edge beside two short ones is no border either, though no edge has the same ends.
    Geometry uneven;
    uneven.faces.push_back(flatShape({{0, 0}, {4, 0}, {4, 2}, {0, 2}}).faces[0]);
    uneven.faces.push_back(flatShape({{0, 2}, {2, 2}, {2, 4}, {0, 4}}).faces[0]);
    size_t border = 0;
    for (const MeshEdge& edge : meshEdges(uneven, true)) border += edge.border ? 1 : 0;
    EXPECT_EQ(border, 6u);
}

TEST(GrammarComponent, TrimPlanesHalveTheCorner)
{
    const Geometry box = extrude(flatShape({{0, 0}, {4, 0}, {4, 3}, {0, 3}}), {0, 5, 0}, false);
    const auto edges = meshEdges(box);
    const auto planes = trimPlanesOf(box, edges, 0, {0, 1, 0}); // the wall that looks to +z
    ASSERT_EQ(planes.size(), 4u);
    size_t vertical = 0;
    for (const TrimPlane& trim : planes) {
        vertical += trim.vertical ? 1 : 0;
        EXPECT_GT(glm::dot(glm::dvec3(trim.plane), glm::dvec3(2, 2.5, 0)) + trim.plane.w, 0.0); // keeps its wall
        if (!trim.vertical || trim.plane.x > 0.0) continue;
        // At x = 4 the plane runs out of the corner at 45 degrees: (5, y, 1) lies on it, (5, y, 2) is kept, (5, y, 0.5)
        // belongs to the neighbour.
        const auto side = [&](double x, double z) {
            return glm::dot(glm::dvec3(trim.plane), glm::dvec3(x, 1, z)) + trim.plane.w;
        };
        EXPECT_NEAR(side(5, 1), 0, 1e-12);
        EXPECT_GT(side(5, 2), 0.0);
        EXPECT_LT(side(5, 0.5), 0.0);
    }
    EXPECT_EQ(vertical, 2u);
}

Footprint withStreets(std::vector<bool> onStreet)
{
    Footprint footprint = boxFootprint(10, 8, 6);
    footprint.onStreet = std::move(onStreet);
    return footprint;
}

constexpr const char* kStreets = R"(
Lot --> extrude(6) comp(f) { street.front : F. | street.back : B. | street.left : L. | street.right : R. | all : NIL }
)";

TEST(GrammarComponent, StreetSides)
{
    // South (10 m), east (8 m), north, west. Without streets: the directions of the object.
    auto d = mustDerive(kStreets, {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(areaOf(d, "F"), 60, 1e-9);
    EXPECT_NEAR(areaOf(d, "B"), 60, 1e-9);
    EXPECT_NEAR(areaOf(d, "R"), 48, 1e-9);
    // A street in the east: the front is there, left is the south.
    d = mustDerive(kStreets, {withStreets({false, true, false, false})});
    ASSERT_EQ(leavesOf(d, "F").size(), 1u);
    EXPECT_NEAR(test::boundsOf(d, *leavesOf(d, "F")[0]).first.x, 10, 1e-9);
    EXPECT_NEAR(areaOf(d, "L"), 60, 1e-9);
    EXPECT_NEAR(test::boundsOf(d, *leavesOf(d, "L")[0]).second.y, 0, 1e-9);
    EXPECT_NEAR(test::boundsOf(d, *leavesOf(d, "R")[0]).first.y, 8, 1e-9);
    // A corner lot: both street walls are front, both others back.
    d = mustDerive(kStreets, {withStreets({true, true, false, false})});
    EXPECT_EQ(leavesOf(d, "F").size(), 2u);
    EXPECT_EQ(leavesOf(d, "B").size(), 2u);
    EXPECT_EQ(leavesOf(d, "L").size() + leavesOf(d, "R").size(), 0u);
    // Streets all around.
    d = mustDerive(kStreets, {withStreets({true, true, true, true})});
    EXPECT_EQ(leavesOf(d, "F").size(), 4u);
}

TEST(GrammarComponent, EdgesBecomeShapes)
{
    // A box has 12 edges; each carries a bar of its length. 4 x (10 + 8 + 6) = 96 m.
    const char* rules = R"(
Lot --> extrude(6) comp(e) { all : Bar }
Bar --> report("length", scope.sx) report("thick", scope.sy + scope.sz) s('1, 0.2, 0.2) primitiveCube() Bar.
)";
    auto d = mustDerive(rules, {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(d.reports["length"], 96, 1e-9);
    EXPECT_NEAR(d.reports["thick"], 0, 1e-12);
    EXPECT_EQ(leavesOf(d, "Bar").size(), 12u);
    // Every bar has 4 sides of 0.2 m and two ends.
    EXPECT_NEAR(areaOf(d, "Bar"), 96 * 0.8 + 12 * 2 * 0.04, 1e-9);
    // The lot's own edges: 4, by direction. An edge that nothing is put on leaves nothing.
    d = mustDerive("Lot --> [ comp(fe) { front : A | left : B | all : NIL } ] Ground.\n"
                   "A --> report(\"a\", scope.sx)\nB --> report(\"b\", scope.sx)\n",
                   {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(d.reports["a"], 10, 1e-9);
    EXPECT_NEAR(d.reports["b"], 8, 1e-9);
    EXPECT_NEAR(test::totalArea(d), 80, 1e-9);
    // Edges can be split along x.
    d = mustDerive("Lot --> comp(e) { 0 : split(x) { ~2 : Post }* | all : NIL }\nPost --> report(\"posts\", 1) NIL\n",
                   {boxFootprint(10, 8, 6)});
    EXPECT_EQ(d.reports["posts"], 5.0);
    d = mustDerive("Lot --> comp(v) { all : V }\nV --> report(\"v\", 1) NIL\n", {boxFootprint(10, 8, 6)});
    EXPECT_EQ(d.reports["v"], 4.0);
}

TEST(GrammarComponent, RefusedForms)
{
    EXPECT_NE(errorOf("Lot --> comp(g) { all : X. }").find("comp(f)"), std::string::npos);
    EXPECT_NE(errorOf("Lot --> comp(f) { sideways : X. }").find("unknown selector"), std::string::npos);
    EXPECT_NE(errorOf("Lot --> comp(e) { all = X. }").find("write ':'"), std::string::npos);
}

// A cornice of 0.5 x 0.4 m that is 0.4 m longer than its wall at both ends, on two walls that meet at a right angle.
TEST(GrammarComponent, CornicesMeetAtTheCorner)
{
    const char* rules = R"(
Lot --> extrude(6) comp(f) { front : Wall | right : Wall | all : NIL }
Wall --> split(y) { ~1 : W. | 0.5 : Band }
Band --> [ s(scope.sx + 0.8, '1, 0.4) center(x) i("cornice") Cornice. ] W.
)";
    const auto d = mustDerive(rules, {boxFootprint(10, 8, 6)});
    const auto cornices = leavesOf(d, "Cornice");
    ASSERT_EQ(cornices.size(), 2u);
    for (const Shape* cornice : cornices) ASSERT_EQ(cornice->trimCount, 2u); // both ends stand over a corner
    const auto covers = [&](const Shape& shape, const glm::dvec3& p) {
        const glm::dmat3 turn(shape.worldFromAsset);
        const glm::dvec3 local = glm::inverse(turn) * (p - shape.worldFromAsset[3]);
        bool in = glm::all(glm::greaterThan(local, glm::dvec3(0.0))) && glm::all(glm::lessThan(local, glm::dvec3(1.0)));
        for (u32 k = 0; k < shape.trimCount; ++k) {
            const glm::dvec4& plane = d.shapes.trimPlanes[shape.trimBegin + k];
            in = in && glm::dot(glm::dvec3(plane), p) + plane.w >= 0.0;
        }
        return in;
    };
    // Points around the corner (10, 0) at 5.7 m, 1 cm apart, but not on the mitre itself: every one in front of the
    // walls is covered by exactly one cornice.
    for (int i = -30; i < 40; ++i)
        for (int j = -30; j < 40; ++j) {
            const glm::dvec3 p(10 + i * 0.01 + 0.002, -j * 0.01 - 0.006, 5.7);
            const bool outside = p.x > 10.0 || p.y < 0.0;
            const int covered = int(covers(*cornices[0], p)) + int(covers(*cornices[1], p));
            EXPECT_EQ(covered, outside ? 1 : 0) << p.x << " " << p.y;
        }
    // Without vertical trimming they run into each other, and no plane is kept.
    const auto loose = mustDerive(std::string("attr x = 0\n") + R"(
Lot --> extrude(6) set(trim.vertical, false) comp(f) { front : Wall | right : Wall | all : NIL }
Wall --> [ s(scope.sx + 0.8, '1, 0.4) center(x) i("cornice") Cornice. ] W.
)",
                                  {boxFootprint(10, 8, 6)});
    EXPECT_TRUE(loose.shapes.trimPlanes.empty());
}

// An asset that ends at the corner is not cut: it stays an instance.
TEST(GrammarComponent, TrimPlanesOnlyWhereTheyCut)
{
    const auto d = mustDerive("Lot --> extrude(6) comp(f) { front : Wall | all : NIL }\n"
                              "Wall --> [ s('1, '1, 0.4) i(\"cornice\") Cornice. ] W.\n",
                              {boxFootprint(10, 8, 6)});
    EXPECT_TRUE(d.shapes.trimPlanes.empty());
    // A box that a primitive makes is cut itself: 10.8 m at the front of the cornice, 10 m at the wall.
    const auto p = mustDerive("Lot --> extrude(6) comp(f) { front : Wall | all : NIL }\n"
                              "Wall --> [ s(scope.sx + 0.8, 1, 0.4) center(x) primitiveCube() Bar. ] W.\n",
                              {boxFootprint(10, 8, 6)});
    // Top and bottom are trapezia of (10 + 10.8) / 2 x 0.4.
    double level = 0.0;
    for (const Shape* leaf : leavesOf(p, "Bar"))
        for (u32 k = 0; k < leaf->polygonCount; ++k) {
            const glm::dvec3 v = vectorArea(p.shapes.polygons[leaf->polygonBegin + k]);
            level += v.z > 0 ? v.z : 0.0;
        }
    EXPECT_NEAR(level, 10.4 * 0.4, 1e-9);
}

} // namespace
} // namespace helio::cga
