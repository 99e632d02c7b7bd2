// SPDX-License-Identifier: Apache-2.0
#include "city/model/build_nodes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

#include "city/base/check.h"
#include "city/base/hash.h"
#include "city/model/convex_hull.h"
#include "city/model/guillotine.h"
#include "city/model/join_polygons.h"
#include "city/model/overlay_search.h"
#include "city/model/plane_groups.h"

namespace helio {
namespace {

constexpr double kTiling = 1e-5; // relative area defect of a tiling node
constexpr u32 kSlackDepth = 4;   // levels above twice the depth of a balanced tree from which on it is built anew

/// A node before it has its final number; its children lie in the builder's list.
struct RawNode
{
    Node node;
    u32 patch = kNoIndex;
    bool sealed = false; // the face of a solid: its plane is not merged with a neighbour's
    bool dead = false;   // replaced by another
};

class Builder
{
public:
    /// `spent`: the same shapes, if their polygons may be taken; else null.
    Builder(const ShapeTree& shapes, ShapeTree* spent, std::span<const AssetSummary> assets, const NodeOptions& options)
        : shapes_(shapes), spent_(spent), assets_(assets), treeShape_(options.tree)
    {
        HELIO_CHECK(assets.size() == shapes.assets.size(), assets.size(), " asset summaries, ", shapes.assets.size(),
                    " assets");
        for (u32 i = 0; i < shapes.shapes.size(); ++i) {
            const u32 parent = shapes.shapes[i].parent;
            HELIO_CHECK(parent == kNoIndex || parent < i, "shape ", i, " comes before its parent ", parent);
        }
        cells_ = makeCells(shapes, options);
    }

    NodeTreeBuild build()
    {
        build_.degenerateCount = cells_.degenerateCount;
        build_.stripCount = cells_.stripCount;
        build_.mergedCount = cells_.mergedCount;
        build_.sliverCount = cells_.sliverCount;
        const size_t count = shapes_.shapes.size();
        itemsOf_.resize(count);
        makeKeys();
        // Patches first, in the order of derivation: their numbers are the ids.
        patchOfPiece_.resize(cells_.pieces.size());
        for (u32 c = 0; c < cells_.cells.size(); ++c)
            if (cells_.cells[c].alive) itemsOf_[cells_.cells[c].owner].push_back(makePatch(c));
        // Whole cities are built at once: what is no longer needed goes.
        release(cells_.cells);
        release(cells_.polygonRefs);
        release(cells_.cut);
        release(keys_);
        if (spent_ != nullptr) release(spent_->polygons);
        for (u32 i = u32(count); i-- > 0;) gather(i);
        release(itemsOf_);
        number();
        release(raw_);
        release(children_);
        placeInstances();
        build_.tree.names = shapes_.names;
        build_.tree.buildingIds = shapes_.buildingIds;
        for (const Surface& surface : shapes_.surfaces) build_.tree.surfaceNames.push_back(surface.name);
        return std::move(build_);
    }

private:
    template <typename T> static void release(std::vector<T>& vector) { std::vector<T>().swap(vector); }

    /// A shape's key is the hash of its building's id and the child numbers on the way to it.
    void makeKeys()
    {
        keys_.resize(shapes_.shapes.size());
        for (u32 i = 0; i < keys_.size(); ++i) {
            const Shape& shape = shapes_.shapes[i];
            if (shape.parent != kNoIndex)
                keys_[i] = mixSeed(keys_[shape.parent], shape.child);
            else
                keys_[i] =
                    shape.building < shapes_.buildingIds.size() ? hashText(shapes_.buildingIds[shape.building]) : i;
        }
    }

    void addRings(Polygon3 polygon)
    {
        NodeTree& tree = build_.tree;
        tree.rings.push_back(std::move(polygon.outer));
        tree.ringIsHole.push_back(0);
        for (Ring3& hole : polygon.holes) {
            tree.rings.push_back(std::move(hole));
            tree.ringIsHole.push_back(1);
        }
    }

    /// A polygon of the cells, for the last time.
    Polygon3 takePolygon(u32 ref)
    {
        const size_t derived = shapes_.polygons.size();
        if (ref >= derived) return std::move(cells_.cut[ref - derived]);
        return spent_ != nullptr ? std::move(spent_->polygons[ref]) : shapes_.polygons[ref];
    }

