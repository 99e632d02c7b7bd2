// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string_view>

#include "city/base/types.h"

namespace helio::cga {

/// The operations that are carried out.
enum class Operation : u8
{
    AlignScopeToAxes,
    AlignScopeToGeometry,
    AlignScopeToGeometryBBox,
    Center,
    CleanupGeometry,
    Color,
    Component,
    DeleteHoles,
    Extrude,
    InnerRect,
    InnerRectangle,
    Insert,
    Mirror,
    MirrorScope,
    Nil,
    Offset,
    PrimitiveCone,
    PrimitiveCube,
    PrimitiveCylinder,
    PrimitiveDisk,
    PrimitiveQuad,
    PrimitiveSphere,
    Print,
    Report,
    Resize,
    RoofGable,
    RoofHip,
    RoofPyramid,
    RoofShed,
    ReverseNormals,
    Rotate,
    RotateIn, ///< rotate(mode, system, x, y, z)
    RotateScope,
    Scatter,
    Set,
    Setback,
    SetbackPerEdge,
    SetPivot,
    ShapeL,
    ShapeO,
    ShapeU,
    Split,
    Taper,
    Translate,
    Trim,
    TranslateIn, ///< translate(mode, system, x, y, z)
    Ignored ///< texture calls and the like: parsed, without effect
};

struct OperationInfo
{
    Operation op;
    u32 minArgs, maxArgs;
    u32 keywordArgs; ///< bit k: argument k may be a bare word
    bool hasBlock; ///< a block of selectors or sizes; scatter has a body
    std::string_view usage; ///< for messages
};

/// The operation of a name, if it is carried out or ignored.
std::optional<OperationInfo> findOperation(std::string_view name);
/// What to use instead of an operation that CGA knows and we do not; empty if CGA does not know the name either.
std::string_view refusedOperation(std::string_view name);

/// The built-in functions.
enum class Function : u8
{
    Abs,
    Acos,
    Asin,
    Atan,
    Atan2,
    Bool,
    Ceil,
    Clamp,
    Cos,
    Count,
    Exp,
    Find,
    Float,
    Floor,
    Inside,
    Int,
    IsInf,
    IsNan,
    Len,
    Ln,
    Log10,
    Max,
    Min,
    Overlaps,
    P,
    Pow,
    Rand,
    Replace,
    Rgb,
    Rint,
    Sin,
    Sqrt,
    Str,
    Substring,
    Tan,
    Touches,
    GeometryArea, ///< the first of the geometry functions
    GeometryBoundaryLength,
    GeometryHeight,
    GeometryIsClosedSurface,
    GeometryIsConcave,
    GeometryIsOriented,
    GeometryIsPlanar,
    GeometryIsRectangular,
    GeometryNEdges,
    GeometryNFaces,
    GeometryNHoles,
    GeometryNVertices,
    GeometryVolume
};

struct FunctionInfo
{
    Function function;
    u32 minArgs, maxArgs;
    bool keywords; ///< arguments may be bare words
};

std::optional<FunctionInfo> findFunction(std::string_view name);
std::string_view refusedFunction(std::string_view name);

/// Readable properties of the current shape.
enum class ShapeAttribute : u8
{
    ScopeSx,
    ScopeSy,
    ScopeSz,
    ScopeTx,
    ScopeTy,
    ScopeTz,
    ScopeRx,
    ScopeRy,
    ScopeRz,
    ScopeElevation,
    SplitIndex,
    SplitTotal,
    CompIndex,
    CompTotal,
    CompSel,
    Seedian,
    InitialShapeName,
    InitialShapeOriginPx,
    InitialShapeOriginPy,
    InitialShapeOriginPz,
    InitialShapeOriginOx,
    InitialShapeOriginOy,
    InitialShapeOriginOz,
    ColorR,
    ColorG,
    ColorB,
    ColorRgb,
    MaterialName,
    EmissiveR,
    EmissiveG,
    EmissiveB,
    Opacity,
    TrimVertical,
    TrimHorizontal
};

std::optional<ShapeAttribute> findShapeAttribute(std::string_view name);

/// What selects components in comp and setback. Quadrants and slopes are those of the scope; see component.h.
enum class Selector : u8
{
    Front,
    Right,
    Back,
    Left,
    Top,
    Bottom,
    Side,
    Vertical,
    Horizontal,
    Aslant,
    Nutant,
    All,
    ObjectFront,
    ObjectRight,
    ObjectBack,
    ObjectLeft,
    ObjectTop,
    ObjectBottom,
    ObjectSide,
    WorldSouth,
    WorldEast,
    WorldNorth,
    WorldWest,
    WorldUp,
    WorldDown,
    WorldSide,
    StreetFront,
    StreetRight,
    StreetBack,
    StreetLeft,
    StreetSide,
    Border,    ///< at the rim of an open geometry
    Inside,    ///< not at the rim
    Ridge,     ///< edges of roofs: see RoofEdge in mesh_edges.h
    Hip,
    Valley,
    Eave,
    Shape,     ///< shapeL, shapeU, shapeO, innerRectangle: what they are about
    Remainder, ///< setback and the like: what is left over
    Index
};

std::optional<Selector> findSelector(std::string_view name);

} // namespace helio::cga
