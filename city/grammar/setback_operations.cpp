// SPDX-License-Identifier: Apache-2.0
// The operations of Interpreter that cut faces by offsets of their edges.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "city/geometry/clip.h"
#include "city/geometry/offset.h"
#include "city/grammar/interpreter.h"
#include "city/grammar/pieces.h"

namespace helio::cga {

namespace {

/// True for what rounding leaves between a polygon and its offset where both should meet: thinner than a millimetre.
bool isSlit(const Polygon2& polygon)
{
    double around = 0.0;
    for (size_t i = 0, n = polygon.outer.size(); i < n; ++i)
        around += glm::distance(polygon.outer[i], polygon.outer[(i + 1) % n]);
    return area(polygon) < 0.5e-3 * around;
}

/// Direction of the first edge that is not tiny; a face's own if there is none.
glm::dvec3 firstDirection(const Polygon3& polygon, const glm::dvec3& fallback)
{
    for (size_t k = 0; k < polygon.outer.size(); ++k) {
        const glm::dvec3 by = polygon.outer[(k + 1) % polygon.outer.size()] - polygon.outer[k];
        if (glm::length(by) > 1e-3) return glm::normalize(by);
    }
    return fallback;
}

/// Pieces of a face's plane as faces of the same scope, with the numbers of the edges whose line they keep.
void addPieces(std::vector<Face>& pieces, const FacePlane& plane, const Face& source,
               std::span<const Polygon2> polygons)
{
    for (const Polygon2& polygon : polygons) {
        Face piece;
        piece.polygon = plane.raise(polygon);
        piece.xAxis = firstDirection(piece.polygon, source.xAxis);
        piece.edge = source.edge;
        piece.outer = source.outer;
        if (!source.edges.empty()) inheritEdges(source, piece);
        pieces.push_back(std::move(piece));
    }
}

/// What is left of a polygon outside of others.
std::vector<Polygon2> without(const Polygon2& polygon, std::span<const Polygon2> cut)
{
    ClipperLib::Paths paths;
    for (const Polygon2& part : cut) appendRings(paths, part);
    return subtractToPolygons(toPaths(polygon), paths);
}

Polygon2 rectangleOf(const InnerRectangle& r)
{
    const glm::dvec2 x = r.axis * r.size.x, y = glm::dvec2(-r.axis.y, r.axis.x) * r.size.y;
    return {{r.origin, r.origin + x, r.origin + x + y, r.origin + y}, {}};
}

/// Largest rectangle along `axis`, or, if `alongEdges`, along any edge of at least a quarter of the longest one's
/// length.
std::optional<InnerRectangle> largestRectangle(const Polygon2& polygon, const glm::dvec2& axis, bool alongEdges)
{
    if (!alongEdges) return innerRectangle(polygon, axis);
    std::vector<glm::dvec2> axes;
    const auto addRing = [&](const Ring2& ring) {
        double longest = 0.0;
        for (size_t k = 0; k < ring.size(); ++k)
            longest = std::max(longest, glm::distance(ring[k], ring[(k + 1) % ring.size()]));
        for (size_t k = 0; k < ring.size(); ++k) {
            const glm::dvec2 by = ring[(k + 1) % ring.size()] - ring[k];
            if (glm::length(by) <= 0.25 * longest || glm::length(by) < 1e-3) continue;
            const glm::dvec2 along = glm::normalize(by);
            // A rectangle along one edge is one along all edges that are parallel or at right angles to it.
            const bool known = std::any_of(axes.begin(), axes.end(), [&](const glm::dvec2& other) {
                return std::min(std::abs(cross(other, along)), std::abs(glm::dot(other, along))) < 1e-6;
            });
            if (!known) axes.push_back(along);
        }
    };
    addRing(polygon.outer);
    for (const Ring2& hole : polygon.holes) addRing(hole);
    std::optional<InnerRectangle> best;
    for (const glm::dvec2& along : axes)
        if (const auto found = innerRectangle(polygon, along);
            found && (!best || found->size.x * found->size.y > best->size.x * best->size.y))
            best = found;
    return best;
}

} // namespace

/// False, with an error, for assets and solids; false for a shape without faces.
bool Interpreter::needsFaces(const Statement& statement, const ShapeState& state)
{
    const std::string& name = program_.names[statement.name];
    if (state.asset)
        trouble_.fail(statement.place, concat(name, " belongs before i(..)"));
    else if (state.geometry->closed)
        trouble_.fail(statement.place, concat(name, " needs a face, but the shape is a solid: pick one with comp(f) { "
                                                    "top : .. }"));
    return !trouble_.failed() && !state.geometry->faces.empty();
}

void Interpreter::setback(const Statement& statement, const ShapeState& state, Frame& frame)
{
    frame.spawned = true;
    if (!needsFaces(statement, state)) return;
    const bool perEdge = statement.op == Operation::SetbackPerEdge;
    const double common = perEdge ? 0.0 : evaluator_.number(statement.args[0].value, env(state, frame));
    if (trouble_.failed()) return;
    if (!perEdge && common < 0.0) trouble_.warn(statement.place, "setback by less than 0 cuts nothing");
    const std::vector<BlockElement>& elements = statement.block->elements;
    const std::optional<StreetSides> streets = streetSides(footprint_);
    const SelectorContext context = selectorContext(state, streets);
    std::vector<std::vector<Face>> pieces(elements.size());
    std::vector<Face> rest;
    u32 number = 0;
    for (const Face& original : state.geometry->faces) {
        const Face face = numberedFace(original, state.footprint);
        const auto plane = FacePlane::of(face);
        if (!plane) continue;
        trouble_.spend(statement.place, planeWork(face));
        Geometry alone;
        alone.faces.push_back(face);
        const std::vector<MeshEdge> ring = meshEdges(alone);
        std::vector<double> widths(ring.size(), 0.0);
        std::vector<size_t> owners(ring.size(), elements.size());
        for (size_t k = 0; k < ring.size(); ++k, ++number) {
            const std::vector<Component> component =
                componentsOf(alone, {ring[k]}, ComponentKind::FaceEdges, state.scope.axes);
            if (component.empty()) continue; // an edge without length
            for (size_t e = 0; e < elements.size() && owners[k] == elements.size(); ++e)
                if (elements[e].selector != Selector::Remainder &&
                    selects(elements[e].selector, elements[e].selectorIndex, component[0], number, context))
                    owners[k] = e;
            if (owners[k] == elements.size()) continue;
            widths[k] = common;
            if (perEdge) {
                ShapeState edge = state;
                replaceGeometry(edge, edgeScope(state.scope, component[0]), {}, false);
                edge.compIndex = double(k);
                edge.compTotal = double(ring.size());
                widths[k] = evaluator_.number(statement.args[0].value, env(edge, frame));
            }
            widths[k] = std::clamp(widths[k], 0.0, kMaxCoordinate);
        }
        if (trouble_.failed()) return;
        const helio::Setback cut = helio::setback(plane->flat(face.polygon), widths);
        for (const SetbackStrip& strip : cut.strips)
            if (owners[strip.edge] < elements.size())
                addPieces(pieces[owners[strip.edge]], *plane, face, std::span(&strip.polygon, 1));
        addPieces(rest, *plane, face, cut.remainder);
    }
    for (size_t e = 0; e < elements.size() && !trouble_.failed(); ++e)
        spawnPieces(elements[e], elements[e].selector == Selector::Remainder ? std::exchange(rest, {}) : pieces[e],
                    state, frame, ShapeOp::Split, OperationName::Setback);
}

/// shapeL(front, left), shapeU(front, right, left), shapeO(front, right, back, left).
void Interpreter::wings(const Statement& statement, const ShapeState& state, Frame& frame)
{
    frame.spawned = true;
    if (!needsFaces(statement, state)) return;
    static constexpr Selector kL[] = {Selector::Front, Selector::Left},
                              kU[] = {Selector::Front, Selector::Right, Selector::Left},
                              kO[] = {Selector::Front, Selector::Right, Selector::Back, Selector::Left};
    const std::span<const Selector> sides = statement.op == Operation::ShapeL   ? std::span<const Selector>(kL)
                                            : statement.op == Operation::ShapeU ? std::span<const Selector>(kU)
                                                                                : std::span<const Selector>(kO);
    std::vector<double> widths;
    for (const Size& arg : statement.args) widths.push_back(evaluator_.number(arg.value, env(state, frame)));
    if (trouble_.failed()) return;
    std::vector<Face> shapes, rest;
    for (const Face& original : state.geometry->faces) {
        const Face face = numberedFace(original, state.footprint);
        const auto plane = FacePlane::of(face);
        if (!plane) continue;
        trouble_.spend(statement.place, planeWork(face));
        Geometry alone;
        alone.faces.push_back(face);
        const std::vector<MeshEdge> ring = meshEdges(alone);
        std::vector<double> edgeWidths(ring.size(), 0.0);
        for (size_t k = 0; k < ring.size(); ++k) {
            const std::vector<Component> component =
                componentsOf(alone, {ring[k]}, ComponentKind::FaceEdges, state.scope.axes);
            if (component.empty()) continue;
            for (size_t side = 0; side < sides.size(); ++side)
                if (selects(sides[side], component[0].normal))
                    edgeWidths[k] = std::clamp(widths[side], 0.0, kMaxCoordinate);
        }
        const Polygon2 flat = plane->flat(face.polygon);
        const helio::Setback cut = helio::setback(flat, edgeWidths);
        addPieces(shapes, *plane, face, without(flat, cut.remainder));
        addPieces(rest, *plane, face, cut.remainder);
    }
    spawnShapeAndRest(statement, state, frame, std::move(shapes), std::move(rest));
}

void Interpreter::spawnShapeAndRest(const Statement& statement, const ShapeState& state, Frame& frame,
                                    std::vector<Face> shapes, std::vector<Face> rest)
{
    for (const BlockElement& element : statement.block->elements) {
        if (trouble_.failed()) return;
        if (element.selector != Selector::Shape && element.selector != Selector::Remainder)
            return trouble_.fail(
                element.place, concat(program_.names[statement.name], " knows only the selectors shape and remainder"));
        spawnPieces(element, std::exchange(element.selector == Selector::Shape ? shapes : rest, {}), state, frame,
                    ShapeOp::Split, OperationName::Setback);
    }
}

void Interpreter::innerRectangle(const Statement& statement, const ShapeState& state, Frame& frame)
{
    frame.spawned = true;
    if (!needsFaces(statement, state)) return;
    std::vector<Face> shapes, rest;
    for (const Face& original : state.geometry->faces) {
        const Face face = numberedFace(original, state.footprint);
        const auto plane = FacePlane::of(face);
        if (!plane) continue;
        // Every edge is tried as a side.
        trouble_.spend(statement.place, planeWork(face) * (1 + face.polygon.outer.size() / 64));
        const Polygon2 flat = plane->flat(face.polygon);
        const auto found = largestRectangle(flat, {1.0, 0.0}, statement.mode == kAlongEdge);
        if (!found) {
            addPieces(rest, *plane, face, std::span(&flat, 1));
            continue;
        }
        const Polygon2 rectangle = rectangleOf(*found);
        addPieces(shapes, *plane, face, std::span(&rectangle, 1));
        addPieces(rest, *plane, face, without(flat, std::span(&rectangle, 1)));
    }
    spawnShapeAndRest(statement, state, frame, std::move(shapes), std::move(rest));
}

/// The old form of innerRectangle(scope): the shape itself becomes the rectangles.
void Interpreter::innerRect(const Statement& statement, ShapeState& state)
{
    if (!needsFaces(statement, state)) return;
    Geometry result;
    for (const Face& original : state.geometry->faces) {
        const Face face = numberedFace(original, state.footprint);
        const auto plane = FacePlane::of(face);
        if (!plane) continue;
        trouble_.spend(statement.place, 4 * planeWork(face));
        if (const auto found = largestRectangle(plane->flat(face.polygon), {1.0, 0.0}, false)) {
            const Polygon2 rectangle = rectangleOf(*found);
            addPieces(result.faces, *plane, face, std::span(&rectangle, 1));
        }
    }
    if (result.faces.empty())
        return trouble_.warn(statement.place, "no rectangle fits into the shape: it stays as it is");
    replaceFaces(state, std::move(result));
}

void Interpreter::offsetFaces(const Statement& statement, ShapeState& state, Frame& frame)
{
    if (!needsFaces(statement, state)) return;
    const double distance = evaluator_.number(statement.args[0].value, env(state, frame));
    if (trouble_.failed()) return;
    if (!(std::abs(distance) < 1e4))
        return trouble_.fail(statement.place, concat("offset by ", distance, " m is too far"));
    const auto keep = OffsetKeep(statement.mode);
    Geometry result;
    for (const Face& original : state.geometry->faces) {
        const Face face = numberedFace(original, state.footprint);
        const auto plane = FacePlane::of(face);
        if (!plane) continue;
        trouble_.spend(statement.place, planeWork(face));
        const Polygon2 flat = plane->flat(face.polygon);
        const std::vector<Polygon2> moved = offsetPolygon(flat, distance);
        if (keep != OffsetKeep::Border) {
            // Outwards, the border lies around the face: both together are the offset polygon.
            if (keep == OffsetKeep::All && distance > 0.0)
                addPieces(result.faces, *plane, face, std::span(&flat, 1));
            else
                addPieces(result.faces, *plane, face, moved);
        }
        if (keep == OffsetKeep::Inside) continue;
        std::vector<Polygon2> border;
        if (distance > 0.0)
            for (const Polygon2& polygon : moved) {
                const std::vector<Polygon2> ring = without(polygon, std::span(&flat, 1));
                border.insert(border.end(), ring.begin(), ring.end());
            }
        else
            border = without(flat, moved);
        std::erase_if(border, isSlit);
        addPieces(result.faces, *plane, face, border);
    }
    if (result.faces.empty()) trouble_.warn(statement.place, "nothing is left after an offset: the shape is too small");
    replaceFaces(state, std::move(result));
}

} // namespace helio::cga
