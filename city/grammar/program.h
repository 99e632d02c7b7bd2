// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "city/grammar/lexer.h"
#include "city/grammar/vocabulary.h"

namespace helio::cga {

/// What an expression node is. Children are in Expr::args.
enum class ExprKind : u8
{
    Number,
    Text,
    Bool,
    Keyword,   ///< a bare word that the called operation or function understands (`y`, `world.up`, `inter`)
    Parameter, ///< index = position in the parameter list
    Global,    ///< index into Program::globals: attr, const or function; args = arguments
    Builtin,   ///< index = Function; args = arguments
    Shape,     ///< index = ShapeAttribute
    Negate,
    Not,
    Binary, ///< index = BinaryOp
    Cases,  ///< condition, value, condition, value, ..., else value
    Percent ///< percentage, value, percentage, value, ..., else value
};

enum class BinaryOp : u8
{
    Or,
    And,
    Equal,
    NotEqual,
    Less,
    Greater,
    LessEqual,
    GreaterEqual,
    Add,
    Subtract,
    Multiply,
    Divide,
    Modulo
};

struct Expr
{
    ExprKind kind = ExprKind::Number;
    u32 index = 0;
    u32 depth = 1; ///< of the tree below, at most kMaxNesting
    Place place;
    double number = 0.0;
    std::string text; ///< string value, or the name as written
    std::vector<Expr> args;
};

enum class SizeKind : u8
{
    Absolute, ///< metres
    Relative, ///< ' : times the scope's size
    Floating  ///< ~ : takes its share of the rest
};

/// An argument of an operation, or the size of a split part.
struct Size
{
    SizeKind kind = SizeKind::Absolute;
    Expr value;
};

struct Statement;
struct Block;

/// What a rule, a part or a push does: statements, or a choice between bodies.
struct Body
{
    enum class Kind : u8
    {
        Plain,
        Cases,
        Percent
    };
    Kind kind = Kind::Plain;
    Place place;
    std::vector<Statement> statements; ///< Plain
    std::vector<Expr> conditions;      ///< Cases: conditions; Percent: percentages. One less than bodies
    std::vector<Body> bodies;          ///< the last one is `else`
};

/// Statement::mode of each operation that takes a bare word.
inline constexpr u32 kNoAdjust = 4;   ///< split: axis 0..2, plus this
inline constexpr u32 kWholeScope = 1; ///< r: about the scope's centre; i: the asset is z up
/// i: how the asset is placed, added to kWholeScope.
inline constexpr u32 kKeepSizeAndPosition = 2, kKeepSizeAlignPosition = 4;
/// translate, rotate: a CoordinateSystem, plus this for absolute values.
inline constexpr u32 kAbsolute = 4;
enum class CoordinateSystem : u32
{
    Scope,
    Pivot,
    Object,
    World
};
/// alignScopeToAxes: 0 = all three of the world, 1..3 = one of them; plus this for those of the object.
inline constexpr u32 kObjectAxes = 4;
/// alignScopeToGeometry: kZUp + FacePick * 2 + EdgePick * 8.
inline constexpr u32 kZUp = 1;
enum class FacePick : u32
{
    Number,
    Lowest,
    Largest,
    Any
};
enum class EdgePick : u32
{
    Number,
    Lowest,
    Longest
};
/// cleanupGeometry: what is merged and removed, as bits.
inline constexpr u32 kCleanVertices = 1, kCleanEdges = 2, kCleanFaces = 4;
/// comp: what the shape is taken apart into.
enum class ComponentKind : u32
{
    Faces,
    Edges,     ///< an edge of two faces counts once
    FaceEdges, ///< it counts for each of them
    Vertices
};
/// offset: what is kept.
enum class OffsetKeep : u32
{
    All,
    Inside,
    Border
};
/// scatter: a ScatterDomain in the lowest bits, plus kGaussian, plus kFirstMean times a ScatterMean.
inline constexpr u32 kScatterDomain = 3, kGaussian = 4, kFirstMean = 8;
enum class ScatterMean : u32
{
    Center,
    Front,
    Back,
    Left,
    Right,
    Top,
    Bottom
};
inline constexpr u32 kByHeight = 1;  ///< roofs: the value is a height, not an angle
inline constexpr u32 kAlongEdge = 1; ///< innerRectangle: along any long edge, not only along the scope's axes
enum class ExtrudeMode : u32
{
    FaceNormal,
    WorldUp,
    WorldUpFlatTop
};
enum class SetTarget : u32
{
    ColorR,
    ColorG,
    ColorB,
    ColorRgb,
    Name,
    EmissiveR,
    EmissiveG,
    EmissiveB,
    Opacity,
    TrimVertical,
    TrimHorizontal,
    Seedian,
    Ignored,
    FirstGlobal
};

enum class StatementKind : u8
{
    Operation,
    Rule,
    Push
};

struct Statement
{
    StatementKind kind = StatementKind::Operation;
    Operation op{};
    u32 rule = kNoIndex; ///< into Program::rules; kNoIndex: a terminal
    u32 name = 0;        ///< into Program::names: the rule or terminal
    Place place;
    std::vector<Size> args; ///< without the bare words, which are in `mode`
    u32 mode = 0;           ///< what the bare word says: an axis, ExtrudeMode, SetTarget, ...
    std::vector<Body> body; ///< Push, scatter: one
    std::shared_ptr<Block> block;
};

/// `selector : body` of comp, `size : body` of split, or a nested block of split.
struct BlockElement
{
    Place place;
    Size size;             ///< split
    Selector selector{};   ///< comp
    u32 selectorIndex = 0; ///< comp, for Selector::Index
    bool combine = false;  ///< `=`: all selected faces make one shape
    Body body;
    std::shared_ptr<Block> nested;
};

struct Block
{
    std::vector<BlockElement> elements;
    bool repeat = false;
};

/// What stands in front of a declaration: `@Range(min=3, max=14)`. For user interfaces; only @StartRule has a meaning
/// here.
struct Annotation
{
    struct Argument
    {
        std::string key;              ///< empty without `key =`
        std::string text;             ///< as written; the unescaped value of a string
        std::optional<double> number; ///< its value, if it is one
    };
    std::string name; ///< without the @
    std::vector<Argument> arguments;
};

struct Rule
{
    u32 name = 0; ///< into Program::names
    Place place;
    std::vector<std::string> parameters;
    /// The locals of `with (x := ..)`. They are evaluated once on entry, in this order, on the shape that enters, and
    /// appended to the values of the parameters: local k is ExprKind::Parameter with index parameters.size() + k, and
    /// may use the locals before it.
    std::vector<Expr> locals;
    Body body;
    std::vector<std::string> localNames;
    u32 scope = 0; ///< into Program::scopes
    std::vector<Annotation> annotations;
};

enum class GlobalKind : u8
{
    Attribute,
    Constant,
    Function
};

struct Global
{
    GlobalKind kind = GlobalKind::Function;
    std::string name;
    Place place;
    std::vector<std::string> parameters;
    Expr value;
    std::vector<Expr> locals; ///< of `with`, as Rule::locals
    std::vector<std::string> localNames;
    u32 scope = 0;        ///< into Program::scopes: where the names in `value` are looked up
    std::string property; ///< the name without its import's id: what the properties of footprints are called
    std::string source;   ///< the value as written
    std::vector<Annotation> annotations;
};

/// A text that was read for a program: the rule file itself, or one that it imports.
struct SourceFile
{
    std::string name; ///< as errors print it; for an import: relative to the folder of the importing file
    std::string text;
};

/// An import that was carried out.
struct Import
{
    u32 scope = 0, file = 0; ///< into Program::scopes and Program::files
    u32 importer = 0;        ///< the scope of the importing file
    std::string style;
};

/// A rule file after parsing: every name is resolved, so deriving looks nothing up by text.
struct Program
{
    std::string fileName;            ///< files[0].name
    std::vector<SourceFile> files;   ///< Place::file is an index into it
    std::vector<std::string> scopes; ///< "" of the rule file itself, `id.` of an import, `id.id.` of an import's import
    std::vector<std::string> names;
    std::vector<Rule> rules;
    std::vector<Global> globals;
    std::map<std::pair<std::string, u32>, u32> ruleIndex, globalIndex; ///< (name, number of parameters) -> index
    u32 startRule = kNoIndex;
    std::vector<Import> imports;
    std::vector<std::string> styles;   ///< of the rule file itself, Default first
    std::string style = "Default";     ///< the one that is in force
    std::vector<std::string> warnings; ///< of parsing: what is read but has no effect
};

} // namespace helio::cga
