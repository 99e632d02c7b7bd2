// SPDX-License-Identifier: Apache-2.0
// What Interpreter writes into the shape tree.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "city/grammar/interpreter.h"
#include "city/model/materials.h"

namespace helio::cga {

namespace {

constexpr double kMaxReflectance = 0.95; ///< no white paint reflects more; keeps the light's series short
constexpr double kMinLeafArea = 1e-8;    ///< m2
constexpr double kMinPart = 1e-4;        ///< m2: a free or covered part below 1 cm x 1 cm is not told apart
constexpr double kFitTolerance = 0.01;   ///< m: how well an asset must fit its tile

} // namespace

u32 Interpreter::surfaceOf(const Look& look)
{
    Surface surface;
    surface.name = look.material;
    const Material* material = materialNamed(look.material);
    if (material) surface.rho = material->rho;
    if (look.color) {
        const glm::dvec3 rgb = linearFromSrgb(glm::clamp(*look.color, 0.0, 1.0));
        surface.rho = glm::dvec4(rgb, material ? material->rho.a : solarFromRgb(rgb));
    }
    surface.rho = glm::clamp(surface.rho, 0.0, kMaxReflectance);
    const glm::dvec3 emissive = glm::max(look.emissive, glm::dvec3(0.0));
    surface.emission = glm::dvec4(emissive, solarFromRgb(emissive));
    // A lamp of the table shines by its name; what a rule says about emission comes before it.
    if (material && emissive == glm::dvec3(0.0)) surface.emission = material->emission;
    const auto &r = surface.rho, &e = surface.emission;
    const auto [it, added] = surfaceIndex_.emplace(
        std::tuple(surface.name, std::array{r.r, r.g, r.b, r.a, e.r, e.g, e.b, e.a}), u32(result_.surfaces.size()));
    if (added) result_.surfaces.push_back(surface);
    return it->second;
}

/// Adds a geometry's faces as polygons in the world frame: metres, z up.
void Interpreter::addPolygons(const Scope& scope, const Geometry& geometry, Shape& shape)
{
    const glm::dvec2 corner = footprintCorner(footprint_);
    shape.polygonBegin = u32(result_.polygons.size());
    const auto convert = [&](const Ring3& ring) {
        Ring3 result;
        result.reserve(ring.size());
        for (const glm::dvec3& local : ring) {
            const glm::dvec3 p = scope.toWorld(local);
            result.emplace_back(corner.x + p.x, corner.y - p.z, footprint_.base + p.y);
        }
        return result;
    };
    for (const Face& face : geometry.faces) {
        if (area(face.polygon) < kMinLeafArea) continue;
        Polygon3 polygon;
        polygon.outer = convert(face.polygon.outer);
        for (const Ring3& hole : face.polygon.holes) polygon.holes.push_back(convert(hole));
        result_.polygons.push_back(std::move(polygon));
    }
    shape.polygonCount = u32(result_.polygons.size()) - shape.polygonBegin;
}

/// True if the asset's box lies at or behind the plane of its tile and covers the tile's rectangle, both within a
/// centimetre.
bool Interpreter::fillsTile(const ShapeState& state) const
{
    if (!state.tile) return false;
    const Scope& tile = state.tile->scope;
    const InsertedAsset& asset = *state.asset;
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (int corner = 0; corner < 8; ++corner) {
        glm::dvec3 p;
        for (int k = 0; k < 3; ++k) p[k] = (corner >> k) & 1 ? asset.boxMax[k] : asset.boxMin[k];
        const glm::dvec3 world = state.scope.toWorld(asset.localFromAsset * glm::dvec4(p, 1.0));
        const glm::dvec3 inTile = glm::transpose(tile.axes) * (world - tile.origin);
        low = glm::min(low, inTile);
        high = glm::max(high, inTile);
    }
    // The plane of a tile is the one in which its polygon lies: z = 0 for faces, another axis for a lot.
    int normal = 0;
    for (int k = 1; k < 3; ++k)
        if (tile.size[k] < tile.size[normal]) normal = k;
    for (int k = 0; k < 3; ++k) {
        if (k == normal ? high[k] > kFitTolerance
                        : std::abs(low[k]) > kFitTolerance || std::abs(high[k] - tile.size[k]) > kFitTolerance)
            return false;
    }
    return true;
}

/// True if the middle of the shape's tile lies on a part of a wall that a neighbour covers.
bool Interpreter::onCoveredPart(const ShapeState& state) const
{
    if (!occlusion_.any() || state.edge == kNoIndex || !state.tile || !state.tile->intact) return false;
    const auto [low, high] = bounds(*state.tile->geometry);
    return occlusion_.covers(state.tile->scope.toWorld(0.5 * (low + high)), state.edge);
}

/// Gives a node its faces. Where a neighbour covers some of them or parts of them, the node gets two leaves below it:
/// child 0 the free parts, child 1 the covered ones, so that the keys do not hang on how they are cut. False if there
/// is nothing to show.
bool Interpreter::addSurfaces(const ShapeState& state, const Scope& scope, const Geometry& geometry, const Frame& frame,
                              Place place)
{
    Geometry open, hidden;
    // What a rule built on a wall, a sill say, stands out of it; the walls of a solid made of the lot are walls.
    if (occlusion_.any() && !(geometry.closed && state.edge != kNoIndex)) {
        trouble_.spend(place, cornerCount(geometry) * occlusion_.wallCount());
        for (const Face& face : geometry.faces)
            occlusion_.divide(scope, face, state.edge != kNoIndex ? state.edge : face.edge, open, hidden);
    }
    const bool covered = !hidden.faces.empty() && area(open) < kMinPart;
    if (hidden.faces.empty() || covered || area(hidden) < kMinPart) {
        Shape& shape = result_.shapes[frame.node];
        addPolygons(scope, geometry, shape);
        if (shape.polygonCount == 0) return false;
        shape.surface = surfaceOf(state.look);
        shape.covered = covered;
        return true;
    }
    if (result_.shapes.size() + 2 > kMaxShapes)
        trouble_.fail(place, concat("the building has more than ", kMaxShapes, " shapes: use larger sizes"));
    for (u32 k = 0; k < 2; ++k) {
        Shape part;
        part.parent = frame.node;
        part.name = result_.shapes[frame.node].name;
        part.op = ShapeOp::Split;
        part.child = k;
        part.covered = k == 1;
        part.surface = surfaceOf(state.look);
        addPolygons(scope, k == 0 ? open : hidden, part);
        result_.shapes.push_back(part);
    }
    return true;
}

/// Turns a frame's node into a leaf. False if nothing is left to show.
bool Interpreter::emitLeaf(const ShapeState& state, Frame& frame, Place place)
{
    Shape& shape = result_.shapes[frame.node];
    // Behind a neighbour's wall there is no opening: what would fill a piece of the facade leaves it blank.
    const bool dropped = state.asset && onCoveredPart(state), fills = state.asset && fillsTile(state);
    if (dropped) ++result_.droppedOpenings;
    if (!state.asset || (dropped && fills)) {
        const Scope& scope = state.asset ? state.tile->scope : state.scope;
        const Geometry& geometry = state.asset ? *state.tile->geometry : *state.geometry;
        if (!addSurfaces(state, scope, geometry, frame, place)) return false;
        if (state.tile && (state.intact || (state.asset && state.tile->intact)))
            frame.covered.planar = state.tile->area;
        return true;
    }
    if (state.tile && state.tile->intact && !fills) {
        frame.covered.overlay = state.tile->area;
        frame.covered.place = place;
    }
    if (dropped) return false;
    shape.asset = state.asset->asset;
    if (shape.op != ShapeOp::Root) shape.op = ShapeOp::Insert;
    // Asset (y up) -> scope -> building (y up) -> world (z up): (x, y, z) -> (x, -z, y).
    const glm::dmat3 worldFromCga(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0));
    const glm::dmat3 turn = worldFromCga * state.scope.axes;
    const glm::dvec3 offset(footprintCorner(footprint_), footprint_.base);
    const glm::dmat4x3& local = state.asset->localFromAsset;
    for (int k = 0; k < 3; ++k) shape.worldFromAsset[k] = turn * local[k];
    shape.worldFromAsset[3] = offset + worldFromCga * state.scope.origin + turn * local[3];
    shape.placement = AssetPlacement::Overlay;
    if (!fills) {
        addTrim(state, shape);
        return true;
    }
    shape.placement = AssetPlacement::Fill;
    addPolygons(state.tile->scope, *state.tile->geometry, shape);
    shape.surface = surfaceOf(state.look);
    if (state.tile->intact) frame.covered.planar = state.tile->area;
    return shape.polygonCount > 0;
}

} // namespace helio::cga
