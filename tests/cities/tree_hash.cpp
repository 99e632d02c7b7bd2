// SPDX-License-Identifier: Apache-2.0
#include "tests/cities/tree_hash.h"

#include <bit>
#include <string_view>

#include "city/base/hash.h"

namespace helio {
namespace {

/// Fields one by one: bytes between them are not the same from run to run.
struct Hasher
{
    u64 value = 0;

    template <typename... Numbers> void add(Numbers... numbers) { ((value = mixSeed(value, u64(numbers))), ...); }
    void add(double number) { add(std::bit_cast<u64>(number)); }
    void add(const glm::dvec3& v)
    {
        for (int k = 0; k < 3; ++k) add(v[k]);
    }
    void add(const glm::dvec4& v)
    {
        for (int k = 0; k < 4; ++k) add(v[k]);
    }
    void add(const glm::dmat4x3& m)
    {
        for (int k = 0; k < 4; ++k) add(m[k]);
    }
    void add(const std::vector<std::string>& texts)
    {
        for (const std::string& text : texts) value = hashText(text, value);
    }
    void add(const Ring3& ring)
    {
        add(ring.size());
        for (const glm::dvec3& corner : ring) add(corner);
    }
};

} // namespace

u64 hashOf(const ShapeTree& shapes)
{
    Hasher hasher;
    hasher.add(shapes.names);
    hasher.add(shapes.assets);
    hasher.add(shapes.buildingIds);
    for (const Surface& surface : shapes.surfaces) {
        hasher.value = hashText(surface.name, hasher.value);
        hasher.add(surface.rho);
        hasher.add(surface.emission);
    }
    for (const Shape& s : shapes.shapes) {
        hasher.add(s.parent, s.name, s.building, s.op, s.child, s.covered, s.polygonBegin, s.polygonCount, s.surface,
                   s.sourceFace, s.asset, s.placement, s.trimBegin, s.trimCount);
        if (s.placement != AssetPlacement::None) hasher.add(s.worldFromAsset);
    }
    for (const Polygon3& polygon : shapes.polygons) {
        hasher.add(polygon.outer);
        for (const Ring3& hole : polygon.holes) hasher.add(hole);
    }
    for (const glm::dvec4& plane : shapes.trimPlanes) hasher.add(plane);
    return hasher.value;
}

u64 hashOf(const NodeTreeBuild& build)
{
    Hasher hasher;
    for (const Patch& p : build.tree.patches) {
        hasher.add(p.building, p.surface, p.key, p.covered);
        hasher.add(p.area);
        hasher.add(p.rho);
        hasher.add(p.emission);
    }
    for (const Node& n : build.tree.nodes) {
        hasher.add(n.parent, n.childBegin, n.childCount, n.height, n.kind, n.building, n.name, n.covered, n.ringBegin,
                   n.ringCount);
        hasher.add(n.area);
        hasher.add(n.centroid);
        hasher.add(n.normal);
    }
    for (const u32 child : build.tree.children) hasher.add(child);
    for (const Ring3& ring : build.tree.rings) hasher.add(ring);
    for (const AssetInstance& instance : build.instances) {
        hasher.add(instance.asset, instance.patch, instance.piece, instance.trimBegin, instance.trimCount);
        hasher.add(instance.worldFromAsset);
    }
    return hasher.value;
}

} // namespace helio