    u32 makePatch(u32 cellIndex)
    {
        NodeTree& tree = build_.tree;
        const PatchCell& cell = cells_.cells[cellIndex];
        const Shape& first = shapes_.shapes[cells_.pieces[cell.firstPiece].shape];
        Patch patch;
        patch.building = first.building;
        patch.sourceFace = first.sourceFace;
        patch.surface = first.surface;
        patch.covered = cell.covered;
        patch.key = mixSeed(keys_[cells_.pieces[cellIndex].shape], cell.ordinal); // Cell i was made for piece i.
        RawNode raw;
        Node& node = raw.node;
        u32 largest = cell.firstPiece;
        const size_t firstDrawn = build_.pieces.size();
        for (u32 p = cell.firstPiece; p != kNoIndex; p = cells_.pieces[p].next) {
            if (cells_.pieces[p].area > cells_.pieces[largest].area) largest = p;
            addPiece(p, patch, node);
        }
        patch.surface = shapes_.shapes[cells_.pieces[largest].shape].surface;
        // Equal parts keep their reflectance to the last bit.
        const bool equal = std::all_of(build_.pieces.begin() + std::ptrdiff_t(firstDrawn), build_.pieces.end(),
                                       [&](const DrawnPiece& d) { return d.rho == build_.pieces[firstDrawn].rho; });
        patch.rho = equal ? build_.pieces[firstDrawn].rho : patch.rho / patch.area;
        patch.emission /= patch.area;
        node.centroid /= patch.area;
        const DrawnPiece& piece = build_.pieces.back();
        node.ringBegin = piece.ringBegin;
        node.ringCount = piece.ringCount;
        if (cell.firstPiece != cell.lastPiece) joinOutline(firstDrawn, cell.normal, node);
        node.area = patch.area;
        node.normal = cell.normal;
        node.building = first.building;
        node.name = first.name;
        node.covered = cell.covered;
        if (cell.covered) {
            ++build_.coveredPatchCount;
            build_.coveredArea += patch.area;
        }
        raw.patch = tree.patchCount();
        tree.patches.push_back(patch);
        raw_.push_back(raw);
        return u32(raw_.size()) - 1;
    }

    /// Draws a piece and adds its share to the patch's sums.
    void addPiece(u32 p, Patch& patch, Node& node)
    {
        NodeTree& tree = build_.tree;
        const PatchPiece& piece = cells_.pieces[p];
        const Shape& shape = shapes_.shapes[piece.shape];
        glm::dvec4 rho(0.0), emission(0.0);
        if (shape.surface != kNoIndex) {
            rho = shapes_.surfaces[shape.surface].rho;
            emission = shapes_.surfaces[shape.surface].emission;
        }
        DrawnPiece drawn;
        if (shape.placement == AssetPlacement::Fill) {
            drawn.asset = shape.asset;
            rho = assets_[shape.asset].rho;
        }
        drawn.patch = patchOfPiece_[p] = tree.patchCount();
        drawn.rho = rho;
        drawn.ringBegin = u32(tree.rings.size());
        for (u32 r = piece.polygonBegin; r < piece.polygonBegin + piece.polygonCount; ++r) {
            Polygon3 polygon = takePolygon(cells_.polygonRefs[r]);
            node.centroid += area(polygon) * centroid(polygon);
            addRings(std::move(polygon));
        }
        drawn.ringCount = u32(tree.rings.size()) - drawn.ringBegin;
        patch.area += piece.area;
        patch.rho += piece.area * rho;
        patch.emission += piece.area * emission;
        if (shape.placement == AssetPlacement::Fill) pieceOfShape_.emplace_back(piece.shape, u32(build_.pieces.size()));
        build_.pieces.push_back(drawn);
    }

    /// The outline of several pieces, drawn ones from `firstDrawn` on: their union.
    void joinOutline(size_t firstDrawn, const glm::dvec3& normal, Node& node)
    {
        const NodeTree& tree = build_.tree;
        std::vector<Polygon3> polygons;
        for (size_t r = build_.pieces[firstDrawn].ringBegin; r < tree.rings.size(); ++r) {
            if (tree.ringIsHole[r] == 0)
                polygons.push_back({tree.rings[r], {}});
            else
                polygons.back().holes.push_back(tree.rings[r]);
        }
        node.ringBegin = u32(tree.rings.size());
        for (Polygon3& polygon : joinPolygons(polygons, normal)) addRings(std::move(polygon));
        node.ringCount = u32(tree.rings.size()) - node.ringBegin;
    }

    std::span<const u32> childrenOf(const RawNode& raw) const
    {
        return {children_.data() + raw.node.childBegin, raw.node.childCount};
    }

    u32 makeParent(const Shape& shape, std::span<const u32> children)
    {
        RawNode raw;
        raw.node.building = shape.building;
        raw.node.name = shape.name;
        raw.node.covered = true;
        for (const u32 child : children) {
            const Node& node = raw_[child].node;
            raw.node.area += node.area;
            raw.node.centroid += node.area * node.centroid;
            raw.node.height = std::max(raw.node.height, node.height + 1);
            raw.node.covered = raw.node.covered && node.covered;
        }
        raw.node.centroid /= raw.node.area;
        raw.node.childBegin = u32(children_.size());
        raw.node.childCount = u32(children.size());
        children_.insert(children_.end(), children.begin(), children.end());
        raw_.push_back(raw);
        return u32(raw_.size()) - 1;
    }

