// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/words.h"

#include <algorithm>
#include <array>
#include <span>
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

/// Index of a word in a list, if it is there.
std::optional<u32> indexIn(std::span<const std::string_view> words, std::string_view word)
{
    const auto found = std::find(words.begin(), words.end(), word);
    if (found == words.end()) return {};
    return u32(found - words.begin());
}

/// `x`, `world.y`, `object.xyz`: all three axes are 0, one of them 1 to 3; plus kObjectAxes.
bool takeAxes(Statement& statement)
{
    std::string_view name;
    const std::string word = takeWord(statement);
    name = word;
    if (name.rfind("object.", 0) == 0) {
        statement.mode = kObjectAxes;
        name.remove_prefix(7);
    } else if (name.rfind("world.", 0) == 0) {
        name.remove_prefix(6);
    }
    static constexpr std::string_view kAxes[] = {"xyz", "x", "y", "z"};
    const auto axes = indexIn(kAxes, name);
    statement.mode |= axes.value_or(0);
    return axes.has_value();
}

/// `rel, world`: a CoordinateSystem, plus kAbsolute.
bool takeSystem(Statement& statement)
{
    static constexpr std::string_view kModes[] = {"rel", "abs"}, kSystems[] = {"scope", "pivot", "object", "world"};
    const auto mode = indexIn(kModes, takeWord(statement)), system = indexIn(kSystems, takeWord(statement));
    if (!mode || !system) return false;
    statement.mode = *system + *mode * kAbsolute;
    return true;
}

/// `zUp, any, longest`; numbers stay in the arguments.
bool takeAlignment(Statement& statement)
{
    static constexpr std::string_view kUps[] = {"yUp", "zUp"}, kFaces[] = {"", "world.lowest", "largest", "any"},
                                      kEdges[] = {"", "world.lowest", "longest"};
    const auto up = indexIn(kUps, takeWord(statement)), face = indexIn(kFaces, takeWord(statement));
    if (!up || !face) return false;
    const auto edge = indexIn(kEdges, takeWord(statement, *face == u32(FacePick::Number) ? 1 : 0));
    if (!edge || (*face == u32(FacePick::Any) && *edge == u32(EdgePick::Number))) return false;
    statement.mode = *up + *face * 2 + *edge * 8;
    return true;
}

/// `zUp, keepSizeAndPosition, noCleanup` after the name of an asset.
bool takeInsertMode(Statement& statement)
{
    if (statement.args.size() < 2) return true;
    static constexpr std::string_view kUps[] = {"yUp", "zUp"},
                                      kFits[] = {"alignSizeAndPosition", "keepSizeAndPosition",
                                                 "keepSizeAlignPosition"},
                                      kCleanups[] = {"numericalCleanup", "noCleanup"};
    const auto up = indexIn(kUps, takeWord(statement, 1));
    if (!up) return false;
    statement.mode = *up * kWholeScope;
    if (statement.args.size() < 2) return true;
    const auto fit = indexIn(kFits, takeWord(statement, 1));
    if (!fit) return false;
    statement.mode |= *fit * 2;
    // Assets are taken as they are: how they would be cleaned makes no difference.
    return statement.args.size() < 2 || indexIn(kCleanups, takeWord(statement, 1)).has_value();
}

