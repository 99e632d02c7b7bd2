// SPDX-License-Identifier: Apache-2.0
#include "city/light/split_patches.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "city/base/check.h"
#include "city/base/hash.h"
#include "city/model/half_space.h"
#include "city/model/ring_polygons.h"

namespace helio {
namespace {

constexpr double kTinyPart = 1e-6; // of the patch's area: such a part is rounding

std::vector<Polygon3> clipAll(const HalfSpace& plane, const std::vector<Polygon3>& polygons)
{
    std::vector<Polygon3> kept;
    for (const Polygon3& polygon : polygons)
        for (Polygon3& part : clipPolygon(plane, polygon)) kept.push_back(std::move(part));
    return kept;
}

double areaOf(const std::vector<Polygon3>& polygons)
{
    double sum = 0.0;
    for (const Polygon3& polygon : polygons) sum += area(polygon);
    return sum;
}

/// A drawn piece's polygons inside a part.
struct PieceShare
{
    u32 piece;
    std::vector<Polygon3> polygons;
};

/// A part of a patch in the making.
struct Part
{
    std::vector<Polygon3> outline;
    std::vector<PieceShare> pieces;
};

class Splitter
{
public:
    Splitter(NodeTreeBuild& build, std::span<const AssetSummary> assets, const SplitPlan& plan)
        : build_(build), old_(build.tree), assets_(assets), plan_(plan)
    {
        HELIO_CHECK(plan.root.size() == old_.patchCount(), plan.root.size(), " plans for ", old_.patchCount(),
                    " patches");
    }

    /// The old number of each new patch.
    std::vector<u32> run()
    {
        tree_.names = std::move(old_.names);
        tree_.surfaceNames = std::move(old_.surfaceNames);
        tree_.buildingIds = std::move(old_.buildingIds);
        firstPiece_.assign(old_.patchCount() + 1, 0);
        for (const DrawnPiece& piece : build_.pieces) ++firstPiece_[piece.patch + 1];
        std::partial_sum(firstPiece_.begin(), firstPiece_.end(), firstPiece_.begin());
        newPiece_.assign(build_.pieces.size(), kNoIndex);
        firstPart_.reserve(old_.patchCount() + 1);
        topOf_.reserve(old_.patchCount());
        for (u32 patch = 0; patch < old_.patchCount(); ++patch) {
            firstPart_.push_back(tree_.patchCount());
            topOf_.push_back(plan_.root[patch] == kNoIndex ? keep(patch) : cut(patch));
        }
        firstPart_.push_back(tree_.patchCount());
        number();
        moveInstances();
        build_.pieces = std::move(pieces_);
        build_.tree = std::move(tree_);
        std::vector<u32> oldOf(build_.tree.patchCount());
        for (u32 patch = 0; patch < topOf_.size(); ++patch)
            std::fill(oldOf.begin() + firstPart_[patch], oldOf.begin() + firstPart_[patch + 1], patch);
        return oldOf;
    }

private:
    /// A node before it has its number.
    struct Raw
    {
        Node node;
        std::vector<u32> children; ///< raw numbers
        u32 patch = kNoIndex;
    };

    void addRings(std::vector<Polygon3> polygons, u32& begin, u32& count)
    {
        begin = u32(tree_.rings.size());
        for (Polygon3& polygon : polygons) {
            tree_.rings.push_back(std::move(polygon.outer));
            tree_.ringIsHole.push_back(0);
            for (Ring3& hole : polygon.holes) {
                tree_.rings.push_back(std::move(hole));
                tree_.ringIsHole.push_back(1);
            }
        }
        count = u32(tree_.rings.size()) - begin;
    }

    void moveRings(u32& begin, u32 count)
    {
        const u32 from = begin;
        begin = u32(tree_.rings.size());
        for (u32 r = from; r < from + count; ++r) {
            tree_.rings.push_back(old_.rings[r]);
            tree_.ringIsHole.push_back(old_.ringIsHole[r]);
        }
    }