    u32 makeCluster(const Shape& shape, std::span<const u32> children)
    {
        const u32 index = makeParent(shape, children);
        raw_[index].node.kind = NodeKind::Cluster;
        raw_[index].node.coverage = 0.0;
        raw_[index].node.covered = false;
        return index;
    }

    /// A planar node over coplanar children: its outline is their convex hull.
    u32 makePlanar(const Shape& shape, std::span<const u32> children, const PlaneFrame& frame)
    {
        NodeTree& tree = build_.tree;
        std::vector<glm::dvec2> points;
        const glm::dvec3 origin = raw_[children[0]].node.centroid;
        for (const u32 child : children)
            for (u32 r = 0; r < raw_[child].node.ringCount; ++r)
                for (const glm::dvec3& q : tree.rings[raw_[child].node.ringBegin + r])
                    points.emplace_back(glm::dot(q - origin, frame.u), glm::dot(q - origin, frame.v));
        const Ring2 hull = convexHull(points);
        const u32 index = makeParent(shape, children);
        Node& node = raw_[index].node;
        node.normal = frame.normal;
        node.coverage = node.area / signedArea(hull);
        node.kind = std::abs(node.coverage - 1.0) <= kTiling ? NodeKind::Tiling : NodeKind::PlanarPartial;
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
        const u32 pair[2] = {balance(shape, boxes.first(cut), frame), balance(shape, boxes.subspan(cut), frame)};
        return makePlanar(shape, pair, frame);
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
        // Children hand their items up last one first.
        const bool own = cells_.pieceRow[shapeIndex] != cells_.pieceRow[shapeIndex + 1];
        if (!own) std::reverse(items.begin(), items.end());
        if (items.size() > 1 && (shape.op != ShapeOp::Root || own) && treeShape_ != TreeShape::Faces)
            items = mergePlanes(shape, items);
        if (cells_.isSolid[shapeIndex] != 0 && items.size() > 1) items = {makeCluster(shape, items)};
        if (shape.op != ShapeOp::Component && shape.parent != kNoIndex) {
            std::vector<u32>& above = itemsOf_[shape.parent];
            above.insert(above.end(), items.rbegin(), items.rend());
            items = {};
            return;
        }
        for (u32& item : items) item = flatter(shape, item);
        if (items.size() > 1) items = {makeCluster(shape, items)};
        if (!items.empty()) raw_[items[0]].sealed = true;
        if (shape.parent == kNoIndex || items.empty()) return;
        itemsOf_[shape.parent].push_back(items[0]);
        items = {};
    }

    /// Faces of solids and clusters stay as they are, the others become one item for each plane.
    std::vector<u32> mergePlanes(const Shape& shape, const std::vector<u32>& items)
    {
        std::vector<PlaneItem> planes;
        for (const u32 item : items) {
            const RawNode& raw = raw_[item];
            planes.push_back({raw.node.normal, raw.node.centroid, raw.sealed || raw.node.kind == NodeKind::Cluster,
                              raw.node.covered ? 1u : 0u});
        }
        std::vector<u32> merged;
        for (std::vector<u32>& group : groupByPlane(planes)) {
            for (u32& member : group) member = items[member];
            merged.push_back(group.size() == 1 ? group[0] : makePlane(shape, group));
        }
        return merged;
    }

    /// A planar node that recursive rules made deep as one balanced tree over the same leaves, with TreeShape::Free any
    /// planar node; else the node itself.
    u32 flatter(const Shape& shape, u32 item)
    {
        if (raw_[item].sealed || raw_[item].node.kind == NodeKind::Cluster) return item;
        std::vector<u32> leaves, inner, stack{item};
        while (!stack.empty()) {
            const u32 at = stack.back();
            stack.pop_back();
            const std::span<const u32> children = childrenOf(raw_[at]);
            (children.empty() ? leaves : inner).push_back(at);
            stack.insert(stack.end(), children.rbegin(), children.rend());
        }
        const u32 deep = treeShape_ == TreeShape::Free ? 1 : 2 * u32(std::bit_width(leaves.size())) + kSlackDepth;
        if (raw_[item].node.height <= deep) return item;
        for (const u32 node : inner) raw_[node].dead = true;
        return makePlane(shape, leaves);
    }