/// `byAngle` or `byHeight` in front of a roof's arguments. Any other name is a value.
bool takeRoofKind(Statement& statement)
{
    static constexpr std::string_view kKinds[] = {"byAngle", "byHeight"};
    const auto kind = indexIn(kKinds, statement.args[0].value.text);
    if (!kind || statement.args[0].value.kind != ExprKind::Keyword) return true;
    takeWord(statement);
    statement.mode = *kind * kByHeight;
    return !statement.args.empty();
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
    static constexpr std::array<std::pair<std::string_view, SetTarget>, 12> kTargets = {
        {{"material.color.r", SetTarget::ColorR},
         {"material.color.g", SetTarget::ColorG},
         {"material.color.b", SetTarget::ColorB},
         {"material.color.rgb", SetTarget::ColorRgb},
         {"material.name", SetTarget::Name},
         {"material.emissive.r", SetTarget::EmissiveR},
         {"material.emissive.g", SetTarget::EmissiveG},
         {"material.emissive.b", SetTarget::EmissiveB},
         {"material.opacity", SetTarget::Opacity},
         {"trim.vertical", SetTarget::TrimVertical},
         {"trim.horizontal", SetTarget::TrimHorizontal},
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

/// `surface, n, gaussian, left, 2`; the numbers stay in the arguments.
bool takeScatter(Statement& statement)
{
    static constexpr std::string_view kDomains[] = {"surface", "volume", "scope"}, kKinds[] = {"uniform", "gaussian"},
                                      kMeans[] = {"center", "front", "back", "left", "right", "top", "bottom"};
    const auto domain = indexIn(kDomains, takeWord(statement)), kind = indexIn(kKinds, takeWord(statement, 1));
    if (!domain || !kind) return false;
    statement.mode = *domain + *kind * kGaussian;
    if (statement.args.size() < 2) return true;
    const auto mean = indexIn(kMeans, takeWord(statement, 1));
    statement.mode += mean.value_or(0) * kFirstMean;
    return mean && *kind == 1;
}

/// Turns the bare words of an operation into Statement::mode; false if a word is unknown.
bool takeWords(Statement& statement, const Program& program, std::string& ignored)
{
    switch (statement.op) {
    case Operation::Component: {
        static constexpr std::string_view kKinds[] = {"f", "e", "fe", "v"};
        const auto kind = indexIn(kKinds, takeWord(statement));
        statement.mode = kind.value_or(0);
        return kind.has_value();
    }
    case Operation::InnerRectangle: {
        static constexpr std::string_view kAlignments[] = {"scope", "edge"};
        const auto alignment = indexIn(kAlignments, takeWord(statement));
        statement.mode = alignment.value_or(0) * kAlongEdge;
        return alignment.has_value();
    }
    case Operation::Offset: {
        if (statement.args.size() < 2) return true;
        static constexpr std::string_view kKeeps[] = {"all", "inside", "border"};
        const auto keep = indexIn(kKeeps, takeWord(statement, 1));
        statement.mode = keep.value_or(0);
        return keep.has_value();
    }
    case Operation::RoofGable:
    case Operation::RoofHip:
    case Operation::RoofPyramid:
    case Operation::RoofShed:
        return takeRoofKind(statement);
    case Operation::AlignScopeToAxes:
        return statement.args.empty() || takeAxes(statement);
    case Operation::AlignScopeToGeometry:
        return takeAlignment(statement);
    case Operation::AlignScopeToGeometryBBox: {
        static constexpr std::string_view kPlanes[] = {"xy", "yx", "xz", "zx", "yz", "zy"};
        const auto plane = indexIn(kPlanes, takeWord(statement));
        statement.mode = plane.value_or(0);
        return plane.has_value();
    }
    case Operation::CleanupGeometry: {
        static constexpr std::string_view kComponents[] = {"vertices", "edges", "faces", "all"};
        static constexpr u32 kBits[] = {kCleanVertices, kCleanVertices | kCleanEdges, kCleanVertices | kCleanFaces,
                                        kCleanVertices | kCleanEdges | kCleanFaces};
        const auto components = indexIn(kComponents, takeWord(statement));
        statement.mode = kBits[components.value_or(0)];
        return components.has_value();
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
    case Operation::Insert:
        return takeInsertMode(statement);
    case Operation::Rotate: {
        if (statement.args.size() == 3) return true;
        const std::string word = takeWord(statement);
        statement.mode = word == "scopeCenter" ? kWholeScope : 0;
        return word == "scopeCenter" || word == "scopeOrigin";
    }
    case Operation::RotateIn:
    case Operation::TranslateIn:
        return takeSystem(statement);
    case Operation::SetPivot: {
        static constexpr std::string_view kMaps[] = {"xyz", "yzx", "zxy"};
        const auto map = indexIn(kMaps, takeWord(statement));
        statement.mode = map.value_or(0);
        return map.has_value();
    }
    case Operation::Split: {
        const std::string axis = takeWord(statement);
        if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z') return false;
        statement.mode = u32(axis[0] - 'x');
        if (statement.args.empty()) return true;
        statement.mode |= kNoAdjust;
        return takeWord(statement) == "noAdjust";
    }
    case Operation::Scatter:
        return takeScatter(statement);
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

/// A bare word that other programs know, and what to write here.
struct RefusedWord
{
    Operation op;
    std::string_view word, advice;
};

constexpr std::string_view kNoGroups = "faces have no groups, materials or holes of their own: use comp(f) and select "
                                       "faces by where they look";
constexpr std::string_view kNoTexture = "there are no texture coordinates: use split(x), split(y) or split(z)";
constexpr RefusedWord kRefusedWords[] = {
    {Operation::Component, "g", kNoGroups}, {Operation::Component, "m", kNoGroups},
    {Operation::Component, "h", kNoGroups}, {Operation::Split, "u", kNoTexture},
    {Operation::Split, "v", kNoTexture},    {Operation::Split, "uv", kNoTexture},
};

/// The bare words of `before` that are no longer among the statement's arguments.
std::vector<std::string> takenWords(const std::vector<Size>& before, const Statement& statement)
{
    std::vector<std::string> words;
    size_t next = 0; // of the arguments that are left, which keep their order
    for (const Size& arg : before) {
        const auto at = [](const Expr& expr) { return std::pair(expr.place.line, expr.place.column); };
        if (next < statement.args.size() && at(statement.args[next].value) == at(arg.value))
            ++next;
        else
            words.push_back(arg.value.text);
    }
    return words;
}

/// Why takeWords failed, after it took these words.
std::string wordsError(const Statement& statement, const Program& program, const std::vector<std::string>& words)
{
    const std::string& name = program.names[statement.name];
    const std::string_view usage = findOperation(name)->usage;
    if (words.empty()) return concat("a bare word is missing in '", name, "': write ", usage);
    for (const auto& [op, word, advice] : kRefusedWords)
        if (op == statement.op && word == words[0]) return concat(name, "(", word, ") is not supported: ", advice);
    if (statement.op == Operation::Set) {
        const bool declared = program.globalIndex.count({words[0], 0}) > 0;
        return declared ? concat("set(..) changes attributes, and '", words[0], "' is a constant: declare it with attr")
                        : concat("set(..) does not know '", words[0], "': declare attr ", words[0], " = .., or write ",
                                 usage);
    }
    std::string list;
    for (const std::string& word : words) list += concat(list.empty() ? "'" : ", '", word, "'");
    return concat("'", name, "' does not know the bare word", words.size() > 1 ? "s " : " ", list, ": write ", usage);
}

/// Why takeSelector failed.
std::string selectorError(const Expr& selector)
{
    if (selector.kind == ExprKind::Text)
        return concat("a selector is a bare word: write ", selector.text, " without quotes");
    if (selector.kind != ExprKind::Keyword && selector.kind != ExprKind::Number)
        return "boolean expressions of selectors are not supported: use one selector after another; a face goes to the "
               "first that it fits";
    const std::string_view call = selector.args.empty() ? "" : "(..)";
    return concat("unknown selector '", selector.kind == ExprKind::Number ? concat(selector.number) : selector.text,
                  call,
                  "': use front, back, left, right, top, bottom, side, vertical, horizontal, aslant, nutant, all, "
                  "border, inside, a number, or object., world., street. forms; ridge, hip, valley, eave for edges; "
                  "shape, remainder for what is cut off");
}

} // namespace

WordsResult resolveWords(Statement& statement, const Program& program)
{
    WordsResult result;
    result.place = statement.place;
    const std::vector<Size> before = statement.args;
    if (!takeWords(statement, program, result.ignored)) {
        result.error = wordsError(statement, program, takenWords(before, statement));
        return result;
    }
    if (!statement.block || statement.op == Operation::Split) return result;
    for (BlockElement& element : statement.block->elements)
        if (!element.nested && !takeSelector(element)) {
            result.place = element.place;
            result.error = selectorError(element.size.value);
            return result;
        }
    return result;
}

} // namespace helio::cga
