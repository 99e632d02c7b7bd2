// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/component.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace helio::cga {

namespace {

/// Quadrant of a normal: 0 front, 1 right, 2 back, 3 left, 4 top, 5 bottom.
int quadrant(const glm::dvec3& n)
{
    const std::array<double, 6> components = {n.z, n.x, -n.z, -n.x, n.y, -n.y};
    const double largest = *std::max_element(components.begin(), components.end());
    // Rounding of rotated scopes must not decide a tie.
    const auto first =
        std::find_if(components.begin(), components.end(), [&](double c) { return c >= largest - 1e-9; });
    return int(first - components.begin());
}

} // namespace

bool selects(Selector selector, const glm::dvec3& normal)
{
    const double slope = std::asin(std::clamp(normal.y, -1.0, 1.0)) * 180.0 / M_PI;
    const bool horizontal = std::abs(slope) > 78.75;
    switch (selector) {
    case Selector::Front:
    case Selector::ObjectFront:
    case Selector::StreetFront:
    case Selector::WorldSouth:
        return quadrant(normal) == 0;
    case Selector::Right:
    case Selector::ObjectRight:
    case Selector::StreetRight:
    case Selector::WorldEast:
        return quadrant(normal) == 1;
    case Selector::Back:
    case Selector::ObjectBack:
    case Selector::StreetBack:
    case Selector::WorldNorth:
        return quadrant(normal) == 2;
    case Selector::Left:
    case Selector::ObjectLeft:
    case Selector::StreetLeft:
    case Selector::WorldWest:
        return quadrant(normal) == 3;
    case Selector::Top:
    case Selector::ObjectTop:
    case Selector::WorldUp:
        return quadrant(normal) == 4;
    case Selector::Bottom:
    case Selector::ObjectBottom:
    case Selector::WorldDown:
        return quadrant(normal) == 5;
    case Selector::Side:
    case Selector::ObjectSide:
    case Selector::StreetSide:
    case Selector::WorldSide:
        return !horizontal;
    case Selector::Vertical:
        return std::abs(slope) <= 11.25;
    case Selector::Horizontal:
        return horizontal;
    case Selector::Aslant:
        return slope > 11.25 && slope <= 78.75;
    case Selector::Nutant:
        return slope < -11.25 && slope >= -78.75;
    case Selector::All:
        return true;
    default:
        return false;
    }
}

SelectorFrame frameOf(Selector selector)
{
    if (selector >= Selector::ObjectFront && selector <= Selector::ObjectSide) return SelectorFrame::Object;
    if (selector >= Selector::WorldSouth && selector <= Selector::WorldSide) return SelectorFrame::World;
    return isStreet(selector) ? SelectorFrame::Object : SelectorFrame::Scope;
}

bool isStreet(Selector selector)
{
    return selector >= Selector::StreetFront && selector <= Selector::StreetSide;
}

