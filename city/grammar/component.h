// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/grammar/geometry.h"
#include "city/grammar/vocabulary.h"

namespace helio::cga {

/// True if a face with this unit normal (in the axes that the selector refers to: scope, object or world) is selected.
/// Quadrants (front +z, right +x, back -z, left -x, top +y, bottom -y) go by the largest component; ties at 45 degrees
/// are decided in that order. horizontal: more than 78.75 degrees of slope, vertical: at most 11.25, aslant and nutant
/// (overhanging) between; side: not horizontal. Precondition: not Index.
bool selects(Selector selector, const glm::dvec3& normal);

/// Which axes a selector refers to.
enum class SelectorFrame : u8
{
    Scope,
    Object,
    World
};
SelectorFrame frameOf(Selector selector);
/// The street forms select only faces on the outer ring: a courtyard has no street.
bool isStreet(Selector selector);

/// A shape of its own for one face: x along its first edge, z its normal, origin at its lower corner, sz = 0.
std::pair<Scope, Geometry> faceShape(const Scope& parent, const Face& face);

} // namespace helio::cga
