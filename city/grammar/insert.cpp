// SPDX-License-Identifier: Apache-2.0
// The operations of Interpreter that put something into the current scope: primitives and assets.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "city/grammar/interpreter.h"
#include "city/grammar/placement.h"
#include "city/grammar/primitives.h"
#include "city/grammar/trim.h"

namespace helio::cga {

namespace {

constexpr u32 kRoundSides = 16, kSphereRings = 12; ///< of round primitives, where the rules do not say

/// A level geometry (y = 0, in a scope of `size` with its depth along z) laid into the plane of a scope that is flat
/// along `normal`.
Geometry laidInto(Geometry geometry, int normal, const glm::dvec3& size)
{
    const auto place = [&](const glm::dvec3& p) {
        if (normal == 2) return glm::dvec3(p.x, size.y - p.z, 0.0);
        if (normal == 0) return glm::dvec3(0.0, size.y - p.z, size.z - p.x);
        return p;
    };
    for (Face& face : geometry.faces) {
        for (glm::dvec3& p : face.polygon.outer) p = place(p);
        for (Ring3& hole : face.polygon.holes)
            for (glm::dvec3& p : hole) p = place(p);
        face.xAxis = glm::normalize(face.polygon.outer[1] - face.polygon.outer[0]);
    }
    return geometry;
}

/// The primitive that a name such as `builtin:cube` or `builtin:cylinder16:notex` means.
std::optional<Operation> builtinPrimitive(std::string_view name)
{
    if (name.rfind("builtin:", 0) != 0) return {};
    name.remove_prefix(8);
    name = name.substr(0, name.find(':'));
    while (!name.empty() && name.back() >= '0' && name.back() <= '9') name.remove_suffix(1);
    static constexpr std::pair<std::string_view, Operation> kNames[] = {
        {"cone", Operation::PrimitiveCone},         {"cube", Operation::PrimitiveCube},
        {"cylinder", Operation::PrimitiveCylinder}, {"disk", Operation::PrimitiveDisk},
        {"quad", Operation::PrimitiveQuad},         {"sphere", Operation::PrimitiveSphere}};
    for (const auto& [text, op] : kNames)
        if (name == text) return op;
    return {};
}

/// How many numbers a primitive takes: none, those that give its corners, or those and its sizes.
struct PrimitiveArgs
{
    size_t counts, sizes;
};

PrimitiveArgs argsOf(Operation op)
{
    switch (op) {
    case Operation::PrimitiveCube:
        return {0, 3};
    case Operation::PrimitiveQuad:
        return {0, 2};
    case Operation::PrimitiveSphere:
        return {2, 1};
    case Operation::PrimitiveDisk:
        return {1, 1};
    default:
        return {1, 2};
    }
}

} // namespace

void Interpreter::primitive(const Statement& statement, ShapeState& state, Frame& frame)
{
    std::vector<double> numbers;
    for (const Size& arg : statement.args) numbers.push_back(evaluator_.number(arg.value, env(state, frame)));
    if (!trouble_.failed()) insertPrimitive(statement.op, numbers, statement.place, state);
}

/// Fills the scope with a primitive; with sizes, centres it on the scope's floor. Sizes of the scope that are 0 follow
/// the others as for assets.
void Interpreter::insertPrimitive(Operation op, std::span<const double> numbers, Place place, ShapeState& state)
{
    const auto [counts, sizes] = argsOf(op);
    if (!numbers.empty() && numbers.size() != counts && numbers.size() != counts + sizes)
        return trouble_.fail(place,
                             concat("this primitive takes no numbers, ", counts > 0 ? concat(counts, " or ") : "",
                                    counts + sizes, ", not ", numbers.size()));
    u32 sides[2] = {kRoundSides, kSphereRings};
    for (size_t k = 0; k < std::min(counts, numbers.size()); ++k) {
        const double least = k == 0 ? kMinSides : 2;
        if (!(numbers[k] >= least && numbers[k] <= kMaxSides))
            return trouble_.fail(place,
                                 concat("a primitive has ", least, " to ", kMaxSides, " sides, not ", numbers[k]));
        sides[k] = u32(std::floor(numbers[k]));
    }
    for (size_t k = counts; k < numbers.size(); ++k)
        if (!(numbers[k] > 0.0))
            return trouble_.fail(place, concat("a primitive needs sizes above 0, not ", numbers[k]));

    const bool flat = op == Operation::PrimitiveQuad || op == Operation::PrimitiveDisk;
    glm::dvec3 size = state.scope.size;
    const int zeros = int(size.x <= kFlat) + int(size.y <= kFlat) + int(size.z <= kFlat);
    const int normal = !flat || zeros != 1 ? 1 : size.x <= kFlat ? 0 : size.y <= kFlat ? 1 : 2;
    if (numbers.size() > counts) {
        const double a = numbers[counts], b = numbers.back();
        if (op == Operation::PrimitiveCube) size = {a, numbers[1], numbers[2]};
        if (op == Operation::PrimitiveSphere) size = glm::dvec3(2.0 * a);
        if (op == Operation::PrimitiveCone || op == Operation::PrimitiveCylinder) size = {2.0 * a, b, 2.0 * a};
        if (flat) {
            const double width = op == Operation::PrimitiveDisk ? 2.0 * a : a,
                         length = op == Operation::PrimitiveDisk ? 2.0 * a : b;
            size = normal == 0   ? glm::dvec3(0.0, width, length)
                   : normal == 1 ? glm::dvec3(width, 0.0, length)
                                 : glm::dvec3(width, length, 0.0);
        }
        glm::dvec3 offset = 0.5 * (state.scope.size - size);
        if (normal == 1) offset.y = 0.0; // it stands on the floor
        state.scope.origin = state.scope.toWorld(offset);
    } else {
        const double sum = size.x + size.y + size.z;
        const double mean = zeros == 3 ? 1.0 : zeros == 2 ? sum : 0.5 * sum;
        for (int k = 0; k < 3; ++k)
            if (size[k] <= kFlat && !(flat && k == normal)) size[k] = mean;
        if (flat) size[normal] = 0.0;
    }
    state.scope.size = size;
    if (!checkSize(state, place)) return;
    trouble_.spend(place, u64(8) * sides[0] * (op == Operation::PrimitiveSphere ? sides[1] : 1));
    Geometry geometry;
    const glm::dvec3 level = normal == 1   ? size
                             : normal == 2 ? glm::dvec3(size.x, 0.0, size.y)
                                           : glm::dvec3(size.z, 0.0, size.y);
    switch (op) {
    case Operation::PrimitiveCone:
        geometry = conePrimitive(sides[0], size);
        break;
    case Operation::PrimitiveCylinder:
        geometry = cylinderPrimitive(sides[0], size);
        break;
    case Operation::PrimitiveDisk:
        geometry = laidInto(diskPrimitive(sides[0], level), normal, size);
        break;
    case Operation::PrimitiveQuad:
        geometry = laidInto(quadPrimitive(level), normal, size);
        break;
    case Operation::PrimitiveSphere:
        geometry = spherePrimitive(sides[0], sides[1], size);
        break;
    default:
        geometry = boxPrimitive(size);
        break;
    }
    replaceShape(state, std::move(geometry));
    state.asset = nullptr;
    trimGeometry(state);
}

/// i("name"): the asset's box is fitted to the scope. Sizes of 0 follow the asset: all three take its own size and
/// place its origin in the scope's, two its uniform scale (and its place along them), one the mean scale of the others.
void Interpreter::insertAsset(const Statement& statement, ShapeState& state, Frame& frame)
{
    const std::string name = evaluator_.text(statement.args[0].value, env(state, frame));
    if (trouble_.failed()) return;
    if (const auto primitive = builtinPrimitive(name)) return insertPrimitive(*primitive, {}, statement.place, state);
    const auto found = boxes_.find(name);
    if (!found) return trouble_.fail(statement.place, concat("i(\"", name, "\"): ", found.error().message));

    auto asset = std::make_shared<InsertedAsset>();
    const auto [it, added] = assetIndex_.emplace(name, u32(result_.assets.size()));
    if (added) result_.assets.push_back(name);
    asset->asset = it->second;
    asset->boxMin = found->min;
    asset->boxMax = found->max;
    // zUp assets stand on their z axis: turn them so that it becomes y.
    const glm::dmat3 turn = statement.mode & kWholeScope
                                ? glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0))
                                : glm::dmat3(1.0);
    const glm::dvec3 a = turn * found->min, b = turn * found->max, low = glm::min(a, b), extent = glm::abs(b - a);
    glm::dvec3& size = state.scope.size;
    if (statement.mode & kKeepSizeAlignPosition) {
        state.scope.origin = state.scope.toWorld({0.5 * (size.x - extent.x), 0.0, 0.5 * (size.z - extent.z)});
        size = extent;
        state.mirrored = glm::bvec3(false);
    }
    if (statement.mode & kKeepSizeAndPosition) size = glm::dvec3(0.0);
    const int zeros = int(size.x <= kFlat) + int(size.y <= kFlat) + int(size.z <= kFlat);
    double scaleSum = 0.0;
    int scaleCount = 0;
    for (int k = 0; k < 3; ++k)
        if (size[k] > kFlat && extent[k] > kFlat) {
            scaleSum += size[k] / extent[k];
            ++scaleCount;
        }
    const double mean = scaleCount > 0 ? scaleSum / scaleCount : 1.0;
    glm::dvec3 shift(0.0);
    for (int k = 0; k < 3; ++k) {
        if (size[k] <= kFlat) {
            size[k] = mean * extent[k];
            if (zeros >= 2 && !(statement.mode & kKeepSizeAlignPosition)) shift[k] = mean * low[k];
        }
        const double scale = (extent[k] > kFlat ? size[k] / extent[k] : 1.0) * (state.mirrored[k] ? -1.0 : 1.0);
        for (int column = 0; column < 3; ++column) asset->localFromAsset[column][k] = turn[column][k] * scale;
        asset->localFromAsset[3][k] = -low[k] * scale + (state.mirrored[k] ? size[k] : 0.0);
    }
    state.scope.origin = state.scope.toWorld(shift);
    state.asset = std::move(asset);
    checkSize(state, statement.place);
}

} // namespace helio::cga