std::vector<Component> componentsOf(const Geometry& geometry, const std::vector<MeshEdge>& edges, ComponentKind kind,
                                    const glm::dmat3& worldFromScope)
{
    std::vector<glm::dvec3> normals;
    for (const Face& face : geometry.faces) normals.push_back(unitNormal(face.polygon));
    std::vector<Component> components;
    if (kind == ComponentKind::Faces) {
        for (u32 k = 0; k < geometry.faces.size(); ++k) {
            Component component;
            component.normal = normals[k];
            component.edge = geometry.faces[k].edge;
            component.outer = geometry.faces[k].outer;
            component.face = k;
            components.push_back(component);
        }
        for (const MeshEdge& edge : edges)
            if (edge.border) components[edge.face].border = true;
        return components;
    }
    std::vector<glm::dvec3> corners;
    for (const MeshEdge& edge : edges) {
        const glm::dvec3 normal = normals[edge.face], by = edge.to - edge.from;
        Component component;
        component.face = edge.face;
        component.from = edge.from;
        component.to = edge.to;
        component.edge = edge.footprint;
        component.border = edge.border;
        component.outer = edge.outer && geometry.faces[edge.face].outer;
        if (kind == ComponentKind::Vertices) {
            const auto same = [&](const glm::dvec3& p) { return glm::distance(p, edge.from) < 1e-6; };
            if (std::any_of(corners.begin(), corners.end(), same)) continue;
            corners.push_back(edge.from);
            component.to = edge.from;
            components.push_back(component);
            continue;
        }
        if (glm::length(by) < 1e-6) continue;
        const bool shared = kind == ComponentKind::Edges && edge.other != kNoIndex && edge.other != edge.face;
        if (shared && !edge.first) continue;
        component.upward = component.normal = normal;
        if (shared) {
            const glm::dvec3 sum = normal + normals[edge.other];
            if (glm::length(sum) > 1e-3) component.normal = component.upward = glm::normalize(sum);
            const glm::dvec3 other = worldFromScope * normals[edge.other];
            component.roofEdge = roofEdge(worldFromScope * by, worldFromScope * normal, &other);
        } else {
            component.normal = glm::normalize(glm::cross(by, normal)); // out of the face, in its plane
            component.roofEdge = roofEdge(worldFromScope * by, worldFromScope * normal, nullptr);
        }
        components.push_back(component);
    }
    return components;
}

bool selects(Selector selector, u32 selectorIndex, const Component& component, u32 number,
             const SelectorContext& context)
{
    switch (selector) {
    case Selector::Index:
        return number == selectorIndex;
    case Selector::Border:
        return component.border;
    case Selector::Inside:
        return !component.border;
    case Selector::Ridge:
        return component.roofEdge == RoofEdge::Ridge;
    case Selector::Hip:
        return component.roofEdge == RoofEdge::Hip;
    case Selector::Valley:
        return component.roofEdge == RoofEdge::Valley;
    case Selector::Eave:
        return component.roofEdge == RoofEdge::Eave;
    case Selector::All:
        return true;
    default:
        break;
    }
    if (component.normal == glm::dvec3(0.0)) return false;
    if (isStreet(selector)) {
        if (!component.outer) return false;
        if (context.streets)
            return selectsStreet(selector, *context.streets, context.worldFromScope * component.normal, component.edge);
    }
    const SelectorFrame frame = frameOf(selector);
    return selects(selector, frame == SelectorFrame::Scope   ? component.normal
                             : frame == SelectorFrame::World ? context.worldFromScope * component.normal
                                                             : context.objectFromScope * component.normal);
}

Scope edgeScope(const Scope& parent, const Component& component)
{
    Scope scope{parent.toWorld(component.from), parent.axes, glm::dvec3(0.0)};
    const glm::dvec3 by = component.to - component.from;
    if (glm::length(by) < 1e-9) return scope;
    const glm::dvec3 x = glm::normalize(by), y = glm::normalize(component.upward - x * glm::dot(x, component.upward));
    scope.axes = parent.axes * glm::dmat3(x, y, glm::cross(x, y));
    scope.size.x = glm::length(by);
    return scope;
}

std::pair<Scope, Geometry> faceShape(const Scope& parent, const Face& face)
{
    const glm::dvec3 z = unitNormal(face.polygon);
    glm::dvec3 x = face.xAxis - z * glm::dot(z, face.xAxis);
    x = glm::length(x) > 1e-6 ? glm::normalize(x) : planeFrame(z).u;
    const glm::dmat3 axes(x, glm::cross(z, x), z);
    Geometry geometry;
    geometry.faces.push_back(face);
    geometry = transformed(geometry, glm::transpose(axes), face.polygon.outer[0]);
    const auto flatten = [](Ring3& ring) {
        for (glm::dvec3& p : ring) p.z = 0.0;
    };
    flatten(geometry.faces[0].polygon.outer);
    for (Ring3& hole : geometry.faces[0].polygon.holes) flatten(hole);
    Scope scope{parent.toWorld(face.polygon.outer[0]), parent.axes * axes, glm::dvec3(0.0)};
    fitScope(scope, geometry);
    return {scope, geometry};
}

} // namespace helio::cga