    /// A patch that stays whole.
    u32 keep(u32 patch)
    {
        Raw raw;
        raw.node = old_.nodes[patch];
        raw.patch = tree_.patchCount();
        moveRings(raw.node.ringBegin, raw.node.ringCount);
        for (u32 p = firstPiece_[patch]; p < firstPiece_[patch + 1]; ++p) {
            DrawnPiece piece = build_.pieces[p];
            const DrawnPiece& own = build_.pieces[p];
            piece.patch = raw.patch;
            if (own.ringBegin == old_.nodes[patch].ringBegin && own.ringCount == old_.nodes[patch].ringCount)
                piece.ringBegin = raw.node.ringBegin; // one piece: it is the outline
            else
                moveRings(piece.ringBegin, piece.ringCount);
            newPiece_[p] = u32(pieces_.size());
            pieces_.push_back(piece);
        }
        tree_.patches.push_back(old_.patches[patch]);
        raw_.push_back(std::move(raw));
        return u32(raw_.size()) - 1;
    }

    u32 cut(u32 patch)
    {
        Part whole;
        whole.outline = ringPolygons(old_, old_.nodes[patch].ringBegin, old_.nodes[patch].ringCount);
        if (firstPiece_[patch + 1] - firstPiece_[patch] > 1) // else the outline itself is drawn
            for (u32 p = firstPiece_[patch]; p < firstPiece_[patch + 1]; ++p)
                whole.pieces.push_back({p, ringPolygons(old_, build_.pieces[p].ringBegin, build_.pieces[p].ringCount)});
        return cutPart(patch, plan_.root[patch], std::move(whole), 1);
    }

    /// `path`: 1, then a bit a cut: which side.
    u32 cutPart(u32 patch, u32 cell, Part part, u64 path)
    {
        const SplitCell& split = plan_.cells[cell];
        if (split.low == kNoIndex) return addPart(patch, std::move(part), path);
        Part low, high;
        const HalfSpace above{split.normal, split.offset}, below{-split.normal, -split.offset};
        low.outline = clipAll(below, part.outline);
        high.outline = clipAll(above, part.outline);
        const double tiny = kTinyPart * old_.patches[patch].area;
        if (areaOf(high.outline) <= tiny) return cutPart(patch, split.low, std::move(part), 2 * path);
        if (areaOf(low.outline) <= tiny) return cutPart(patch, split.high, std::move(part), 2 * path + 1);
        for (const PieceShare& piece : part.pieces) {
            if (std::vector<Polygon3> kept = clipAll(below, piece.polygons); !kept.empty())
                low.pieces.push_back({piece.piece, std::move(kept)});
            if (std::vector<Polygon3> kept = clipAll(above, piece.polygons); !kept.empty())
                high.pieces.push_back({piece.piece, std::move(kept)});
        }
        Raw raw;
        raw.node = old_.nodes[patch];
        raw.node.kind = NodeKind::Tiling;
        raw.node.coverage = 1.0;
        raw.node.area = 0.0;
        raw.node.centroid = glm::dvec3(0.0);
        addRings(std::move(part.outline), raw.node.ringBegin, raw.node.ringCount);
        raw.children = {cutPart(patch, split.low, std::move(low), 2 * path),
                        cutPart(patch, split.high, std::move(high), 2 * path + 1)};
        for (const u32 child : raw.children) {
            raw.node.area += raw_[child].node.area;
            raw.node.centroid += raw_[child].node.area * raw_[child].node.centroid;
        }
        raw.node.centroid /= raw.node.area;
        raw_.push_back(std::move(raw));
        return u32(raw_.size()) - 1;
    }

    u32 addPart(u32 patch, Part part, u64 path)
    {
        Raw raw;
        raw.node = old_.nodes[patch];
        raw.patch = tree_.patchCount();
        Patch own = old_.patches[patch];
        if (path != 1) own.key = mixSeed(own.key, path);
        own.area = areaOf(part.outline);
        raw.node.area = own.area;
        raw.node.centroid = glm::dvec3(0.0);
        for (const Polygon3& polygon : part.outline) raw.node.centroid += area(polygon) * centroid(polygon);
        raw.node.centroid /= own.area;
        addRings(std::move(part.outline), raw.node.ringBegin, raw.node.ringCount);
        if (part.pieces.empty()) {
            DrawnPiece piece = build_.pieces[firstPiece_[patch]];
            piece.patch = raw.patch;
            piece.ringBegin = raw.node.ringBegin;
            piece.ringCount = raw.node.ringCount;
            pieces_.push_back(piece);
        } else {
            own.rho = glm::dvec4(0.0);
            double drawn = 0.0;
            for (PieceShare& share : part.pieces) {
                DrawnPiece piece = build_.pieces[share.piece];
                const double pieceArea = areaOf(share.polygons);
                own.rho += pieceArea * piece.rho;
                drawn += pieceArea;
                piece.patch = raw.patch;
                addRings(std::move(share.polygons), piece.ringBegin, piece.ringCount);
                pieces_.push_back(piece);
            }
            own.rho = drawn > 0.0 ? own.rho / drawn : old_.patches[patch].rho;
        }
        tree_.patches.push_back(own);
        raw_.push_back(std::move(raw));
        return u32(raw_.size()) - 1;
    }

