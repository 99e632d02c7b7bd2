// SPDX-License-Identifier: Apache-2.0
// Shape operations on geometry computed by hand. World frame: metres, x east, y north, z up.
#include "tests/unit/grammar_support.h"

namespace helio::test {
namespace {

glm::dvec3 normalOf(const Derivation& d, const Shape& leaf)
{
    return unitNormal(d.shapes.polygons[leaf.polygonBegin]);
}

TEST(GrammarShapes, ExtrudeAndComponents)
{
    Footprint box = footprintOf({{3, 1}, {13, 1}, {13, 9}, {3, 9}}, 6); // 10 x 8, south edge first
    box.base = 2;
    const Derivation d = mustDerive(
        "Lot --> extrude(6) comp(f) { front : F. | right : R. | back : B. | left : L. | top : T. | bottom : G. }",
        {box});
    const auto check = [&](std::string_view name, glm::dvec3 normal, glm::dvec3 low, glm::dvec3 high) {
        const auto leaves = leavesOf(d, name);
        ASSERT_EQ(leaves.size(), 1u) << name;
        expectNear(normalOf(d, *leaves[0]), normal);
        expectNear(boundsOf(d, *leaves[0]).first, low);
        expectNear(boundsOf(d, *leaves[0]).second, high);
    };
    check("F", {0, -1, 0}, {3, 1, 2}, {13, 1, 8});
    check("R", {1, 0, 0}, {13, 1, 2}, {13, 9, 8});
    check("B", {0, 1, 0}, {3, 9, 2}, {13, 9, 8});
    check("L", {-1, 0, 0}, {3, 1, 2}, {3, 9, 8});
    check("T", {0, 0, 1}, {3, 1, 8}, {13, 9, 8});
    check("G", {0, 0, -1}, {3, 1, 2}, {13, 9, 2});
    EXPECT_NEAR(enclosedVolume(d), 10 * 8 * 6, 1e-9);
}

TEST(GrammarShapes, ExtrudeForms)
{
    // A wall of 10 x 6 grown outwards by 1 m: its far face lies at y = -1.
    const Derivation out =
        mustDerive("Lot --> extrude(6) comp(f) { front : extrude(face.normal, 1) comp(f) { all : A. } | all : NIL }",
                   {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(enclosedVolume(out), 60, 1e-9);
    EXPECT_EQ(leavesOf(out, "A").size(), 6u);
    double least = 0;
    for (const Shape* leaf : leavesOf(out, "A")) least = std::min(least, boundsOf(out, *leaf).first.y);
    EXPECT_NEAR(least, -1, 1e-12);
    const Derivation up = mustDerive("Lot --> extrude(world.up, 4) A.", {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(enclosedVolume(up), 320, 1e-9);
    const Derivation flat = mustDerive("Lot --> extrude(0) A.", {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(totalArea(flat), 80, 1e-9);
    EXPECT_EQ(flat.warnings.size(), 1u);
}

TEST(GrammarShapes, ConcaveCourtyardAndTriangle)
{
    const std::string rules =
        "Lot --> extrude(height) comp(f) { side : Wall | top : Roof. | bottom : Floor. }\nattr height = 1\n"
        "Wall --> split(y) { 4 : Base. | { ~3 : split(x) { 0.5 : Pier. | { ~2 : Bay. }* } }* }";
    const Ring2 l = {{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}}, triangle = {{0, 0}, {8, 0}, {0, 6}},
                square = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
    struct Case
    {
        Footprint footprint;
        double area, perimeter;
    };
    for (const Case& c : {Case{footprintOf(l, 12), 64, 40}, Case{footprintOf(triangle, 12), 24, 24},
                          Case{footprintOf(square, 12, {{{3, 3}, {3, 7}, {7, 7}, {7, 3}}}), 84, 56}}) {
        const Derivation d = mustDerive(rules, {c.footprint});
        EXPECT_NEAR(totalArea(d), 2 * c.area + 12 * c.perimeter, 1e-9);
        EXPECT_NEAR(areaOf(d, "Base"), 4 * c.perimeter, 1e-9);
        EXPECT_NEAR(enclosedVolume(d), 12 * c.area, 1e-9); // closed, and every leaf looks outward
        EXPECT_TRUE(d.warnings.empty()) << d.warnings[0];
    }
}

TEST(GrammarShapes, SplitPlacesParts)
{
    // Right wall: x runs along its edge, north; 8 m = 2 | 3 x 1.5 | 1.5.
    const Derivation d = mustDerive("Lot --> extrude(6) comp(f) { right : split(x) { 2 : A. | { ~1.6 : B(split.index, "
                                    "split.total) }* | 1.5 : C. } | all : NIL }\n"
                                    "B(i, n) --> report(\"index\", i) report(\"total\", n) B.",
                                    {boxFootprint(10, 8, 6)});
    expectNear(boundsOf(d, *leavesOf(d, "A")[0]).second, {10, 2, 6});
    ASSERT_EQ(leavesOf(d, "B").size(), 3u);
    expectNear(boundsOf(d, *leavesOf(d, "B")[1]).first, {10, 3.5, 0});
    expectNear(boundsOf(d, *leavesOf(d, "B")[1]).second, {10, 5, 6});
    expectNear(boundsOf(d, *leavesOf(d, "C")[0]).second, {10, 8, 6});
    EXPECT_EQ(d.reports.at("index"), 1 + 2 + 3);
    EXPECT_EQ(d.reports.at("total"), 3 * 5);
}

TEST(GrammarShapes, SplitShrinksTheScopeToTheGeometryUnlessToldNotTo)
{
    // A triangle of 8 x 6 cut at x = 4: the part beyond is 4 m long and 3 m deep.
    const Footprint triangle = footprintOf({{0, 0}, {8, 0}, {0, 6}}, 5);
    const std::string body = "{ 4 : NIL | ~1 : report(\"depth\", scope.sz) report(\"x\", scope.sx) A. }";
    EXPECT_NEAR(mustDerive("Lot --> split(x) " + body, {triangle}).reports.at("depth"), 3, 1e-9);
    EXPECT_NEAR(mustDerive("Lot --> split(x, noAdjust) " + body, {triangle}).reports.at("depth"), 6, 1e-9);
    EXPECT_NEAR(mustDerive("Lot --> split(x, noAdjust) " + body, {triangle}).reports.at("x"), 4, 1e-9);
}

TEST(GrammarShapes, SplitOfASolidIsClosed)
{
    const Derivation d =
        mustDerive("Lot --> extrude(9) split(y) { ~3 : Storey. }*",
                   {footprintOf({{0, 0}, {10, 0}, {10, 10}, {0, 10}}, 9, {{{3, 3}, {3, 7}, {7, 7}, {7, 3}}})});
    ASSERT_EQ(leavesOf(d, "Storey").size(), 3u);
    EXPECT_NEAR(enclosedVolume(d), 84 * 9, 1e-9);
    EXPECT_NEAR(areaOf(d, *leavesOf(d, "Storey")[1]), 2 * 84 + 3 * 56,
                1e-9); // floor and ceiling with the court as a hole
}

TEST(GrammarShapes, ResizeTranslateRotateCenter)
{
    const Footprint box = boxFootprint(10, 8, 6);
    // s sets sizes; the lot's z axis points south, out of the first edge, and its origin is the north-west corner.
    const Derivation s = mustDerive("Lot --> s('0.5, 0, 2) A.", {box});
    expectNear(boundsOf(s, *leavesOf(s, "A")[0]).first, {0, 6, 0});
    expectNear(boundsOf(s, *leavesOf(s, "A")[0]).second, {5, 8, 0});
    const Derivation t = mustDerive("Lot --> t(1, 2, 3) A.", {box});
    expectNear(boundsOf(t, *leavesOf(t, "A")[0]).first, {1, -3, 2});
    const Derivation c = mustDerive("Lot --> [ s(4, 0, 2) center(xz) A. ]", {box});
    expectNear(boundsOf(c, *leavesOf(c, "A")[0]).first, {3, 3, 0});
    expectNear(boundsOf(c, *leavesOf(c, "A")[0]).second, {7, 5, 0});
    const Derivation cx = mustDerive("Lot --> [ s(4, 0, 2) center(x) A. ]", {box});
    expectNear(boundsOf(cx, *leavesOf(cx, "A")[0]).first, {3, 6, 0});
    // A quarter turn about the upright axis, counter-clockwise from above, about the corner (0, 8): x points north.
    const Derivation r = mustDerive("Lot --> r(0, 90, 0) report(\"ry\", scope.ry) A.", {box});
    expectNear(boundsOf(r, *leavesOf(r, "A")[0]).first, {0, 8, 0});
    expectNear(boundsOf(r, *leavesOf(r, "A")[0]).second, {8, 18, 0});
    EXPECT_NEAR(r.reports.at("ry"), 90, 1e-9);
    const Derivation rc = mustDerive("Lot --> r(scopeCenter, 0, 90, 0) A.", {box});
    expectNear(boundsOf(rc, *leavesOf(rc, "A")[0]).first, {1, -1, 0});
    expectNear(boundsOf(rc, *leavesOf(rc, "A")[0]).second, {9, 9, 0});
}

TEST(GrammarShapes, ScopeAttributes)
{
    const Derivation d =
        mustDerive("Lot --> extrude(6) comp(f) { right : t(1, 2, 3) report(\"tx\", scope.tx) report(\"ty\", scope.ty) "
                   "report(\"tz\", scope.tz)"
                   " report(\"up\", scope.elevation) report(\"sx\", scope.sx) report(\"sz\", scope.sz) A. }",
                   {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(d.reports.at("tx"), 1, 1e-12);
    EXPECT_NEAR(d.reports.at("ty"), 2, 1e-12);
    EXPECT_NEAR(d.reports.at("tz"), 3, 1e-12);
    EXPECT_NEAR(d.reports.at("up"), 2, 1e-12);
    EXPECT_NEAR(d.reports.at("sx"), 8, 1e-12);
    EXPECT_NEAR(d.reports.at("sz"), 0, 1e-12);
}

TEST(GrammarShapes, AlignScopeToAxes)
{
    // The roof face has z up; aligned, y is up, and the face keeps its place.
    const Derivation d = mustDerive("Lot --> extrude(6) comp(f) { top : alignScopeToAxes(y) report(\"sy\", scope.sy) "
                                    "report(\"sz\", scope.sz) s('1, 2, '1) primitiveCube() A. | all : NIL }",
                                    {boxFootprint(10, 8, 6)});
    EXPECT_NEAR(d.reports.at("sy"), 0, 1e-12);
    EXPECT_NEAR(d.reports.at("sz"), 8, 1e-12);
    expectNear(boundsOf(d, *leavesOf(d, "A")[0]).first, {0, 0, 6});
    expectNear(boundsOf(d, *leavesOf(d, "A")[0]).second, {10, 8, 8});
    EXPECT_NEAR(enclosedVolume(d), 160, 1e-9);
}

TEST(GrammarShapes, Primitives)
{
    const Footprint box = boxFootprint(10, 8, 6);
    const Derivation cube = mustDerive("Lot --> s(2, 3, 4) primitiveCube() A.", {box});
    EXPECT_NEAR(enclosedVolume(cube), 24, 1e-9);
    EXPECT_EQ(leavesOf(cube, "A")[0]->polygonCount, 6u);
    const Derivation quad =
        mustDerive("Lot --> extrude(6) comp(f) { front : s(2, 3, 0) primitiveQuad() A. | all : NIL }", {box});
    EXPECT_NEAR(totalArea(quad), 6, 1e-12);
    expectNear(normalOf(quad, *leavesOf(quad, "A")[0]), {0, -1, 0});
    const Derivation sized = mustDerive("Lot --> primitiveQuad(2, 5) A.", {box});
    EXPECT_NEAR(totalArea(sized), 10, 1e-12);
    expectNear(normalOf(sized, *leavesOf(sized, "A")[0]), {0, 0, 1});
}

TEST(GrammarShapes, GeometryFunctions)
{
    const Derivation d = mustDerive(
        "Lot --> report(\"area\", geometry.area()) report(\"edges\", geometry.nEdges) extrude(6) report(\"all\", "
        "geometry.area)"
        " report(\"side\", geometry.area(side)) report(\"top\", geometry.area(top)) report(\"volume\", geometry.volume)"
        " report(\"height\", geometry.height) report(\"faces\", geometry.nFaces) report(\"vertices\", "
        "geometry.nVertices)"
        " report(\"concave\", geometry.isConcave) report(\"nEdges\", geometry.nEdges) A.",
        {footprintOf({{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}}, 6)});
    const std::map<std::string, double> expected = {
        {"area", 64},  {"edges", 6}, {"all", 128 + 240}, {"side", 240},  {"top", 64},   {"volume", 384},
        {"height", 6}, {"faces", 8}, {"vertices", 12},   {"concave", 1}, {"nEdges", 18}};
    for (const auto& [key, value] : expected) EXPECT_NEAR(d.reports.at(key), value, 1e-9) << key;
}

TEST(GrammarShapes, StreetSelectorsSkipCourtyards)
{
    const Footprint court = footprintOf({{0, 0}, {10, 0}, {10, 10}, {0, 10}}, 6, {{{3, 3}, {3, 7}, {7, 7}, {7, 3}}});
    const Derivation d = mustDerive(
        "Lot --> extrude(6) comp(f) { street.front : Street. | street.side : Side. | side : Court. | all : NIL }",
        {court});
    EXPECT_NEAR(areaOf(d, "Street"), 60, 1e-9);
    EXPECT_NEAR(areaOf(d, "Side"), 180, 1e-9);
    EXPECT_NEAR(areaOf(d, "Court"), 4 * 4 * 6, 1e-9);
    // Object and world forms: the first edge of this box faces west, so its front is the world's west.
    const Footprint west = footprintOf({{0, 8}, {0, 0}, {10, 0}, {10, 8}}, 6);
    const Derivation e = mustDerive("Lot --> extrude(6) comp(f) { world.south : South. | object.front : Front. | "
                                    "world.north : North. | 1 : NIL | all : Other. }",
                                    {west});
    EXPECT_NEAR(areaOf(e, "South"), 60, 1e-9);
    EXPECT_NEAR(areaOf(e, "Front"), 48, 1e-9);
    EXPECT_NEAR(areaOf(e, "North"), 60, 1e-9);
    EXPECT_NEAR(areaOf(e, "Other"), 48 + 80 + 80, 1e-9);
}

// ---- assets: the unit cube
glm::dvec3 placed(const Shape& leaf, glm::dvec3 p)
{
    return leaf.worldFromAsset * glm::dvec4(p, 1);
}

TEST(GrammarShapes, AssetsFillOrOverlay)
{
    const Derivation d = mustDerive(
        "Lot --> extrude(6) comp(f) { front : split(x) { 2 : Sunk | 2 : Balcony | ~1 : Wall. } | all : NIL }\n"
        "Sunk --> s('1, '1, 0.3) t(0, 0, -0.3) i(\"w.glb\") Window.\nBalcony --> Wall. Rail\nRail --> s('1, 1, 0.5) "
        "i(\"b.glb\") Rail.",
        {boxFootprint(10, 8, 6)});
    const Shape& window = *leavesOf(d, "Window")[0];
    EXPECT_EQ(window.placement, AssetPlacement::Fill);
    EXPECT_EQ(window.op, ShapeOp::Insert);
    EXPECT_EQ(d.shapes.assets[window.asset], "w.glb");
    // The tile is the piece of the facade before s and t: in the plane y = 0.
    expectNear(boundsOf(d, window).first, {0, 0, 0});
    expectNear(boundsOf(d, window).second, {2, 0, 6});
    expectNear(placed(window, {0, 0, 0}), {0, 0.3, 0}); // back, left, bottom of the asset
    expectNear(placed(window, {1, 1, 1}), {2, 0, 6});   // front, right, top
    const Shape& rail = *leavesOf(d, "Rail")[0];
    EXPECT_EQ(rail.placement, AssetPlacement::Overlay);
    EXPECT_EQ(rail.polygonCount, 0u);
    expectNear(placed(rail, {0, 0, 0}), {2, 0, 0});
    expectNear(placed(rail, {1, 1, 1}), {4, -0.5, 1});
    EXPECT_NEAR(totalArea(d), 60, 1e-9);
    EXPECT_TRUE(d.warnings.empty()) << d.warnings[0];
}

TEST(GrammarShapes, FillNeedsTheWholeTile)
{
    const auto placement = [](const std::string& operations) {
        const Derivation d = mustDerive("Lot --> extrude(6) comp(f) { front : Wall. W | all : NIL }\nW --> " +
                                            operations + " i(\"w.glb\") Window.",
                                        {boxFootprint(10, 8, 6)});
        return leavesOf(d, "Window")[0]->placement;
    };
    EXPECT_EQ(placement("s('1, '1, 0.3) t(0, 0, -0.3)"), AssetPlacement::Fill);
    EXPECT_EQ(placement("s('1, '1, 0.3) t(0, 0, -0.295)"), AssetPlacement::Fill);   // 5 mm in front
    EXPECT_EQ(placement("s('1, '1, 0.3) t(0, 0, -0.28)"), AssetPlacement::Overlay); // 2 cm in front
    EXPECT_EQ(placement("s(scope.sx - 0.02, '1, 0.3) t(0, 0, -0.3)"), AssetPlacement::Overlay);
    EXPECT_EQ(placement("s('1, '1, 0.3) t(0.02, 0, -0.3)"), AssetPlacement::Overlay);
    EXPECT_EQ(placement("s('1, '1, 0.3)"), AssetPlacement::Overlay);
}

TEST(GrammarShapes, AssetSizesThatAreZeroFollowTheAsset)
{
    DeriveOptions options = unitAssets();
    options.assetBox = [](const std::string&) -> Result<AssetBox> {
        return AssetBox{{-1, 0, 2}, {1, 4, 3}};
    }; // 2 x 4 x 1
    glm::dvec3 corner;
    const auto sizes = [&](const std::string& operations) {
        const Derivation d =
            mustDerive("Lot --> [ " + operations +
                           " i(\"a.glb\") report(\"x\", scope.sx) report(\"y\", scope.sy) report(\"z\", scope.sz) A. ]",
                       {boxFootprint(10, 8, 6)}, options);
        corner = placed(*leavesOf(d, "A")[0], {-1, 0, 2}); // the box's lowest corner
        return glm::dvec3(d.reports.at("x"), d.reports.at("y"), d.reports.at("z"));
    };
    expectNear(sizes("s(6, 4, 5)"), {6, 4, 5});
    expectNear(corner, {0, 8, 0});              // in the scope's origin
    expectNear(sizes("s(0, 0, 0)"), {2, 4, 1}); // its own size, and its own origin in the scope's: z points south
    expectNear(corner, {-1, 8 - 2, 0});
    expectNear(sizes("s(0, 8, 0)"), {4, 8, 2}); // uniform scale 2, and its own place along x and z
    expectNear(corner, {-2, 8 - 4, 0});
    expectNear(sizes("s(6, 4, 0)"), {6, 4, 2}); // depth: mean of the scales 3 and 1, times 1
    expectNear(corner, {0, 8, 0});
    // The same by the mode of insertion; the third one stands in the middle of the scope's floor (10 x 8 m).
    expectNear(sizes("i(\"a.glb\", yUp, keepSizeAndPosition)"), {2, 4, 1});
    expectNear(sizes("i(\"a.glb\", yUp, keepSizeAlignPosition)"), {2, 4, 1});
    const Derivation up =
        mustDerive("Lot --> s(0, 0, 0) i(\"a.glb\", zUp) report(\"y\", scope.sy) report(\"z\", scope.sz) A.",
                   {boxFootprint(10, 8, 6)}, options);
    EXPECT_NEAR(up.reports.at("y"), 1, 1e-12); // the asset's z stands upright
    EXPECT_NEAR(up.reports.at("z"), 4, 1e-12);
    expectNear(placed(*leavesOf(up, "A")[0], {-1, 0, 3}) - placed(*leavesOf(up, "A")[0], {-1, 0, 2}), {0, 0, 1});
}

TEST(GrammarShapes, AssetsMoveAndScaleAfterInsertion)
{
    const Derivation d =
        mustDerive("Lot --> s(2, 2, 2) i(\"a.glb\") t(1, 0, 0) s('2, '1, '1) A.", {boxFootprint(10, 8, 6)});
    const Shape& leaf = *leavesOf(d, "A")[0];
    expectNear(placed(leaf, {0, 0, 0}), {1, 8, 0});
    expectNear(placed(leaf, {1, 1, 1}), {5, 6, 2});
}

TEST(GrammarShapes, OverlapsAndHolesAreWarnedAbout)
{
    const auto warnings = [](const std::string& wall) {
        return mustDerive("Lot --> extrude(6) comp(f) { front : W | all : NIL }\nW --> " + wall,
                          {boxFootprint(10, 8, 6)})
            .warnings;
    };
    EXPECT_EQ(warnings("A. B.").size(), 1u);
    EXPECT_NE(warnings("A. B.")[0].find("several surfaces"), std::string::npos);
    EXPECT_EQ(warnings("A. t(0, 0, 1) B.").size(), 0u);
    EXPECT_EQ(warnings("split(x) { 4 : A. | ~1 : B. }").size(), 0u);
    ASSERT_EQ(warnings("i(\"a.glb\") A.").size(), 1u);
    EXPECT_NE(warnings("i(\"a.glb\") A.")[0].find("hole"), std::string::npos);
    EXPECT_EQ(warnings("[ s('1, '1, 1) i(\"a.glb\") A. ] B.").size(), 0u);
}

} // namespace
} // namespace helio::test
