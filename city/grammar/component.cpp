// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/component.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "city/base/check.h"

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
    case Selector::Index:
        break;
    }
    HELIO_CHECK(false, "selector ", int(selector), " has no direction");
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
