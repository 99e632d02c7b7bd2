// SPDX-License-Identifier: Apache-2.0
// Operations that move, turn and size shapes and their scopes, on a lot whose coordinates are worked out by hand.
// The lot of boxFootprint(10, 8, ..): x east, y up, z south, origin in the north-west corner: (a, b, c) of its scope is
// (a, 8 - c, b) of the world.
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

const Footprint kBox = boxFootprint(10, 8, 6);
/// The same plan, but its first edge looks west: x points south, z west, the origin is the north-east corner.
const Footprint kWest = footprintOf({{0, 8}, {0, 0}, {10, 0}, {10, 8}}, 6);

const std::string kReports =
    " report(\"sx\", scope.sx) report(\"sy\", scope.sy) report(\"sz\", scope.sz) report(\"tx\", scope.tx) "
    "report(\"ty\", scope.ty) report(\"tz\", scope.tz) report(\"rx\", scope.rx) report(\"ry\", scope.ry) "
    "report(\"rz\", scope.rz) A.";

struct Placed
{
    Derivation d;
    glm::dvec3 low, high, size, t, r;
};

/// Runs operations on a lot (or, behind comp, on a face) and reports the scope that they leave.
Placed place(const std::string& operations, const Footprint& footprint = kBox)
{
    Placed p;
    p.d = mustDerive("Lot --> " + operations + kReports, {footprint});
    if (leavesOf(p.d, "A").empty()) return p;
    std::tie(p.low, p.high) = boundsOf(p.d, *leavesOf(p.d, "A")[0]);
    const auto vector = [&](const char* x, const char* y, const char* z) {
        return glm::dvec3(p.d.reports.at(x), p.d.reports.at(y), p.d.reports.at(z));
    };
    p.size = vector("sx", "sy", "sz");
    p.t = vector("tx", "ty", "tz");
    p.r = vector("rx", "ry", "rz");
    return p;
}

glm::dvec3 assetPoint(const Placed& p, glm::dvec3 point)
{
    return leavesOf(p.d, "A")[0]->worldFromAsset * glm::dvec4(point, 1);
}

TEST(GrammarPlacement, NegativeSizesMirrorAndTurnFacesOver)
{
    const Placed p = place("extrude(6) s(-4, '1, '1)");
    expectNear(p.low, {-4, 0, 0});
    expectNear(p.high, {0, 8, 6});
    expectNear(p.size, {-4, 6, 8});
    expectNear(p.t, {0, 0, 0});
    EXPECT_NEAR(enclosedVolume(p.d), -4 * 8 * 6, 1e-9); // the faces look inwards
    const Placed twice = place("extrude(6) s(-4, '1, -2)");
    expectNear(twice.low, {-4, 8, 0});
    expectNear(twice.high, {0, 10, 6});
    EXPECT_NEAR(enclosedVolume(twice.d), 4 * 2 * 6, 1e-9);
    // Relative sizes and steps follow the sign.
    expectNear(place("extrude(6) s(-4, '1, '1) t('1, 0, 0)").low, {-8, 0, 0});
    const Placed back = place("extrude(6) s('-1, '1, '1) s('-1, '1, '1)");
    expectNear(back.low, {0, 0, 0});
    expectNear(back.size, {10, 6, 8});
    EXPECT_NEAR(enclosedVolume(back.d), 480, 1e-9);
    // A face of a wall that is mirrored looks into the building.
    const Derivation wall = mustDerive("Lot --> extrude(6) comp(f) { front : s('-1, '1, '1) A. | all : NIL }", {kBox});
    expectNear(unitNormal(wall.shapes.polygons[0]), {0, 1, 0});
    // A part of it starts a scope of its own.
    EXPECT_NEAR(place("extrude(6) s(-4, '1, '1) split(y) { ~1 : B }\nB -->").size.x, 4, 1e-12);
}

TEST(GrammarPlacement, AssetsInMirroredScopes)
{
    const Placed p = place("s(-2, 3, 4) i(\"a.glb\")");
    expectNear(assetPoint(p, {0, 0, 0}), {0, 8, 0});
    expectNear(assetPoint(p, {1, 1, 1}), {-2, 4, 3});
    const Placed after = place("s(2, 3, 4) i(\"a.glb\") s('-1, '1, '2)");
    expectNear(assetPoint(after, {0, 0, 0}), {0, 8, 0});
    expectNear(assetPoint(after, {1, 1, 1}), {-2, 0, 3});
    const Placed mirrored = place("s(2, 3, 4) i(\"a.glb\") mirror(true, false, false)"); // in its place
    expectNear(assetPoint(mirrored, {0, 0, 0}), {2, 8, 0});
    expectNear(assetPoint(mirrored, {1, 1, 1}), {0, 4, 3});
}

