// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/vocabulary.h"

#include <span>
#include <utility>

namespace helio::cga {

namespace {

template <class T> using Entry = std::pair<std::string_view, T>;

template <class T> std::optional<T> lookUp(std::span<const Entry<T>> table, std::string_view name)
{
    for (const Entry<T>& entry : table)
        if (entry.first == name) return entry.second;
    return {};
}

constexpr u32 kFirst = 1, kAnyWord = ~0u, kMany = 99;

constexpr Entry<OperationInfo> kOperations[] = {
    {"alignScopeToAxes", {Operation::AlignScopeToAxes, 0, 1, kFirst, false, "alignScopeToAxes(y)"}},
    {"alignScopeToGeometry",
     {Operation::AlignScopeToGeometry, 3, 3, 7, false,
      "alignScopeToGeometry(zUp, any, longest): yUp or zUp; any, largest, world.lowest or a face's number; longest, "
      "world.lowest or an edge's number"}},
    {"alignScopeToGeometryBBox",
     {Operation::AlignScopeToGeometryBBox, 1, 1, kFirst, false, "alignScopeToGeometryBBox(xz)"}},
    {"center", {Operation::Center, 1, 1, kFirst, false, "center(xy)"}},
    {"cleanupGeometry",
     {Operation::CleanupGeometry, 2, 2, kFirst, false, "cleanupGeometry(all, 0.1): vertices, edges, faces or all"}},
    {"color", {Operation::Color, 1, 4, 0, false, "color(\"#rrggbb\") or color(r, g, b)"}},
    {"comp", {Operation::Component, 1, 1, kFirst, true, "comp(f) { front : Front | side : Wall | top : Roof }"}},
    {"deleteHoles", {Operation::DeleteHoles, 0, 0, 0, false, "deleteHoles()"}},
    {"extrude", {Operation::Extrude, 1, 2, kFirst, false, "extrude(height) or extrude(world.up, height)"}},
    {"i",
     {Operation::Insert, 1, 4, 14, false,
      "i(\"folder/name.glb\") or i(\"name.glb\", zUp, keepSizeAlignPosition)"}},
    {"innerRect", {Operation::InnerRect, 0, 0, 0, false, "innerRect()"}},
    {"innerRectangle",
     {Operation::InnerRectangle, 1, 1, kFirst, true, "innerRectangle(edge) { shape : House | remainder : Garden }"}},
    {"mirror", {Operation::Mirror, 3, 3, 0, false, "mirror(true, false, false)"}},
    {"mirrorScope", {Operation::MirrorScope, 3, 3, 0, false, "mirrorScope(true, false, false)"}},
    {"NIL", {Operation::Nil, 0, 0, 0, false, "NIL"}},
    {"offset", {Operation::Offset, 1, 2, 2, false, "offset(-0.5) or offset(-0.5, inside): all, inside or border"}},
    {"primitiveCone", {Operation::PrimitiveCone, 0, 3, 0, false, "primitiveCone(sides, radius, height)"}},
    {"primitiveCube", {Operation::PrimitiveCube, 0, 3, 0, false, "primitiveCube(width, height, depth)"}},
    {"primitiveCylinder", {Operation::PrimitiveCylinder, 0, 3, 0, false, "primitiveCylinder(sides, radius, height)"}},
    {"primitiveDisk", {Operation::PrimitiveDisk, 0, 2, 0, false, "primitiveDisk(corners, radius)"}},
    {"primitiveQuad", {Operation::PrimitiveQuad, 0, 2, 0, false, "primitiveQuad(width, length)"}},
    {"primitiveSphere", {Operation::PrimitiveSphere, 0, 3, 0, false, "primitiveSphere(sidesX, sidesY, radius)"}},
    {"print", {Operation::Print, 1, 1, 0, false, "print(\"text\")"}},
    {"report", {Operation::Report, 2, 2, 0, false, "report(\"key\", value)"}},
    {"s", {Operation::Resize, 3, 3, 0, false, "s(x, y, z)"}},
    {"r", {Operation::Rotate, 3, 4, kFirst, false, "r(x, y, z) or r(scopeCenter, x, y, z)"}},
    {"reverseNormals", {Operation::ReverseNormals, 0, 0, 0, false, "reverseNormals()"}},
    {"roofGable",
     {Operation::RoofGable, 1, 6, kFirst, false,
      "roofGable(angle, overhangX, overhangY, even, index) or roofGable(byHeight, height, overhangX, overhangY, even)"}},
    {"roofHip",
     {Operation::RoofHip, 1, 4, kFirst, false,
      "roofHip(angle, overhang, even) or roofHip(byHeight, height, overhang, even)"}},
    {"roofPyramid", {Operation::RoofPyramid, 1, 2, kFirst, false, "roofPyramid(angle) or roofPyramid(byHeight, height)"}},
    {"roofShed", {Operation::RoofShed, 1, 3, kFirst, false, "roofShed(angle, index) or roofShed(byHeight, height, index)"}},
    {"rotate", {Operation::RotateIn, 5, 5, 3, false, "rotate(rel, world, x, y, z): abs or rel; scope, pivot, object or world"}},
    {"rotateScope", {Operation::RotateScope, 3, 3, 0, false, "rotateScope(x, y, z)"}},
    {"scatter",
     {Operation::Scatter, 3, 5, 13, true,
      "scatter(surface, 20, uniform) { Tree } or scatter(surface, 20, gaussian, center, 2) { Tree }: surface, volume or "
      "scope; center, front, back, left, right, top or bottom"}},
    {"set", {Operation::Set, 2, 2, kFirst, false, "set(material.name, \"limestone\")"}},
    {"setback", {Operation::Setback, 1, 1, 0, true, "setback(3) { street.front : Garden | remainder : House }"}},
    {"setbackPerEdge",
     {Operation::SetbackPerEdge, 1, 1, 0, true, "setbackPerEdge(rand(3)) { all : Garden | remainder : House }"}},
    {"setPivot", {Operation::SetPivot, 2, 2, kFirst, false, "setPivot(xyz, corner): xyz, yzx or zxy; 0 to 7"}},
    {"shapeL", {Operation::ShapeL, 2, 2, 0, true, "shapeL(frontWidth, leftWidth) { shape : House | remainder : Garden }"}},
    {"shapeO",
     {Operation::ShapeO, 4, 4, 0, true,
      "shapeO(frontWidth, rightWidth, backWidth, leftWidth) { shape : House | remainder : Court }"}},
    {"shapeU",
     {Operation::ShapeU, 3, 3, 0, true,
      "shapeU(frontWidth, rightWidth, leftWidth) { shape : House | remainder : Court }"}},
    {"split", {Operation::Split, 1, 2, 3, true, "split(x) { 1 : A | ~2 : B }"}},
    {"t", {Operation::Translate, 3, 3, 0, false, "t(x, y, z)"}},
    {"taper", {Operation::Taper, 1, 1, 0, false, "taper(height)"}},
    {"trim", {Operation::Trim, 0, 0, 0, false, "trim()"}},
    {"translate",
     {Operation::TranslateIn, 5, 5, 3, false,
      "translate(rel, world, x, y, z): abs or rel; scope, pivot, object or world"}},
    {"copyUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"deleteUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"label", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"normalizeUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"projectUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"rotateUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"scaleUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"setupProjection", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"texture", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"tileUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"translateUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
};

constexpr std::string_view kFlatRoof =
    "use roofGable(byAngle, 30), roofHip or roofShed";
constexpr std::string_view kShapes = "use extrude, split, primitiveCube() or i(\"part.glb\")";
constexpr std::string_view kNoMesh = "there is no mesh algebra: build the shape with extrude, split and comp(f)";

constexpr Entry<std::string_view> kRefusedOperations[] = {
    {"roofRidge", kFlatRoof},
    {"envelope", kShapes},
    {"setbackToArea", "use setback with a distance"},
    {"splitArea", "use split(x) with sizes"},
    {"splitAndSetbackPerimeter", "use setback(3) { street.front : .. | remainder : .. } and split(x)"},
    {"inline", kNoMesh},
    {"intersect", kNoMesh},
    {"modify", kNoMesh},
    {"subtract", kNoMesh},
    {"union", kNoMesh},
    {"insertAlongUV", kNoMesh},
    {"convexify", kNoMesh},
    {"footprint", kNoMesh},
    {"rectify", kNoMesh},
    {"reduceGeometry", kNoMesh},
    {"resetGeometry", kNoMesh},
    {"setNormals", kNoMesh},
    {"softenNormals", kNoMesh},
    {"deleteTags", "tags are not supported: select faces with comp(f)"},
    {"tag", "tags are not supported: select faces with comp(f)"},
    {"setTagsFromEdgeAttrs", "tags are not supported: select faces with comp(f)"},
    {"resetMaterial", "use color and set(material.name, ..)"},
    {"setMaterial", "use color and set(material.name, ..)"},
};

constexpr Entry<FunctionInfo> kFunctions[] = {
    {"abs", {Function::Abs, 1, 1, false}},
    {"acos", {Function::Acos, 1, 1, false}},
    {"asin", {Function::Asin, 1, 1, false}},
    {"atan", {Function::Atan, 1, 1, false}},
    {"atan2", {Function::Atan2, 2, 2, false}},
    {"bool", {Function::Bool, 1, 1, false}},
    {"ceil", {Function::Ceil, 1, 1, false}},
    {"clamp", {Function::Clamp, 3, 3, false}},
    {"cos", {Function::Cos, 1, 1, false}},
    {"count", {Function::Count, 2, 2, false}},
    {"exp", {Function::Exp, 1, 1, false}},
    {"find", {Function::Find, 2, 3, false}},
    {"float", {Function::Float, 1, 1, false}},
    {"floor", {Function::Floor, 1, 1, false}},
    {"inside", {Function::Inside, 0, 2, true}},
    {"int", {Function::Int, 1, 1, false}},
    {"isinf", {Function::IsInf, 1, 1, false}},
    {"isnan", {Function::IsNan, 1, 1, false}},
    {"len", {Function::Len, 1, 1, false}},
    {"ln", {Function::Ln, 1, 1, false}},
    {"log10", {Function::Log10, 1, 1, false}},
    {"max", {Function::Max, 2, kMany, false}},
    {"min", {Function::Min, 2, kMany, false}},
    {"overlaps", {Function::Overlaps, 0, 2, true}},
    {"p", {Function::P, 1, 1, false}},
    {"pow", {Function::Pow, 2, 2, false}},
    {"rand", {Function::Rand, 0, 2, false}},
    {"replace", {Function::Replace, 3, 3, false}},
    {"rgb", {Function::Rgb, 3, 3, false}},
    {"rint", {Function::Rint, 1, 1, false}},
    {"sin", {Function::Sin, 1, 1, false}},
    {"sqrt", {Function::Sqrt, 1, 1, false}},
    {"str", {Function::Str, 1, 1, false}},
    {"substring", {Function::Substring, 3, 3, false}},
    {"tan", {Function::Tan, 1, 1, false}},
    {"touches", {Function::Touches, 0, 2, true}},
    {"geometry.area", {Function::GeometryArea, 0, 1, true}},
    {"geometry.boundaryLength", {Function::GeometryBoundaryLength, 0, 0, false}},
    {"geometry.height", {Function::GeometryHeight, 0, 0, false}},
    {"geometry.isClosedSurface", {Function::GeometryIsClosedSurface, 0, 0, false}},
    {"geometry.isConcave", {Function::GeometryIsConcave, 0, 0, false}},
    {"geometry.isOriented", {Function::GeometryIsOriented, 0, 0, false}},
    {"geometry.isPlanar", {Function::GeometryIsPlanar, 0, 0, false}},
    {"geometry.isRectangular", {Function::GeometryIsRectangular, 0, 1, false}},
    {"geometry.nEdges", {Function::GeometryNEdges, 0, 0, false}},
    {"geometry.nFaces", {Function::GeometryNFaces, 0, 0, false}},
    {"geometry.nHoles", {Function::GeometryNHoles, 0, 0, false}},
    {"geometry.nVertices", {Function::GeometryNVertices, 0, 0, false}},
    {"geometry.volume", {Function::GeometryVolume, 0, 0, false}},
};

constexpr std::string_view kNoFiles =
    "rules cannot look at files: name them, for example 50% : \"a.glb\" else : \"b.glb\"";
constexpr Entry<std::string_view> kRefusedFunctions[] = {
    {"assetInfo", kNoFiles},
    {"assetsSortRatio", kNoFiles},
    {"assetsSortSize", kNoFiles},
    {"fileExists", kNoFiles},
    {"fileRandom", kNoFiles},
    {"fileSearch", kNoFiles},
    {"imageInfo", kNoFiles},
    {"imagesSortRatio", kNoFiles},
    {"readTable", kNoFiles},
    {"contextCount", "use touches(inter), which knows the walls that neighbours cover"},
    {"minimumDistance", "use touches(inter), which knows the walls that neighbours cover"},
    {"contextCompare", "use touches(inter), which knows the walls that neighbours cover"},
    {"splitString", "arrays are not supported: use find and substring"},
    {"geometry.angle", "select faces by slope with comp(f) { vertical : .. | aslant : .. | horizontal : .. }"},
    {"geometry.du", "there are no texture coordinates: use scope.sx"},
    {"geometry.dv", "there are no texture coordinates: use scope.sy"},
    {"convert", "use scope.tx, scope.elevation and initialShape.origin.px"},
    {"comp", "arrays are not supported"},
    {"size", "arrays are not supported"},
    {"index", "arrays are not supported"},
};

constexpr Entry<ShapeAttribute> kShapeAttributes[] = {
    {"scope.sx", ShapeAttribute::ScopeSx},
    {"scope.sy", ShapeAttribute::ScopeSy},
    {"scope.sz", ShapeAttribute::ScopeSz},
    {"scope.tx", ShapeAttribute::ScopeTx},
    {"scope.ty", ShapeAttribute::ScopeTy},
    {"scope.tz", ShapeAttribute::ScopeTz},
    {"scope.rx", ShapeAttribute::ScopeRx},
    {"scope.ry", ShapeAttribute::ScopeRy},
    {"scope.rz", ShapeAttribute::ScopeRz},
    {"scope.elevation", ShapeAttribute::ScopeElevation},
    {"split.index", ShapeAttribute::SplitIndex},
    {"split.total", ShapeAttribute::SplitTotal},
    {"comp.index", ShapeAttribute::CompIndex},
    {"comp.total", ShapeAttribute::CompTotal},
    {"comp.sel", ShapeAttribute::CompSel},
    {"seedian", ShapeAttribute::Seedian},
    {"initialShape.name", ShapeAttribute::InitialShapeName},
    {"initialShape.origin.px", ShapeAttribute::InitialShapeOriginPx},
    {"initialShape.origin.py", ShapeAttribute::InitialShapeOriginPy},
    {"initialShape.origin.pz", ShapeAttribute::InitialShapeOriginPz},
    {"initialShape.origin.ox", ShapeAttribute::InitialShapeOriginOx},
    {"initialShape.origin.oy", ShapeAttribute::InitialShapeOriginOy},
    {"initialShape.origin.oz", ShapeAttribute::InitialShapeOriginOz},
    {"material.color.r", ShapeAttribute::ColorR},
    {"material.color.g", ShapeAttribute::ColorG},
    {"material.color.b", ShapeAttribute::ColorB},
    {"material.color.rgb", ShapeAttribute::ColorRgb},
    {"material.name", ShapeAttribute::MaterialName},
    {"material.emissive.r", ShapeAttribute::EmissiveR},
    {"material.emissive.g", ShapeAttribute::EmissiveG},
    {"material.emissive.b", ShapeAttribute::EmissiveB},
    {"material.opacity", ShapeAttribute::Opacity},
    {"trim.vertical", ShapeAttribute::TrimVertical},
    {"trim.horizontal", ShapeAttribute::TrimHorizontal},
};

constexpr Entry<Selector> kSelectors[] = {
    {"front", Selector::Front},
    {"right", Selector::Right},
    {"back", Selector::Back},
    {"left", Selector::Left},
    {"top", Selector::Top},
    {"bottom", Selector::Bottom},
    {"side", Selector::Side},
    {"vertical", Selector::Vertical},
    {"horizontal", Selector::Horizontal},
    {"aslant", Selector::Aslant},
    {"nutant", Selector::Nutant},
    {"all", Selector::All},
    {"object.front", Selector::ObjectFront},
    {"object.right", Selector::ObjectRight},
    {"object.back", Selector::ObjectBack},
    {"object.left", Selector::ObjectLeft},
    {"object.top", Selector::ObjectTop},
    {"object.bottom", Selector::ObjectBottom},
    {"object.side", Selector::ObjectSide},
    {"world.south", Selector::WorldSouth},
    {"world.east", Selector::WorldEast},
    {"world.north", Selector::WorldNorth},
    {"world.west", Selector::WorldWest},
    {"world.up", Selector::WorldUp},
    {"world.down", Selector::WorldDown},
    {"world.side", Selector::WorldSide},
    {"street.front", Selector::StreetFront},
    {"street.right", Selector::StreetRight},
    {"street.back", Selector::StreetBack},
    {"street.left", Selector::StreetLeft},
    {"street.side", Selector::StreetSide},
    {"border", Selector::Border},
    {"inside", Selector::Inside},
    {"ridge", Selector::Ridge},
    {"hip", Selector::Hip},
    {"valley", Selector::Valley},
    {"eave", Selector::Eave},
    {"shape", Selector::Shape},
    {"remainder", Selector::Remainder},
};

} // namespace

std::optional<OperationInfo> findOperation(std::string_view name)
{
    return lookUp<OperationInfo>(kOperations, name);
}
std::string_view refusedOperation(std::string_view name)
{
    return lookUp<std::string_view>(kRefusedOperations, name).value_or("");
}
std::optional<FunctionInfo> findFunction(std::string_view name)
{
    return lookUp<FunctionInfo>(kFunctions, name);
}
std::string_view refusedFunction(std::string_view name)
{
    return lookUp<std::string_view>(kRefusedFunctions, name).value_or("");
}
std::optional<ShapeAttribute> findShapeAttribute(std::string_view name)
{
    return lookUp<ShapeAttribute>(kShapeAttributes, name);
}
std::optional<Selector> findSelector(std::string_view name)
{
    return lookUp<Selector>(kSelectors, name);
}

} // namespace helio::cga
