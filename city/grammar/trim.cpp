// SPDX-License-Identifier: Apache-2.0
// Trim planes: what comp(f) leaves on a face, and where it cuts.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "city/grammar/clip.h"
#include "city/grammar/interpreter.h"
#include "city/grammar/pieces.h"
#include "city/grammar/trim.h"

namespace helio::cga {

std::vector<glm::dvec4> activeTrim(const ShapeState& state)
{
    std::vector<glm::dvec4> planes;
    if (!state.trim) return planes;
    for (const TrimPlane& trim : *state.trim)
        if (trim.vertical ? state.trimVertical : state.trimHorizontal) planes.push_back(trim.plane);
    return planes;
}

bool trimGeometry(ShapeState& state)
{
    Geometry geometry = *state.geometry;
    bool cut = false;
    for (const glm::dvec4& plane : activeTrim(state)) {
        const glm::dvec3 normal = glm::transpose(state.scope.axes) * glm::dvec3(plane);
        const double offset = -plane.w - glm::dot(glm::dvec3(plane), state.scope.origin);
        bool outside = false;
        for (const Face& face : geometry.faces)
            for (const glm::dvec3& p : face.polygon.outer) outside = outside || glm::dot(normal, p) < offset - kSnap;
        if (!outside) continue;
        geometry = clipPlane(geometry, normal, offset);
        cut = true;
    }
    if (!cut) return false;
    fitScope(state.scope, geometry);
    state.geometry = std::make_shared<const Geometry>(std::move(geometry));
    return true;
}

/// Gives an asset those planes that cut its box by more than a millimetre, in the world frame (z up).
void Interpreter::addTrim(const ShapeState& state, Shape& shape)
{
    const InsertedAsset& asset = *state.asset;
    shape.trimBegin = u32(result_.trimPlanes.size());
    for (const glm::dvec4& plane : activeTrim(state)) {
        double least = INFINITY;
        for (int corner = 0; corner < 8; ++corner) {
            glm::dvec3 p;
            for (int k = 0; k < 3; ++k) p[k] = (corner >> k) & 1 ? asset.boxMax[k] : asset.boxMin[k];
            const glm::dvec3 place = state.scope.toWorld(asset.localFromAsset * glm::dvec4(p, 1.0));
            least = std::min(least, glm::dot(glm::dvec3(plane), place) + plane.w);
        }
        if (least > -1e-3) continue;
        // (x, y, z) of the building is (x, -z, y) of the world, from the footprint's first corner and base.
        const glm::dvec3 normal(plane.x, -plane.z, plane.y), origin(footprintCorner(footprint_), footprint_.base);
        result_.trimPlanes.emplace_back(normal, plane.w - glm::dot(normal, origin));
    }
    shape.trimCount = u32(result_.trimPlanes.size()) - shape.trimBegin;
    if (shape.trimCount == 0) shape.trimBegin = 0;
}

void Interpreter::trim(const Statement& statement, ShapeState& state)
{
    if (state.asset)
        return trouble_.fail(statement.place, "trim belongs before i(..): assets are trimmed as they are inserted");
    trouble_.spend(statement.place, cornerCount(*state.geometry));
    if (trimGeometry(state)) replaceFaces(state, Geometry(*state.geometry));
}

} // namespace helio::cga
