// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "city/grammar/geometry.h"
#include "city/grammar/vocabulary.h"
#include "city/model/footprint.h"

namespace helio::cga {

/// Where the streets around a footprint lie.
struct StreetSides
{
    std::vector<bool> onStreet;      ///< per edge of the outer ring
    std::vector<glm::dvec3> normals; ///< of the edges on streets; building frame, outward, level
    glm::dvec3 front{0.0};           ///< their mean, weighted by length: what left and right refer to
};

/// None if no edge is known to lie on a street.
std::optional<StreetSides> streetSides(const Footprint& footprint);

/// True if the street form selects a wall or edge with this outward normal (building frame). front: it stands on an
/// edge at a street, or on no edge of the footprint and faces one within 30 degrees. back: of the others, those that
/// face away from a street within 45 degrees (ties included); right and left: the rest, as seen from the mean street
/// direction. side: left and right. Level components face no street. `edge`: of the footprint, or kNoIndex.
bool selectsStreet(Selector selector, const StreetSides& sides, const glm::dvec3& normal, u32 edge);

} // namespace helio::cga
