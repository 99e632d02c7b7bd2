// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/words.h"

#include <array>
#include <utility>

namespace helio::cga {

namespace {

/// Takes the bare word at this place of the arguments, if there is one.
std::string takeWord(Statement& statement, size_t at = 0)
{
    if (at >= statement.args.size()) return "";
    const Expr& value = statement.args[at].value;
    if (value.kind != ExprKind::Keyword || !value.args.empty()) return "";
    const std::string word = value.text;
    statement.args.erase(statement.args.begin() + std::ptrdiff_t(at));
    return word;
}

bool takeExtrudeMode(Statement& statement)
{
    if (statement.args.size() == 1) return true;
    const std::string word = takeWord(statement);
    static constexpr std::array<std::pair<std::string_view, ExtrudeMode>, 4> kModes = {
        {{"face.normal", ExtrudeMode::FaceNormal},
         {"vertex.normal", ExtrudeMode::FaceNormal},
         {"world.up", ExtrudeMode::WorldUp},
         {"world.up.flatTop", ExtrudeMode::WorldUpFlatTop}}};
    for (const auto& [text, mode] : kModes)
        if (word == text) return statement.mode = u32(mode), true;
    return false;
}

bool takeSetTarget(Statement& statement, const Program& program, std::string& ignored)
{
    const std::string word = takeWord(statement);
    static constexpr std::array<std::pair<std::string_view, SetTarget>, 9> kTargets = {
        {{"material.color.r", SetTarget::ColorR},
         {"material.color.g", SetTarget::ColorG},
         {"material.color.b", SetTarget::ColorB},
         {"material.color.rgb", SetTarget::ColorRgb},
         {"material.name", SetTarget::Name},
         {"material.emissive.r", SetTarget::EmissiveR},
         {"material.emissive.g", SetTarget::EmissiveG},
         {"material.emissive.b", SetTarget::EmissiveB},
         {"seedian", SetTarget::Seedian}}};
    for (const auto& [text, target] : kTargets)
        if (word == text) return statement.mode = u32(target), true;
    if (const auto global = program.globalIndex.find({word, 0}); global != program.globalIndex.end()) {
        if (program.globals[global->second].kind != GlobalKind::Attribute) return false;
        statement.mode = u32(SetTarget::FirstGlobal) + global->second;
        return true;
    }
    if (word.rfind("material.", 0) != 0 && word.rfind("trim.", 0) != 0) return false;
    statement.mode = u32(SetTarget::Ignored);
    ignored = concat("set(", word, ", ..)");
    return true;
}

/// Turns the bare words of an operation into Statement::mode; false if a word is unknown.
bool takeWords(Statement& statement, const Program& program, std::string& ignored)
{
    switch (statement.op) {
    case Operation::Component:
        return takeWord(statement) == "f";
    case Operation::AlignScopeToAxes: {
        if (statement.args.empty()) return true;
        statement.mode = 1;
        return takeWord(statement) == "y";
    }
    case Operation::Center: {
        const std::string axes = takeWord(statement);
        for (const char axis : axes) {
            if (axis < 'x' || axis > 'z') return false;
            statement.mode |= 1u << (axis - 'x');
        }
        return !axes.empty();
    }
    case Operation::Extrude:
        return takeExtrudeMode(statement);
    case Operation::Insert: {
        if (statement.args.size() == 1) return true;
        const std::string word = takeWord(statement, 1);
        statement.mode = word == "zUp" ? kWholeScope : 0;
        return word == "zUp" || word == "yUp";
    }
    case Operation::Rotate: {
        if (statement.args.size() == 3) return true;
        const std::string word = takeWord(statement);
        statement.mode = word == "scopeCenter" ? kWholeScope : 0;
        return word == "scopeCenter" || word == "scopeOrigin";
    }
    case Operation::Split: {
        const std::string axis = takeWord(statement);
        if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z') return false;
        statement.mode = u32(axis[0] - 'x');
        if (statement.args.empty()) return true;
        statement.mode |= kNoAdjust;
        return takeWord(statement) == "noAdjust";
    }
    case Operation::Set:
        return takeSetTarget(statement, program, ignored);
    default:
        return true;
    }
}

/// The selector of a block's element; false if it is unknown.
bool takeSelector(BlockElement& element)
{
    const Expr& word = element.size.value;
    if (word.kind == ExprKind::Number && word.number >= 0.0 && word.number < 1e6) {
        element.selector = Selector::Index;
        element.selectorIndex = u32(word.number);
        return true;
    }
    const auto selector = findSelector(word.text);
    if (word.kind != ExprKind::Keyword || !word.args.empty() || !selector) return false;
    element.selector = *selector;
    return true;
}

} // namespace

WordsResult resolveWords(Statement& statement, const Program& program)
{
    WordsResult result;
    result.place = statement.place;
    const std::string& name = program.names[statement.name];
    if (!takeWords(statement, program, result.ignored)) {
        result.error = concat("'", name, "' does not know this bare word: write ", findOperation(name)->usage);
        return result;
    }
    if (!statement.block || statement.op == Operation::Split) return result;
    for (BlockElement& element : statement.block->elements)
        if (!element.nested && !takeSelector(element)) {
            result.place = element.place;
            result.error = concat("unknown selector '", element.size.value.text,
                                  "': use front, back, left, right, top, bottom, side, vertical, horizontal, aslant, "
                                  "nutant, all, a number, or object., world., street. forms");
            return result;
        }
    return result;
}

} // namespace helio::cga