    /// Patches first, then inner nodes by rising height, as buildNodes numbers them.
    void number()
    {
        std::vector<u32> rawOf(old_.nodeCount());
        for (u32 i = 0; i < old_.nodeCount(); ++i) {
            if (old_.isLeaf(i)) {
                rawOf[i] = topOf_[i];
                continue;
            }
            Raw raw;
            raw.node = old_.nodes[i];
            moveRings(raw.node.ringBegin, raw.node.ringCount);
            for (const u32 child : old_.childrenOf(i)) raw.children.push_back(rawOf[child]);
            raw_.push_back(std::move(raw));
            rawOf[i] = u32(raw_.size()) - 1;
        }
        for (Raw& raw : raw_) { // children come before their parents
            raw.node.height = 0;
            for (const u32 child : raw.children)
                raw.node.height = std::max(raw.node.height, raw_[child].node.height + 1);
        }
        std::vector<u32> order(raw_.size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), [&](u32 a, u32 b) {
            const u32 ha = raw_[a].node.height, hb = raw_[b].node.height;
            return ha != hb ? ha < hb : ha == 0 && raw_[a].patch < raw_[b].patch;
        });
        std::vector<u32> numberOf(raw_.size());
        for (u32 i = 0; i < order.size(); ++i) numberOf[order[i]] = i;
        tree_.nodes.resize(raw_.size());
        for (u32 i = 0; i < order.size(); ++i) {
            const Raw& raw = raw_[order[i]];
            Node& node = tree_.nodes[i];
            node = raw.node;
            node.childBegin = u32(tree_.children.size());
            node.childCount = u32(raw.children.size());
            for (const u32 child : raw.children) tree_.children.push_back(numberOf[child]);
            node.parent = kNoIndex;
        }
        for (u32 i = 0; i < tree_.nodeCount(); ++i)
            for (const u32 child : tree_.childrenOf(i)) tree_.nodes[child].parent = i;
    }

    void moveInstances()
    {
        for (AssetInstance& instance : build_.instances) {
            if (instance.piece != kNoIndex) {
                instance.piece = newPiece_[instance.piece];
                HELIO_CHECK(instance.piece != kNoIndex, "an asset fills a patch that was cut");
                instance.patch = pieces_[instance.piece].patch;
                continue;
            }
            const u32 begin = firstPart_[instance.patch], end = firstPart_[instance.patch + 1];
            const glm::dvec3 centre = instance.worldFromAsset * glm::dvec4(assets_[instance.asset].boxCentre, 1.0);
            double nearest = std::numeric_limits<double>::infinity();
            for (u32 part = begin; part < end; ++part) {
                const double distance = glm::distance(centre, tree_.nodes[part].centroid);
                if (distance >= nearest) continue;
                nearest = distance;
                instance.patch = part;
            }
        }
    }

    NodeTreeBuild& build_;
    NodeTree& old_;
    std::span<const AssetSummary> assets_;
    const SplitPlan& plan_;
    NodeTree tree_;
    std::vector<Raw> raw_;
    std::vector<DrawnPiece> pieces_;
    std::vector<u32> firstPiece_; ///< per old patch
    std::vector<u32> newPiece_;   ///< per old piece; kNoIndex if it was cut
    std::vector<u32> firstPart_;  ///< per old patch and one more: its first new patch
    std::vector<u32> topOf_;      ///< per old patch: the raw node that replaces it
};

} // namespace

std::vector<u8> cuttablePatches(const NodeTreeBuild& build)
{
    std::vector<u8> may(build.tree.patchCount(), 1);
    for (u32 i = 0; i < build.tree.patchCount(); ++i)
        if (build.tree.patches[i].covered) may[i] = 0;
    for (const DrawnPiece& piece : build.pieces)
        if (piece.asset != kNoIndex) may[piece.patch] = 0;
    return may;
}

std::vector<u32> splitPatches(NodeTreeBuild& build, std::span<const AssetSummary> assets, const SplitPlan& plan)
{
    return Splitter(build, assets, plan).run();
}

} // namespace helio
