// SPDX-License-Identifier: Apache-2.0
#include "city/model/build_nodes.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

#include "city/base/check.h"
#include "city/model/convex_hull.h"
#include "city/model/guillotine.h"
#include "city/model/plane_groups.h"

namespace helio {
namespace {

constexpr double kMinArea = 1e-8; // m2: less is no surface
constexpr double kTiling = 1e-5;  // relative area defect of a tiling node

/// A node before it has its final number.
struct RawNode
{
    Node node;
    std::vector<u32> children; // raw indices
    u32 patch = kNoIndex;
    bool sealed = false; // the face of a solid: its plane is not merged with a neighbour's
};

class Builder
{
public:
    Builder(const ShapeTree& shapes, std::span<const AssetSummary> assets) : shapes_(shapes), assets_(assets)
    {
        HELIO_CHECK(assets.size() == shapes.assets.size(), assets.size(), " asset summaries, ", shapes.assets.size(),
                    " assets");
    }

    NodeTreeBuild build()
    {
        linkShapes();
        const size_t count = shapes_.shapes.size();
        itemsOf_.resize(count);
        patchesOf_.resize(count);
        // Patches first, in the order of derivation: their numbers are the ids.
        for (u32 i = 0; i < count; ++i) makePatches(i);
        for (u32 i = u32(count); i-- > 0;) gather(i);
        number();
        placeInstances();
        build_.tree.names = shapes_.names;
        build_.tree.buildingIds = shapes_.buildingIds;
        for (const Surface& surface : shapes_.surfaces) build_.tree.surfaceNames.push_back(surface.name);
        return std::move(build_);
    }

private:
    void linkShapes()
    {
        const size_t count = shapes_.shapes.size();
        childBegin_.assign(count + 1, 0);
        for (u32 i = 0; i < count; ++i) {
            const u32 parent = shapes_.shapes[i].parent;
            HELIO_CHECK(parent == kNoIndex || parent < i, "shape ", i, " comes before its parent ", parent);
            if (parent != kNoIndex) ++childBegin_[parent + 1];
        }
        std::partial_sum(childBegin_.begin(), childBegin_.end(), childBegin_.begin());
        childShapes_.resize(childBegin_[count]);
        std::vector<u32> next(childBegin_.begin(), childBegin_.end() - 1);
        for (u32 i = 0; i < count; ++i)
            if (const u32 parent = shapes_.shapes[i].parent; parent != kNoIndex) childShapes_[next[parent]++] = i;
    }

    std::span<const u32> childrenOf(u32 shape) const
    {
        return {childShapes_.data() + childBegin_[shape], childBegin_[shape + 1] - childBegin_[shape]};
    }

    /// One patch for each plane that the leaf's polygons lie in.
    void makePatches(u32 shapeIndex)
    {
        const Shape& shape = shapes_.shapes[shapeIndex];
        std::vector<u32> polygons;
        std::vector<PlaneItem> planes;
        for (u32 p = shape.polygonBegin; p < shape.polygonBegin + shape.polygonCount; ++p) {
            const Polygon3& polygon = shapes_.polygons[p];
            if (area(polygon) >= kMinArea) {
                polygons.push_back(p);
                planes.push_back({unitNormal(polygon), polygon.outer[0]});
            } else {
                ++build_.degenerateCount;
            }
        }
        std::vector<u32>& items = itemsOf_[shapeIndex];
        for (std::vector<u32>& group : groupByPlane(planes)) {
            const glm::dvec3 normal = planes[group[0]].normal;
            for (u32& member : group) member = polygons[member];
            items.push_back(makePatch(shape, group, normal));
        }
        for (const u32 item : items) patchesOf_[shapeIndex].push_back(raw_[item].patch);
        if (items.size() > 1) items = {makeCluster(shape, items)};
    }

    u32 makePatch(const Shape& shape, std::span<const u32> polygons, const glm::dvec3& normal)
    {
        NodeTree& tree = build_.tree;
        Patch patch;
        patch.building = shape.building;
        patch.sourceFace = shape.sourceFace;
        patch.surface = shape.surface;
        if (shape.surface != kNoIndex) {
            patch.rho = shapes_.surfaces[shape.surface].rho;
            patch.emission = shapes_.surfaces[shape.surface].emission;
        }
        if (shape.placement == AssetPlacement::Fill) {
            patch.asset = shape.asset;
            patch.rho = assets_[shape.asset].rho;
        }
        RawNode raw;
        raw.node.ringBegin = u32(tree.rings.size());
        for (const u32 p : polygons) {
            const Polygon3& polygon = shapes_.polygons[p];
            const double polygonArea = area(polygon);
            patch.area += polygonArea;
            raw.node.centroid += polygonArea * centroid(polygon);
            tree.rings.push_back(polygon.outer);
            tree.ringIsHole.push_back(0);
            for (const Ring3& hole : polygon.holes) {
                tree.rings.push_back(hole);
                tree.ringIsHole.push_back(1);
            }
        }
        raw.node.ringCount = u32(tree.rings.size()) - raw.node.ringBegin;
        raw.node.centroid /= patch.area;
        raw.node.area = patch.area;
        raw.node.normal = normal;
        raw.node.building = shape.building;
        raw.node.name = shape.name;
        raw.patch = tree.patchCount();
        tree.patches.push_back(patch);
        raw_.push_back(std::move(raw));
        return u32(raw_.size()) - 1;
    }