TEST(GrammarPlacement, TranslateInSystems)
{
    Footprint moved = footprintOf({{3, 1}, {13, 1}, {13, 9}, {3, 9}}, 6);
    moved.base = 2;
    // The world's frame in the language: x east, y up, z south.
    const Placed world = place("translate(abs, world, 5, 4, -6)", moved);
    expectNear(world.low, {5, -2, 4});
    expectNear(world.high, {15, 6, 4});
    expectNear(place("translate(rel, world, 1, 2, 3)", moved).low, {4, -2, 4});
    expectNear(place("t(5, 5, 5) translate(abs, pivot, 1, 0, 0)", moved).low, {4, 1, 2});
    expectNear(place("t(5, 5, 5) translate(abs, object, 0, 1, 0)", moved).low, {3, 1, 3});
    expectNear(place("translate(rel, object, 1, 0, 2)", kWest).low, {-2, -1, 0});
    expectNear(place("r(0, 90, 0) translate(rel, scope, 1, 0, 0)").low, {0, 9, 0});
    EXPECT_NE(errorOf("Lot --> translate(rel, here, 1, 0, 0) A.")
                  .find("'translate' does not know the bare words 'rel', 'here': write "),
              std::string::npos);
}

TEST(GrammarPlacement, RotateInSystems)
{
    const Placed world = place("rotate(rel, world, 0, 90, 0)"); // counter-clockwise from above, about (0, 8)
    expectNear(world.low, {0, 8, 0});
    expectNear(world.high, {8, 18, 0});
    const Placed absolute = place("rotate(abs, world, 0, 0, 0)", kWest); // x east, z south, about (10, 8)
    expectNear(absolute.low, {10, -2, 0});
    expectNear(absolute.high, {18, 8, 0});
    // About the scope's own, tilted axis: the wall (x east, y up, z south) turns in its plane.
    const Placed scope =
        place("extrude(6) comp(f) { front : r(0, 90, 0) rotate(rel, scope, 0, 0, 90) B | all : NIL }\nB -->");
    expectNear(scope.low, {0, -6, 0}, 1e-9); // after r: x north; then x up, y south
    expectNear(scope.high, {0, 0, 10}, 1e-9);
}

TEST(GrammarPlacement, RotateScopeKeepsTheGeometry)
{
    const Placed p = place("rotateScope(0, 90, 0)");
    expectNear(p.low, {0, 0, 0});
    expectNear(p.high, {10, 8, 0});
    expectNear(p.size, {8, 0, 10});
    expectNear(p.r, {0, 90, 0});
    const Placed tilted = place("extrude(6) rotateScope(0, 30, 0)");
    const double c = std::sqrt(0.75), s = 0.5;
    expectNear(tilted.size, {10 * c + 8 * s, 6, 10 * s + 8 * c});
    EXPECT_NEAR(enclosedVolume(tilted.d), 480, 1e-9);
}

TEST(GrammarPlacement, MirrorScope)
{
    const Placed p = place("mirrorScope(true, false, false)");
    expectNear(p.low, {0, 0, 0});
    expectNear(p.size, {-10, 0, 8});
    expectNear(p.t, {10, 0, 0});
    expectNear(unitNormal(p.d.shapes.polygons[0]), {0, 0, 1}); // the geometry stays
    const Placed asset = place("mirrorScope(true, false, false) s('1, 2, '1) i(\"a.glb\")");
    expectNear(assetPoint(asset, {0, 0, 0}), {10, 8, 0});
    expectNear(assetPoint(asset, {1, 1, 1}), {0, 0, 2});
}

TEST(GrammarPlacement, SetPivot)
{
    const Placed opposite = place("setPivot(xyz, 2)"); // corner +x +z: x west, y up, z north
    expectNear(opposite.low, {0, 0, 0});
    expectNear(opposite.size, {10, 0, 8});
    expectNear(opposite.t, {0, 0, 0});
    expectNear(opposite.r, {0, 0, 0});
    expectNear(place("setPivot(xyz, 2) t(1, 0, 2)").low, {-1, 2, 0});
    const Placed side = place("setPivot(xyz, 1)"); // corner +x: right-handed only with x along the old z
    expectNear(side.size, {8, 0, 10});
    expectNear(place("setPivot(xyz, 1) t(1, 0, 2)").low, {-2, -1, 0});
    expectNear(place("extrude(6) setPivot(xyz, 4) t(0, 1, 0)").low, {0, 0, -1}); // at the top y points down
    expectNear(place("extrude(6) setPivot(yzx, 0)").size, {8, 10, 6});
    expectNear(place("extrude(6) setPivot(zxy, 0)").size, {6, 8, 10});
    expectNear(place("extrude(6) setPivot(yzx, 0) t(0, 1, 2)").low, {1, 0, 2});
    // r turns about the new pivot: a quarter turn about the north-east corner (10, 8).
    const Placed turned = place("setPivot(xyz, 1) r(0, 90, 0)");
    expectNear(turned.low, {10, 8 - 10, 0});
    EXPECT_NE(errorOf("Lot --> setPivot(xyz, 8) A.").find("0 to 7"), std::string::npos);
}

