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
    Center,
    Color,
    Component,
    Extrude,
    Insert,
    Nil,
    PrimitiveCube,
    PrimitiveQuad,
    Report,
    Resize,
    Rotate,
    Set,
    Split,
    Translate,
    Ignored ///< texture calls and the like: parsed, without effect
};

struct OperationInfo
{
    Operation op;
    u32 minArgs, maxArgs;
    u32 keywordArgs; ///< bit k: argument k may be a bare word
    bool hasBlock;
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
    Len,
    Ln,
    Log10,
    Max,
    Min,
    P,
    Pow,
    Rand,
    Rgb,
    Rint,
    Sin,
    Sqrt,
    Str,
    Substring,
    Tan,
    Touches,
    GeometryArea,
    GeometryHeight,
    GeometryIsConcave,
    GeometryIsPlanar,
    GeometryIsRectangular,
    GeometryNEdges,
    GeometryNFaces,
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
    ColorR,
    ColorG,
    ColorB,
    ColorRgb,
    MaterialName,
    EmissiveR,
    EmissiveG,
    EmissiveB
};

std::optional<ShapeAttribute> findShapeAttribute(std::string_view name);

/// What selects faces in comp(f). Quadrants and slopes are those of the scope; see classify() in component.h.
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
    Index
};

std::optional<Selector> findSelector(std::string_view name);

} // namespace helio::cga
