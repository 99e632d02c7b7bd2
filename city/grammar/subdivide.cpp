// SPDX-License-Identifier: Apache-2.0
// The operations of Interpreter that divide the current shape.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "city/grammar/clip.h"
#include "city/grammar/component.h"
#include "city/grammar/interpreter.h"
#include "city/grammar/pieces.h"
#include "city/grammar/split_sizes.h"

namespace helio::cga {

namespace {

constexpr double kMinPiece = 1e-12; ///< m2: smaller pieces are rounding
constexpr double kMinSize = 1e-9;   ///< m: smaller sizes are 0

/// What comp.sel reads.
std::string_view selectorName(Selector selector)
{
    static constexpr std::string_view kNames[] = {
        "front",       "right",       "back",        "left",          "top",         "bottom",       "side",
        "vertical",    "horizontal",  "aslant",      "nutant",        "all",         "object.front", "object.right",
        "object.back", "object.left", "object.top",  "object.bottom", "object.side", "world.south",  "world.east",
        "world.north", "world.west",  "world.up",    "world.down",    "world.side",  "street.front", "street.right",
        "street.back", "street.left", "street.side", "border",        "inside",      "ridge",        "hip",
        "valley",      "eave",        "shape",       "remainder",     "other"};
    static_assert(std::size(kNames) == size_t(Selector::Index) + 1);
    return kNames[size_t(selector)];
}

/// The trim planes of a face, from the coordinates of the scope to the frame of the building.
std::shared_ptr<const std::vector<TrimPlane>> trimOf(const ShapeState& state, const std::vector<MeshEdge>& edges,
                                                     u32 face)
{
    const glm::dvec3 up = glm::transpose(state.scope.axes) * glm::dvec3(0, 1, 0);
    auto planes = std::make_shared<std::vector<TrimPlane>>(trimPlanesOf(*state.geometry, edges, face, up));
    for (TrimPlane& trim : *planes) {
        const glm::dvec3 normal = state.scope.axes * glm::dvec3(trim.plane);
        trim.plane = glm::dvec4(normal, trim.plane.w - glm::dot(normal, state.scope.origin));
    }
    return planes;
}

} // namespace

bool Interpreter::refuseAsset(const Statement& statement, const ShapeState& state)
{
    if (state.asset) trouble_.fail(statement.place, "an inserted asset cannot be divided: split before i(..)");
    return state.asset != nullptr;
}

void Interpreter::split(const Statement& statement, const ShapeState& state, Frame& frame)
{
    frame.spawned = true;
    if (refuseAsset(statement, state)) return;
    const int axis = int(statement.mode & 3u);
    const bool adjust = (statement.mode & kNoAdjust) == 0;
    std::vector<const BlockElement*> elements;
    const auto collect = [&](const auto& self, const Block& block, std::vector<SplitItem>& items) -> void {
        for (const BlockElement& element : block.elements) {
            if (element.nested && !element.nested->repeat) {
                self(self, *element.nested, items); // a plain inner block is only punctuation
                continue;
            }
            SplitItem item;
            if (element.nested) {
                self(self, *element.nested, item.pattern);
                if (item.pattern.empty()) continue;
            } else {
                item.kind = element.size.kind;
                item.value = evaluator_.number(element.size.value, env(state, frame));
                if (item.value < -kMinSize)
                    trouble_.warnOnce(element.place, "this size of a split is negative and counts as 0",
                                      concat(" (", item.value, ")"));
                item.element = u32(elements.size());
                elements.push_back(&element);
            }
            items.push_back(std::move(item));
        }
    };
    std::vector<SplitItem> items;
    collect(collect, *statement.block, items);
    if (statement.block->repeat && !items.empty()) {
        SplitItem whole;
        whole.pattern = std::move(items);
        items = {whole};
    }
    if (trouble_.failed()) return;
    const auto parts = splitParts(state.scope.size[axis], items);
    if (!parts) return trouble_.fail(statement.place, parts.error().message);

    Geometry whole = *state.geometry;
    if (state.footprint)
        for (Face& face : whole.faces) face = numberedFace(face, true); // the parts' walls stay known
    const size_t corners = cornerCount(whole);
    if (parts->empty() && !whole.faces.empty())
        trouble_.warn(statement.place, state.scope.size[axis] > kMinSize
                                           ? "this split makes no part: no size is above 0 and fits"
                                           : "this split makes no part: its shape has no extent along the axis");
    for (size_t k = 0; k < parts->size() && !trouble_.failed(); ++k) {
        const SplitPart& part = (*parts)[k];
        trouble_.spend(statement.place, corners);
        Geometry piece = clipSlab(whole, axis, part.begin, part.end);
        const bool empty = whole.faces.empty(); // edges of comp(e) have only a scope
        if (piece.faces.empty() && !empty) continue;
        ShapeState child = state;
        Scope scope = state.scope;
        if (adjust && !empty) {
            fitScope(scope, piece);
        } else {
            glm::dvec3 offset(0.0);
            offset[axis] = part.begin;
            piece = transformed(piece, glm::dmat3(1.0), offset);
            scope.origin = state.scope.toWorld(offset);
            scope.size[axis] = part.end - part.begin;
        }
        replaceGeometry(child, scope, std::move(piece), state.tile != nullptr);
        child.splitIndex = double(k);
        child.splitTotal = double(parts->size());
        spawnPart(elements[part.element]->body, std::move(child), frame, ShapeOp::Split, OperationName::Split);
    }
}

void Interpreter::spawnPieces(const BlockElement& element, std::vector<Face> faces, const ShapeState& state,
                              Frame& frame, ShapeOp op, OperationName name)
{
    if (faces.empty()) return;
    std::vector<Geometry> pieces;
    if (element.combine) pieces.emplace_back();
    for (Face& face : faces) {
        if (area(face.polygon) < kMinPiece) continue;
        if (!element.combine) pieces.emplace_back();
        pieces.back().faces.push_back(std::move(face));
    }
    for (size_t k = 0; k < pieces.size() && !trouble_.failed(); ++k) {
        if (pieces[k].faces.empty()) continue;
        ShapeState child = state;
        Scope scope = state.scope;
        fitScope(scope, pieces[k]);
        const bool planar = op == ShapeOp::Component ? isPlanar(pieces[k]) : state.tile && isPlanar(pieces[k]);
        if (op == ShapeOp::Component) child.intact = true;
        replaceGeometry(child, scope, std::move(pieces[k]), planar);
        if (op == ShapeOp::Component) child.edge = kNoIndex;
        child.compSelector = selectorName(element.selector);
        child.compIndex = double(k);
        child.compTotal = double(pieces.size());
        spawnPart(element.body, std::move(child), frame, op, name);
    }
}

/// Makes one shape of all components (`combine`), or one of each.
void Interpreter::spawnComponents(const BlockElement& element, ComponentKind kind,
                                  const std::vector<const Component*>& components, const std::vector<MeshEdge>& edges,
                                  const ShapeState& state, Frame& frame)
{
    if (components.empty()) return;
    const Geometry& geometry = *state.geometry;
    if (element.combine && components.size() > 1) {
        if (kind != ComponentKind::Faces)
            return trouble_.fail(element.place,
                                 "edges and corners do not make one shape: write ':' after the selector");
        std::vector<Face> faces;
        for (const Component* component : components) faces.push_back(geometry.faces[component->face]);
        return spawnPieces(element, std::move(faces), state, frame, ShapeOp::Component, OperationName::Component);
    }
    for (size_t k = 0; k < components.size() && !trouble_.failed(); ++k) {
        const Component& component = *components[k];
        ShapeState child = state;
        if (kind == ComponentKind::Faces) {
            const Face& face = geometry.faces[component.face];
            if (area(face.polygon) < kMinPiece) continue;
            auto [scope, shape] = faceShape(state.scope, face);
            child.intact = true;
            replaceGeometry(child, scope, std::move(shape), true);
            if (geometry.faces.size() > 1) child.trim = trimOf(state, edges, component.face);
        } else {
            child.intact = false;
            replaceGeometry(child, edgeScope(state.scope, component), {}, false);
        }
        child.mirrored = glm::bvec3(false);
        child.edge = component.edge;
        child.compSelector = selectorName(element.selector);
        child.compIndex = double(k);
        child.compTotal = double(components.size());
        spawnPart(element.body, std::move(child), frame, ShapeOp::Component, OperationName::Component);
    }
}

SelectorContext Interpreter::selectorContext(const ShapeState& state, const std::optional<StreetSides>& streets) const
{
    return {glm::transpose(objectAxes_) * state.scope.axes, state.scope.axes, streets ? &*streets : nullptr};
}

void Interpreter::components(const Statement& statement, const ShapeState& state, Frame& frame)
{
    frame.spawned = true;
    if (refuseAsset(statement, state)) return;
    const Geometry& geometry = *state.geometry;
    trouble_.spend(statement.place, cornerCount(geometry));
    const auto kind = ComponentKind(statement.mode);
    const std::vector<BlockElement>& elements = statement.block->elements;
    const bool borders = std::any_of(elements.begin(), elements.end(), [](const BlockElement& element) {
        return element.selector == Selector::Border || element.selector == Selector::Inside;
    });
    u64 work = kind == ComponentKind::Vertices ? u64(cornerCount(geometry)) * cornerCount(geometry) / 8 : 0;
    trouble_.spend(statement.place, work);
    if (trouble_.failed()) return;
    work = 0;
    const std::vector<MeshEdge> edges = meshEdges(geometry, borders, &work);
    trouble_.spend(statement.place, work);
    const std::vector<Component> all = componentsOf(geometry, edges, kind, state.scope.axes);
    const std::optional<StreetSides> streets = streetSides(footprint_);
    const SelectorContext context = selectorContext(state, streets);
    std::vector<bool> taken(all.size(), false);
    const Covered before = frame.covered;
    for (const BlockElement& element : elements) {
        if (trouble_.failed()) return;
        std::vector<const Component*> selected;
        for (u32 k = 0; k < all.size(); ++k) {
            if (taken[k] || !selects(element.selector, element.selectorIndex, all[k], k, context)) continue;
            taken[k] = true;
            selected.push_back(&all[k]);
        }
        spawnComponents(element, kind, selected, edges, state, frame);
    }
    // What the faces of a solid carry says nothing of the plane that the solid stands on.
    if (!state.tile || !state.intact) frame.covered = before;
}

} // namespace helio::cga
