// SPDX-License-Identifier: Apache-2.0
// The operations of Interpreter that divide the current shape.
#include <algorithm>
#include <cmath>

#include "city/grammar/clip.h"
#include "city/grammar/component.h"
#include "city/grammar/interpreter.h"
#include "city/grammar/split_sizes.h"

namespace helio::cga {

namespace {

/// Gives a state other geometry, with a tile of its own if it is planar.
void replaceGeometry(ShapeState& state, const Scope& scope, Geometry geometry, bool planar)
{
    state.scope = scope;
    state.pivot = scope.origin;
    state.pivotAxes = scope.axes;
    state.footprint = false;
    auto shared = std::make_shared<const Geometry>(std::move(geometry));
    state.geometry = shared;
    state.tile = planar ? std::make_shared<const Tile>(Tile{scope, shared, area(*shared), state.intact}) : nullptr;
}

std::string_view selectorName(Selector selector)
{
    static constexpr std::string_view kNames[] = {"front", "right",    "back",       "left",   "top",    "bottom",
                                                  "side",  "vertical", "horizontal", "aslant", "nutant", "all"};
    return u32(selector) < std::size(kNames) ? kNames[u32(selector)] : std::string_view("other");
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

    const size_t corners = cornerCount(*state.geometry);
    for (size_t k = 0; k < parts->size() && !trouble_.failed(); ++k) {
        const SplitPart& part = (*parts)[k];
        trouble_.spend(statement.place, corners);
        Geometry piece = clipSlab(*state.geometry, axis, part.begin, part.end);
        if (piece.faces.empty()) continue;
        ShapeState child = state;
        Scope scope = state.scope;
        if (adjust) {
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

/// Makes one shape of all faces (`combine`), or one of each.
void Interpreter::spawnFaces(const BlockElement& element, const std::vector<const Face*>& faces,
                             const ShapeState& state, Frame& frame)
{
    if (faces.empty()) return;
    if (element.combine && faces.size() > 1) {
        Geometry combined;
        for (const Face* face : faces) combined.faces.push_back(*face);
        ShapeState child = state;
        Scope scope = state.scope;
        fitScope(scope, combined);
        child.intact = true;
        const bool planar = isPlanar(combined);
        replaceGeometry(child, scope, std::move(combined), planar);
        child.edge = kNoIndex;
        child.compSelector = selectorName(element.selector);
        child.compIndex = 0.0;
        spawnPart(element.body, std::move(child), frame, ShapeOp::Component, OperationName::Component);
        return;
    }
    for (size_t k = 0; k < faces.size() && !trouble_.failed(); ++k) {
        if (area(faces[k]->polygon) < 1e-12) continue;
        ShapeState child = state;
        auto [scope, geometry] = faceShape(state.scope, *faces[k]);
        child.intact = true;
        replaceGeometry(child, scope, std::move(geometry), true);
        child.edge = faces[k]->edge;
        child.compSelector = selectorName(element.selector);
        child.compIndex = double(k);
        child.compTotal = double(faces.size());
        spawnPart(element.body, std::move(child), frame, ShapeOp::Component, OperationName::Component);
    }
}

void Interpreter::components(const Statement& statement, const ShapeState& state, Frame& frame)
{
    frame.spawned = true;
    if (refuseAsset(statement, state)) return;
    const Geometry& geometry = *state.geometry;
    trouble_.spend(statement.place, cornerCount(geometry));
    const glm::dmat3 objectFromScope = glm::transpose(objectAxes_) * state.scope.axes;
    std::vector<bool> taken(geometry.faces.size(), false);
    for (const BlockElement& element : statement.block->elements) {
        if (trouble_.failed()) return;
        std::vector<const Face*> faces;
        for (size_t k = 0; k < geometry.faces.size(); ++k) {
            const Face& face = geometry.faces[k];
            if (taken[k]) continue;
            bool selected = k == element.selectorIndex;
            if (element.selector != Selector::Index) {
                const glm::dvec3 normal = unitNormal(face.polygon);
                const SelectorFrame reference = frameOf(element.selector);
                selected = selects(element.selector, reference == SelectorFrame::Scope   ? normal
                                                     : reference == SelectorFrame::World ? state.scope.axes * normal
                                                                                         : objectFromScope * normal) &&
                           (face.outer || !isStreet(element.selector));
            }
            if (!selected) continue;
            taken[k] = true;
            faces.push_back(&face);
        }
        spawnFaces(element, faces, state, frame);
    }
}

} // namespace helio::cga