    u32 makeParent(const Shape& shape, std::vector<u32> children)
    {
        RawNode raw;
        raw.node.building = shape.building;
        raw.node.name = shape.name;
        for (const u32 child : children) {
            raw.node.area += raw_[child].node.area;
            raw.node.centroid += raw_[child].node.area * raw_[child].node.centroid;
            raw.node.height = std::max(raw.node.height, raw_[child].node.height + 1);
        }
        raw.node.centroid /= raw.node.area;
        raw.children = std::move(children);
        raw_.push_back(std::move(raw));
        return u32(raw_.size()) - 1;
    }

    u32 makeCluster(const Shape& shape, std::vector<u32> children)
    {
        const u32 index = makeParent(shape, std::move(children));
        raw_[index].node.kind = NodeKind::Cluster;
        raw_[index].node.coverage = 0.0;
        return index;
    }

    /// A planar node over coplanar children: its outline is their convex hull.
    u32 makePlanar(const Shape& shape, std::vector<u32> children, const PlaneFrame& frame)
    {
        NodeTree& tree = build_.tree;
        std::vector<glm::dvec2> points;
        const glm::dvec3 origin = raw_[children[0]].node.centroid;
        for (const u32 child : children)
            for (u32 r = 0; r < raw_[child].node.ringCount; ++r)
                for (const glm::dvec3& q : tree.rings[raw_[child].node.ringBegin + r])
                    points.emplace_back(glm::dot(q - origin, frame.u), glm::dot(q - origin, frame.v));
        const Ring2 hull = convexHull(points);
        const u32 index = makeParent(shape, std::move(children));
        Node& node = raw_[index].node;
        node.normal = frame.normal;
        node.coverage = node.area / signedArea(hull);
        const double excess = node.coverage - 1.0;
        node.kind = std::abs(excess) <= kTiling ? NodeKind::Tiling : NodeKind::PlanarPartial;
        if (excess > kTiling) ++build_.overlapCount; // More area than the hull has: children lie on each other.
        const double defect = node.kind == NodeKind::Tiling ? std::abs(excess) : std::max(excess, 0.0);
        build_.areaDefect = std::max(build_.areaDefect, defect);
        node.ringBegin = u32(tree.rings.size());
        node.ringCount = 1;
        Ring3 ring;
        for (const glm::dvec2& h : hull) ring.push_back(origin + h.x * frame.u + h.y * frame.v);
        tree.rings.push_back(std::move(ring));
        tree.ringIsHole.push_back(0);
        return index;
    }

    u32 balance(const Shape& shape, std::span<PlaneBox> boxes, const PlaneFrame& frame)
    {
        if (boxes.size() == 1) return boxes[0].item;
        const u32 cut = guillotineCut(boxes);
        const u32 lower = balance(shape, boxes.first(cut), frame);
        const u32 upper = balance(shape, boxes.subspan(cut), frame);
        return makePlanar(shape, {lower, upper}, frame);
    }

    /// Binary planar tree over the coplanar items of one shape.
    u32 makePlane(const Shape& shape, std::span<const u32> items)
    {
        const PlaneFrame frame = planeFrame(raw_[items[0]].node.normal);
        const glm::dvec3 origin = raw_[items[0]].node.centroid;
        std::vector<PlaneBox> boxes;
        for (const u32 item : items) {
            PlaneBox box{glm::dvec2(1e300), glm::dvec2(-1e300), raw_[item].node.area, item};
            for (u32 r = 0; r < raw_[item].node.ringCount; ++r)
                for (const glm::dvec3& q : build_.tree.rings[raw_[item].node.ringBegin + r]) {
                    const glm::dvec2 p(glm::dot(q - origin, frame.u), glm::dot(q - origin, frame.v));
                    box.lower = glm::min(box.lower, p);
                    box.upper = glm::max(box.upper, p);
                }
            boxes.push_back(box);
        }
        return balance(shape, boxes, frame);
    }

    /// Collects the items of a shape from its children and makes planar nodes of the coplanar ones. What is left passes
    /// on to the parent, up to the face of a solid or the root of a building.
    void gather(u32 shapeIndex)
    {
        const Shape& shape = shapes_.shapes[shapeIndex];
        std::vector<u32>& items = itemsOf_[shapeIndex];
        for (const u32 child : childrenOf(shapeIndex)) {
            items.insert(items.end(), itemsOf_[child].begin(), itemsOf_[child].end());
            itemsOf_[child] = {};
        }
        if (items.size() > 1 && shape.op != ShapeOp::Root) items = mergePlanes(shape, items);
        if (shape.op != ShapeOp::Component && shape.parent != kNoIndex) return;
        if (items.size() > 1) items = {makeCluster(shape, items)};
        if (!items.empty()) raw_[items[0]].sealed = true;
    }