    /// Leaves get their patch's number, inner nodes follow by rising height.
    void number()
    {
        NodeTree& tree = build_.tree;
        std::vector<u32> order;
        for (u32 i = 0; i < raw_.size(); ++i)
            if (!raw_[i].dead) order.push_back(i);
        std::stable_sort(order.begin(), order.end(), [&](u32 a, u32 b) {
            const u32 ha = raw_[a].node.height, hb = raw_[b].node.height;
            return ha != hb ? ha < hb : ha == 0 && raw_[a].patch < raw_[b].patch;
        });
        std::vector<u32> numberOf(raw_.size(), kNoIndex);
        for (u32 i = 0; i < order.size(); ++i) numberOf[order[i]] = i;
        tree.nodes.resize(order.size());
        for (u32 i = 0; i < order.size(); ++i) {
            const RawNode& raw = raw_[order[i]];
            Node& node = tree.nodes[i];
            const u32 parent = node.parent;
            node = raw.node;
            node.parent = parent;
            node.childBegin = u32(tree.children.size());
            for (const u32 child : childrenOf(raw)) {
                tree.children.push_back(numberOf[child]);
                tree.nodes[numberOf[child]].parent = i;
            }
            audit(node);
        }
    }

    void audit(const Node& node)
    {
        if (node.kind == NodeKind::Cluster || node.childCount == 0) return;
        const double excess = node.coverage - 1.0;
        if (excess > kTiling) ++build_.overlapCount; // More area than the hull has: children lie on each other.
        const double defect = node.kind == NodeKind::Tiling ? std::abs(excess) : std::max(excess, 0.0);
        build_.areaDefect = std::max(build_.areaDefect, defect);
    }

    void placeInstances()
    {
        build_.trimPlanes = shapes_.trimPlanes;
        OverlaySearch search(shapes_, cells_, build_.tree, patchOfPiece_);
        std::sort(pieceOfShape_.begin(), pieceOfShape_.end());
        for (u32 i = 0; i < shapes_.shapes.size(); ++i) {
            const Shape& shape = shapes_.shapes[i];
            if (shape.placement == AssetPlacement::None) continue;
            AssetInstance instance{shape.asset, kNoIndex, shape.worldFromAsset, kNoIndex, 0, 0};
            if (shape.placement == AssetPlacement::Overlay) {
                const glm::dvec3 centre = shape.worldFromAsset * glm::dvec4(assets_[shape.asset].boxCentre, 1.0);
                instance.patch = search.patchBehind(i, centre);
            } else {
                const auto own = std::lower_bound(pieceOfShape_.begin(), pieceOfShape_.end(), std::pair(i, 0u));
                if (own != pieceOfShape_.end() && own->first == i) {
                    instance.piece = own->second;
                    instance.patch = build_.pieces[own->second].patch;
                }
            }
            HELIO_CHECK(shape.trimCount == 0 || size_t(shape.trimBegin) + shape.trimCount <= shapes_.trimPlanes.size(),
                        "shape ", i, ": trim planes ", shape.trimBegin, " + ", shape.trimCount);
            instance.trimBegin = shape.trimBegin;
            instance.trimCount = shape.trimCount;
            if (instance.patch == kNoIndex)
                ++build_.orphanOverlayCount;
            else
                build_.instances.push_back(instance);
        }
        std::stable_sort(build_.instances.begin(), build_.instances.end(),
                         [](const AssetInstance& a, const AssetInstance& b) { return a.asset < b.asset; });
    }

    const ShapeTree& shapes_;
    ShapeTree* spent_;
    std::span<const AssetSummary> assets_;
    TreeShape treeShape_;
    PatchCells cells_;
    NodeTreeBuild build_;
    std::vector<u64> keys_; // per shape
    std::vector<RawNode> raw_;
    std::vector<u32> children_;                     // of raw nodes
    std::vector<std::vector<u32>> itemsOf_;         // raw nodes that a shape hands to its parent
    std::vector<u32> patchOfPiece_;                 // of cells_
    std::vector<std::pair<u32, u32>> pieceOfShape_; // drawn piece of each shape that an asset fills
};

} // namespace

const char* treeShapeName(TreeShape shape)
{
    switch (shape) {
    case TreeShape::Grammar:
        return "grammar";
    case TreeShape::Free:
        return "free";
    case TreeShape::Faces:
        return "faces";
    }
    HELIO_CHECK(false, int(shape));
}

NodeTreeBuild buildNodes(const ShapeTree& shapes, std::span<const AssetSummary> assets, const NodeOptions& options)
{
    return Builder(shapes, nullptr, assets, options).build();
}

NodeTreeBuild buildNodes(ShapeTree&& shapes, std::span<const AssetSummary> assets, const NodeOptions& options)
{
    return Builder(shapes, &shapes, assets, options).build();
}

} // namespace helio
