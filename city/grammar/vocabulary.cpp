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
    {"center", {Operation::Center, 1, 1, kFirst, false, "center(xy)"}},
    {"color", {Operation::Color, 1, 4, 0, false, "color(\"#rrggbb\") or color(r, g, b)"}},
    {"comp", {Operation::Component, 1, 1, kFirst, true, "comp(f) { front : Front | side : Wall | top : Roof }"}},
    {"extrude", {Operation::Extrude, 1, 2, kFirst, false, "extrude(height) or extrude(world.up, height)"}},
    {"i", {Operation::Insert, 1, 2, 2, false, "i(\"folder/name.glb\")"}},
    {"NIL", {Operation::Nil, 0, 0, 0, false, "NIL"}},
    {"primitiveCube", {Operation::PrimitiveCube, 0, 3, 0, false, "primitiveCube()"}},
    {"primitiveQuad", {Operation::PrimitiveQuad, 0, 2, 0, false, "primitiveQuad()"}},
    {"report", {Operation::Report, 2, 2, 0, false, "report(\"key\", value)"}},
    {"s", {Operation::Resize, 3, 3, 0, false, "s(x, y, z)"}},
    {"r", {Operation::Rotate, 3, 4, kFirst, false, "r(x, y, z) or r(scopeCenter, x, y, z)"}},
    {"set", {Operation::Set, 2, 2, kFirst, false, "set(material.name, \"limestone\")"}},
    {"split", {Operation::Split, 1, 2, 3, true, "split(x) { 1 : A | ~2 : B }"}},
    {"t", {Operation::Translate, 3, 3, 0, false, "t(x, y, z)"}},
    {"copyUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"deleteUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"label", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"normalizeUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"print", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"projectUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"rotateUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"scaleUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"setupProjection", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"texture", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"tileUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
    {"translateUV", {Operation::Ignored, 0, kMany, kAnyWord, false, ""}},
};

constexpr std::string_view kFlatRoof =
    "pitched roofs are not supported: keep the flat top of extrude, comp(f) { top : Roof }";
constexpr std::string_view kShapes = "use extrude, split, primitiveCube() or i(\"part.glb\")";
constexpr std::string_view kScopeOnly = "use alignScopeToAxes(y), s, t, r or center";
constexpr std::string_view kNoOffset = "polygon offsets are not supported: cut strips with split(x) and split(z)";
constexpr std::string_view kNoMesh = "there is no mesh algebra: build the shape with extrude, split and comp(f)";

constexpr Entry<std::string_view> kRefusedOperations[] = {
    {"alignScopeToGeometry", kScopeOnly},
    {"alignScopeToGeometryBBox", kScopeOnly},
    {"mirror", kScopeOnly},
    {"mirrorScope", kScopeOnly},
    {"rotate", kScopeOnly},
    {"rotateScope", kScopeOnly},
    {"setPivot", kScopeOnly},
    {"translate", "use t(x, y, z)"},
    {"roofGable", kFlatRoof},
    {"roofHip", kFlatRoof},
    {"roofPyramid", kFlatRoof},
    {"roofRidge", kFlatRoof},
    {"roofShed", kFlatRoof},
    {"envelope", kShapes},
    {"taper", kShapes},
    {"primitiveCone", kShapes},
    {"primitiveCylinder", kShapes},
    {"primitiveDisk", kShapes},
    {"primitiveSphere", kShapes},
    {"scatter", kShapes},
    {"setback", kNoOffset},
    {"shapeL", kNoOffset},
    {"shapeO", kNoOffset},
    {"shapeU", kNoOffset},
    {"offset", kNoOffset},
    {"setbackPerEdge", kNoOffset},
    {"setbackToArea", kNoOffset},
    {"splitArea", "use split(x) with sizes"},
    {"splitAndSetbackPerimeter", kNoOffset},
    {"inline", kNoMesh},
    {"intersect", kNoMesh},
    {"modify", kNoMesh},
    {"subtract", kNoMesh},
    {"union", kNoMesh},
    {"trim", kNoMesh},
    {"insertAlongUV", kNoMesh},
    {"cleanupGeometry", kNoMesh},
    {"convexify", kNoMesh},
    {"deleteHoles", kNoMesh},
    {"footprint", kNoMesh},
    {"innerRect", kNoMesh},
    {"innerRectangle", kNoMesh},
    {"rectify", kNoMesh},
    {"reduceGeometry", kNoMesh},
    {"resetGeometry", kNoMesh},
    {"reverseNormals", kNoMesh},
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
    {"len", {Function::Len, 1, 1, false}},
    {"ln", {Function::Ln, 1, 1, false}},
    {"log10", {Function::Log10, 1, 1, false}},
    {"max", {Function::Max, 2, kMany, false}},
    {"min", {Function::Min, 2, kMany, false}},
    {"p", {Function::P, 1, 1, false}},
    {"pow", {Function::Pow, 2, 2, false}},
    {"rand", {Function::Rand, 0, 2, false}},
    {"rgb", {Function::Rgb, 3, 3, false}},
    {"rint", {Function::Rint, 1, 1, false}},
    {"sin", {Function::Sin, 1, 1, false}},
    {"sqrt", {Function::Sqrt, 1, 1, false}},
    {"str", {Function::Str, 1, 1, false}},
    {"substring", {Function::Substring, 3, 3, false}},
    {"tan", {Function::Tan, 1, 1, false}},
    {"touches", {Function::Touches, 0, 2, true}},
    {"geometry.area", {Function::GeometryArea, 0, 1, true}},
    {"geometry.height", {Function::GeometryHeight, 0, 0, false}},
    {"geometry.isConcave", {Function::GeometryIsConcave, 0, 0, false}},
    {"geometry.isPlanar", {Function::GeometryIsPlanar, 0, 0, false}},
    {"geometry.isRectangular", {Function::GeometryIsRectangular, 0, 1, false}},
    {"geometry.nEdges", {Function::GeometryNEdges, 0, 0, false}},
    {"geometry.nFaces", {Function::GeometryNFaces, 0, 0, false}},
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
    {"overlaps", "use touches(inter), which knows the walls that neighbours cover"},
    {"contextCount", "use touches(inter), which knows the walls that neighbours cover"},
    {"minimumDistance", "use touches(inter), which knows the walls that neighbours cover"},
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
    {"material.color.r", ShapeAttribute::ColorR},
    {"material.color.g", ShapeAttribute::ColorG},
    {"material.color.b", ShapeAttribute::ColorB},
    {"material.color.rgb", ShapeAttribute::ColorRgb},
    {"material.name", ShapeAttribute::MaterialName},
    {"material.emissive.r", ShapeAttribute::EmissiveR},
    {"material.emissive.g", ShapeAttribute::EmissiveG},
    {"material.emissive.b", ShapeAttribute::EmissiveB},
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