TEST(GrammarPlacement, AlignScopeToAxes)
{
    const double c = std::sqrt(0.75), s = 0.5;
    for (const std::string axes : {"", "x", "y", "world.y", "world.xyz"}) {
        const Placed p = place("r(0, 30, 0) alignScopeToAxes(" + axes + ")");
        const bool all = axes == "" || axes == "x" || axes == "world.xyz"; // y keeps x, which is level already
        expectNear(p.size, all ? glm::dvec3(10 * c + 8 * s, 0, 10 * s + 8 * c) : glm::dvec3(10, 0, 8));
        expectNear(p.t, {0, 0, 0});
        expectNear(p.r, {0, 0, 0});
    }
    expectNear(place("r(0, 30, 0) alignScopeToAxes(object.xyz)", kWest).size, {8 * c + 10 * s, 0, 8 * s + 10 * c});
    expectNear(place("alignScopeToAxes()", kWest).size, {10, 0, 8});
    expectNear(place("alignScopeToAxes(object.x)", kWest).size, {8, 0, 10});
    // z up on a wall: x stays level, y points into the wall's plane: none of its own extent is along it.
    expectNear(place("extrude(6) comp(f) { front : alignScopeToAxes(y) B | all : NIL }\nB -->").size, {10, 6, 0});
}

TEST(GrammarPlacement, AlignScopeToGeometry)
{
    expectNear(place("alignScopeToGeometry(zUp, any, longest)", kWest).size, {10, 8, 0});
    expectNear(place("alignScopeToGeometry(yUp, any, longest)", kWest).size, {10, 0, 8});
    expectNear(place("alignScopeToGeometry(yUp, 0, 0)", kWest).size, {8, 0, 10});
    expectNear(place("alignScopeToGeometry(yUp, 0, -1)", kWest).size, {10, 0, 8}); // the last edge, westwards
    expectNear(place("alignScopeToGeometry(yUp, 0, -1) t(1, 0, 0)", kWest).low, {-1, 0, 0});
    // A wall turned by a quarter in its plane stands on its former side of 6 m.
    const std::string wall = "extrude(6) comp(f) { front : r(0, 0, 90) ";
    expectNear(place(wall + "B | all : NIL }\nB -->").size, {10, 6, 0});
    expectNear(place(wall + "alignScopeToGeometry(zUp, any, world.lowest) B | all : NIL }\nB -->").size, {6, 10, 0});
    // The largest face of a box of 10 x 8 x 6 is its top or bottom, the lowest its bottom: y points down.
    expectNear(place("extrude(6) alignScopeToGeometry(yUp, world.lowest, longest) t(0, 1, 0)").low, {0, 0, -1});
    EXPECT_NE(errorOf("Lot --> alignScopeToGeometry(zUp, any, 0) A.").find("does not know"), std::string::npos);
}

TEST(GrammarPlacement, AlignScopeToGeometryBBox)
{
    // A plan of 12 x 4 m whose first edge cuts a corner.
    const Footprint cut = footprintOf({{12, 3}, {11, 4}, {0, 4}, {0, 0}, {12, 0}}, 6);
    expectNear(place("alignScopeToGeometryBBox(xz)", cut).size, {12, 0, 4}, 1e-9);
    expectNear(place("alignScopeToGeometryBBox(zx)", cut).size, {4, 0, 12}, 1e-9);
    expectNear(place("extrude(6) alignScopeToGeometryBBox(xz)", cut).size, {12, 6, 4}, 1e-9);
    EXPECT_NEAR(enclosedVolume(place("extrude(6) alignScopeToGeometryBBox(xz)", cut).d), 6 * 47.5, 1e-9);
}

TEST(GrammarPlacement, InitialShapeAndElevation)
{
    Footprint moved = footprintOf({{3, 1}, {13, 1}, {13, 9}, {3, 9}}, 6, {}, "house");
    moved.base = 2;
    const Derivation d =
        mustDerive("Lot --> extrude(6) report(\"px\", initialShape.origin.px) report(\"py\", initialShape.origin.py) "
                   "report(\"pz\", initialShape.origin.pz) report(\"oy\", initialShape.origin.oy) report(\"n\", "
                   "len(initialShape.name)) comp(f) { top : report(\"up\", scope.elevation) A. | all : NIL }",
                   {moved});
    EXPECT_EQ(d.reports,
              (std::map<std::string, double>{{"px", 3}, {"py", 2}, {"pz", -9}, {"oy", 0}, {"n", 5}, {"up", 8}}));
    // West of south: a clockwise turn by 90 degrees, seen from above.
    EXPECT_NEAR(mustDerive("Lot --> report(\"oy\", initialShape.origin.oy) A.", {kWest}).reports.at("oy"), -90, 1e-9);
}

} // namespace
} // namespace helio::test