    /// Faces of solids and clusters stay as they are, the others become one item for each plane.
    std::vector<u32> mergePlanes(const Shape& shape, const std::vector<u32>& items)
    {
        std::vector<PlaneItem> planes;
        for (const u32 item : items) {
            const RawNode& raw = raw_[item];
            planes.push_back({raw.node.normal, raw.node.centroid, raw.sealed || raw.node.kind == NodeKind::Cluster});
        }
        std::vector<u32> merged;
        for (std::vector<u32>& group : groupByPlane(planes)) {
            for (u32& member : group) member = items[member];
            merged.push_back(group.size() == 1 ? group[0] : makePlane(shape, group));
        }
        return merged;
    }

    /// Leaves get their patch's number, inner nodes follow by rising height.
    void number()
    {
        NodeTree& tree = build_.tree;
        std::vector<u32> order(raw_.size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), [&](u32 a, u32 b) {
            const u32 ha = raw_[a].node.height, hb = raw_[b].node.height;
            return ha != hb ? ha < hb : ha == 0 && raw_[a].patch < raw_[b].patch;
        });
        std::vector<u32> numberOf(raw_.size());
        for (u32 i = 0; i < order.size(); ++i) numberOf[order[i]] = i;
        tree.nodes.resize(raw_.size());
        for (u32 i = 0; i < order.size(); ++i) {
            const RawNode& raw = raw_[order[i]];
            Node& node = tree.nodes[i];
            const u32 parent = node.parent;
            node = raw.node;
            node.parent = parent;
            node.childBegin = u32(tree.children.size());
            node.childCount = u32(raw.children.size());
            for (const u32 child : raw.children) {
                tree.children.push_back(numberOf[child]);
                tree.nodes[numberOf[child]].parent = i;
            }
        }
    }

    void placeInstances()
    {
        for (u32 i = 0; i < shapes_.shapes.size(); ++i) {
            const Shape& shape = shapes_.shapes[i];
            if (shape.placement == AssetPlacement::None) continue;
            u32 patch = kNoIndex;
            if (shape.placement == AssetPlacement::Overlay)
                patch = patchBehind(i);
            else if (!patchesOf_[i].empty())
                patch = patchesOf_[i][0];
            if (patch == kNoIndex)
                ++build_.orphanOverlayCount;
            else
                build_.instances.push_back({shape.asset, patch, shape.worldFromAsset});
        }
        std::stable_sort(build_.instances.begin(), build_.instances.end(),
                         [](const AssetInstance& a, const AssetInstance& b) { return a.asset < b.asset; });
    }

    /// The patch whose light an overlay takes: the one behind its centre, in the smallest subtree around it that has
    /// one.
    u32 patchBehind(u32 shapeIndex) const
    {
        const Shape& shape = shapes_.shapes[shapeIndex];
        const glm::dvec3 centre = shape.worldFromAsset * glm::dvec4(assets_[shape.asset].boxCentre, 1.0);
        u32 best = kNoIndex;
        double bestScore = 1e300;
        for (u32 ancestor = shape.parent; ancestor != kNoIndex && bestScore > 0.5;
             ancestor = shapes_.shapes[ancestor].parent)
            searchBehind(ancestor, centre, best, bestScore);
        return best;
    }

    void searchBehind(u32 shapeIndex, const glm::dvec3& centre, u32& best, double& bestScore) const
    {
        for (const u32 patch : patchesOf_[shapeIndex]) {
            const Node& node = build_.tree.nodes[patch];
            const double height = glm::dot(centre - node.centroid, node.normal);
            // In-plane distance from the patch's bounding rectangle counts most, then the distance along the normal.
            const PlaneFrame frame = planeFrame(node.normal);
            glm::dvec2 lower(1e300), upper(-1e300);
            for (const Ring3& ring : build_.tree.outlineOf(patch))
                for (const glm::dvec3& q : ring) {
                    const glm::dvec2 p(glm::dot(q - centre, frame.u), glm::dot(q - centre, frame.v));
                    lower = glm::min(lower, p);
                    upper = glm::max(upper, p);
                }
            const glm::dvec2 outside = glm::max(glm::max(lower, -upper), glm::dvec2(0.0));
            const double score = glm::length(outside) + (height < -0.01 ? 100.0 - height : 0.1 * height);
            if (score < bestScore) {
                bestScore = score;
                best = patch;
            }
        }
        for (const u32 child : childrenOf(shapeIndex)) searchBehind(child, centre, best, bestScore);
    }

    const ShapeTree& shapes_;
    std::span<const AssetSummary> assets_;
    NodeTreeBuild build_;
    std::vector<RawNode> raw_;
    std::vector<u32> childBegin_, childShapes_;
    std::vector<std::vector<u32>> itemsOf_;   // raw nodes that a shape hands to its parent
    std::vector<std::vector<u32>> patchesOf_; // patches of a leaf shape
};

} // namespace

NodeTreeBuild buildNodes(const ShapeTree& shapes, std::span<const AssetSummary> assets)
{
    return Builder(shapes, assets).build();
}

} // namespace helio
