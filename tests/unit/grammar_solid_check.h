// SPDX-License-Identifier: Apache-2.0
// Checks in space over what a derivation made: assets as boxes, and what leaves look at.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "city/grammar/derive.h"
#include "city/model/shape_tree.h"

namespace helio::test {

/// The box of an asset where it stands, cut by its trim planes: the half-spaces n.p + d >= 0 and its six sides.
struct SolidBox
{
    std::string what;
    u32 shape = 0;
    glm::dvec3 low{0.0}, high{0.0}; ///< of the whole box, m, world
    std::vector<glm::dvec4> planes; ///< unit normals, into the box
    std::vector<std::vector<glm::dvec3>> sides;
    std::string where() const;
};

/// All assets of a derivation; `assetBox` as in DeriveOptions.
std::vector<SolidBox> assetBoxes(const ShapeTree& tree,
                                 const std::function<Result<AssetBox>(const std::string&)>& assetBox);

/// True if a polygon of another leaf comes within `reach` metres of the box.
bool touches(const SolidBox& box, const ShapeTree& tree, double reach);

/// True if two boxes share a region that is deeper than `depth` metres.
bool overlap(const SolidBox& a, const SolidBox& b, double depth);

/// True if a point lies on a polygon whose normal is that of `normal`.
bool liesOnALeaf(const ShapeTree& tree, const glm::dvec3& point, const glm::dvec3& normal);

/// Names the leaves from whose middles a ray along the normal meets the back of another leaf first; empty if none does.
std::string leavesThatSeeABack(const ShapeTree& tree);

/// Edges of a shape's polygons that are not used once in each direction.
size_t openEdges(const ShapeTree& tree, const Shape& shape);

} // namespace helio::test
