// SPDX-License-Identifier: Apache-2.0
// scatter: shapes without size at random points of the current one.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "city/grammar/interpreter.h"
#include "city/grammar/pieces.h"
#include "city/grammar/scatter.h"

namespace helio::cga {

namespace {

constexpr double kDeviation = 0.16; ///< of the scope's size, where the rule names none

/// Middle of the scope, or of one of its sides.
glm::dvec3 meanOf(ScatterMean mean, const glm::dvec3& size)
{
    glm::dvec3 p = 0.5 * size;
    switch (mean) {
    case ScatterMean::Center:
        break;
    case ScatterMean::Front:
        p.z = size.z;
        break;
    case ScatterMean::Back:
        p.z = 0.0;
        break;
    case ScatterMean::Left:
        p.x = 0.0;
        break;
    case ScatterMean::Right:
        p.x = size.x;
        break;
    case ScatterMean::Top:
        p.y = size.y;
        break;
    case ScatterMean::Bottom:
        p.y = 0.0;
        break;
    }
    return p;
}

} // namespace

void Interpreter::scatter(const Statement& statement, const ShapeState& state, Frame& frame)
{
    frame.spawned = true;
    if (refuseAsset(statement, state)) return;
    const double asked = evaluator_.number(statement.args[0].value, env(state, frame));
    std::optional<ScatterPeak> peak;
    if ((statement.mode & kGaussian) != 0) {
        const glm::dvec3& size = state.scope.size;
        peak = ScatterPeak{meanOf(ScatterMean(statement.mode / kFirstMean), size), kDeviation * size};
        if (statement.args.size() > 1) {
            const double given = evaluator_.number(statement.args[1].value, env(state, frame));
            peak->deviation = statement.args[1].kind == SizeKind::Relative ? given * size : glm::dvec3(given);
            if (given < 0.0) return trouble_.fail(statement.place, "the deviation of scatter must not be below 0");
        }
    }
    if (trouble_.failed()) return;
    const double count = std::floor(asked + 0.5);
    if (count > kMaxParts)
        return trouble_.fail(statement.place, concat("scatter makes at most ", kMaxParts, " shapes, not ", count));
    const u64 corners = cornerCount(*state.geometry);
    trouble_.spend(statement.place, corners + corners * corners / 64);
    if (count < 1.0 || trouble_.failed()) return;

    const auto domain = ScatterDomain(statement.mode & kScatterDomain);
    const Scatter points(*state.geometry, state.scope.size, domain, peak);
    if (!points.any()) return;
    // A stream of its own: the draws of the rule do not hang on the number of points.
    Random random(mixSeed(mixSeed(frame.seed, hashText("scatter")), frame.childCount));
    for (double k = 0; k < count && !trouble_.failed(); ++k) {
        u64 work = 1;
        const ScatterPoint point = points.draw(random, work);
        trouble_.spend(statement.place, work);
        if (trouble_.failed()) return;
        Scope scope{state.scope.toWorld(point.place), state.scope.axes, glm::dvec3(0.0)};
        if (point.normal != glm::dvec3(0.0)) {
            // y stands on the face; x stays as far as it can.
            const glm::dvec3 y = point.normal;
            glm::dvec3 x = glm::dvec3(1, 0, 0) - y * y.x;
            if (glm::length(x) < 1e-6) x = glm::dvec3(0, 0, 1) - y * y.z;
            x = glm::normalize(x);
            scope.axes = state.scope.axes * glm::dmat3(x, y, glm::cross(x, y));
        }
        ShapeState child = state;
        child.intact = false;
        child.edge = kNoIndex;
        child.trim = nullptr;
        replaceGeometry(child, scope, {}, false);
        spawnPart(statement.body[0], std::move(child), frame, ShapeOp::Split, OperationName::Scatter);
    }
}

} // namespace helio::cga
