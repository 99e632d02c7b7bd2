// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
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
    std::vector<Body> body; ///< Push: one
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

struct Rule
{
    u32 name = 0; ///< into Program::names
    Place place;
    std::vector<std::string> parameters;
    Body body;
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
};

/// A rule file after parsing: every name is resolved, so deriving looks nothing up by text.
struct Program
{
    std::string fileName;
    std::vector<std::string> names;
    std::vector<Rule> rules;
    std::vector<Global> globals;
    std::map<std::pair<std::string, u32>, u32> ruleIndex, globalIndex; ///< (name, number of parameters) -> index
    u32 startRule = kNoIndex;
    std::vector<std::string> warnings; ///< of parsing: what is read but has no effect
};

} // namespace helio::cga
