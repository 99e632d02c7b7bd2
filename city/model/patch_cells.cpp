// SPDX-License-Identifier: Apache-2.0
#include "city/model/patch_cells.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <numeric>

#include "city/base/check.h"
#include "city/model/hidden_cells.h"
#include "city/model/join_polygons.h"
#include "city/model/plane_groups.h"

namespace helio {
namespace {

constexpr double kMinArea = 1e-8;     // m2: less is no surface
constexpr double kSliverWidth = 0.05; // m
constexpr double kSliverArea = 0.01;  // m2
constexpr double kTouch = 1e-3;       // m: gap between neighbours, and least length of their common side
constexpr double kSliverGrowth = 0.2; // m: a neighbour takes slivers up to this size whatever the limit
constexpr double kSizeSlack = 1e-6;   // m
constexpr double kAreaSlack = 1e-6;   // relative, and m2
constexpr double kWellFilled = 0.7;   // share of its box that a merged patch longer than the limit has
constexpr double kWide = 1.0;         // m: narrower ones (fins, frames) are not worth strips
constexpr double kSteep = 0.5;        // |normal.z| below: steeper than 60 degrees
constexpr size_t kLookBack = 10;      // cells that a cell is compared with: keeps long repeats linear
constexpr u32 kMostPasses = 4;
constexpr u32 kMostStrips = 1024; // of one leaf

struct Box
{
    glm::dvec2 low{1e300}, high{-1e300};

    void add(const glm::dvec2& p)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    glm::dvec2 size() const { return high - low; }
};

Box unionOf(const Box& a, const Box& b)
{
    return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

/// True if the boxes meet along a side, or overlap.
bool touch(const Box& a, const Box& b)
{
    const glm::dvec2 overlap = glm::min(a.high, b.high) - glm::max(a.low, b.low);
    const glm::dvec2 smaller = glm::min(a.size(), b.size());
    const auto along = [&](glm::length_t k) { return overlap[k] >= std::min(kTouch, 0.5 * smaller[k]); };
    return overlap.x >= -kTouch && overlap.y >= -kTouch && (along(0) || along(1));
}

/// Length along which boxes that touch meet, m.
double commonSide(const Box& a, const Box& b)
{
    const glm::dvec2 overlap = glm::min(a.high, b.high) - glm::max(a.low, b.low);
    return std::max(overlap.x, overlap.y);
}

class CellMaker
{
public:
    CellMaker(const ShapeTree& shapes, const NodeOptions& options) : shapes_(shapes), options_(options) {}

    PatchCells run()
    {
        const size_t count = shapes_.shapes.size();
        open_.resize(count);
        out_.isSolid.assign(count, 0);
        size_t leaves = 0;
        for (const Shape& shape : shapes_.shapes) leaves += shape.polygonCount > 0 ? 1 : 0;
        // Nearly what there will be: growing step by step would hold everything twice.
        out_.pieceRow.reserve(count + 1);
        out_.pieces.reserve(leaves + leaves / 8);
        out_.cells.reserve(leaves + leaves / 8);
        out_.polygonRefs.reserve(shapes_.polygons.size());
        for (u32 s = 0; s < count; ++s) {
            out_.pieceRow.push_back(u32(out_.pieces.size()));
            makePieces(s);
        }
        out_.pieceRow.push_back(u32(out_.pieces.size()));
        // Before the merge: covered and free cells must not mix.
        for (const u32 c : hiddenCells(shapes_, out_)) out_.cells[c].covered = true;
        // Children come after their parents, so their cells are ready; they went up in reverse.
        for (u32 s = u32(count); s-- > 0;) climb(s);
        return std::move(out_);
    }

private:
    bool isGiven(const Shape& shape) const
    {
        return shape.op == ShapeOp::Group || shape.building == kNoIndex || shape.sourceFace != kNoIndex;
    }

    /// One cell for each plane that the leaf's polygons lie in, or for each strip of it.
    void makePieces(u32 s)
    {
        const Shape& shape = shapes_.shapes[s];
        if (shape.polygonCount == 0) return;
        std::vector<u32> refs;
        std::vector<PlaneItem> planes;
        for (u32 p = shape.polygonBegin; p < shape.polygonBegin + shape.polygonCount; ++p) {
            const Polygon3& polygon = shapes_.polygons[p];
            if (area(polygon) >= kMinArea) {
                refs.push_back(p);
                planes.push_back({unitNormal(polygon), polygon.outer[0]});
            } else {
                ++out_.degenerateCount;
            }
        }
        const std::vector<std::vector<u32>> groups = groupByPlane(planes);
        ordinal_ = 0;
        for (const std::vector<u32>& group : groups) {
            const glm::dvec3 normal = planes[group[0]].normal;
            std::vector<u32> own;
            for (const u32 member : group) own.push_back(refs[member]);
            addPlane(s, own, normal);
        }
        out_.isSolid[s] = groups.size() > 1;
        const u32 first = out_.pieceRow[s], end = u32(out_.pieces.size());
        if (groups.size() == 1 && !isGiven(shape))
            for (u32 i = end; i-- > first;) open_[s].push_back(i); // Piece i is cell i here.
    }

    void addPlane(u32 s, std::span<const u32> refs, const glm::dvec3& normal)
    {
        const Shape& shape = shapes_.shapes[s];
        const PlaneFrame frame = planeFrame(normal);
        u32 count = 1;
        if (shape.asset == kNoIndex && shape.sourceFace == kNoIndex && options_.stripHeight > 0.0 &&
            std::abs(normal.z) < kSteep) {
            Box box;
            for (const u32 ref : refs)
                for (const glm::dvec3& q : shapes_.polygons[ref].outer)
                    box.add({glm::dot(q, frame.u), glm::dot(q, frame.v)});
            const glm::dvec2 size = box.size();
            if (size.x >= kWide && size.y > std::max(options_.mergeSize, options_.stripHeight))
                count = u32(std::clamp(std::ceil(size.y / options_.stripHeight - 1e-9), 1.0, double(kMostStrips)));
        }
        if (count == 1) {
            addPiece(s, refs, normal);
            return;
        }
        std::vector<Polygon3> polygons;
        for (const u32 ref : refs) polygons.push_back(shapes_.polygons[ref]);
        for (std::vector<Polygon3>& strip : cutIntoStrips(polygons, frame.v, count)) addCutPiece(s, strip, normal);
    }

    void addCutPiece(u32 s, std::vector<Polygon3>& polygons, const glm::dvec3& normal)
    {
        std::vector<u32> refs;
        for (Polygon3& polygon : polygons) {
            refs.push_back(u32(shapes_.polygons.size() + out_.cut.size()));
            out_.cut.push_back(std::move(polygon));
        }
        if (refs.empty()) return;
        ++out_.stripCount;
        addPiece(s, refs, normal);
    }

    void addPiece(u32 s, std::span<const u32> refs, const glm::dvec3& normal)
    {
        PatchPiece piece;
        piece.shape = s;
        piece.polygonBegin = u32(out_.polygonRefs.size());
        piece.polygonCount = u32(refs.size());
        for (const u32 ref : refs) piece.area += area(out_.polygon(shapes_, ref));
        out_.polygonRefs.insert(out_.polygonRefs.end(), refs.begin(), refs.end());
        PatchCell cell;
        cell.normal = normal;
        cell.point = out_.polygon(shapes_, refs[0]).outer[0];
        cell.area = piece.area;
        cell.firstPiece = cell.lastPiece = u32(out_.pieces.size());
        cell.owner = s;
        cell.openings = shapes_.shapes[s].placement == AssetPlacement::Fill ? 1 : 0;
        cell.ordinal = ordinal_++;
        cell.covered = shapes_.shapes[s].covered;
        out_.pieces.push_back(piece);
        out_.cells.push_back(cell);
    }

    /// Merges what has come up to a shape and hands it on to the parent, unless the shape is a face or a root.
    void climb(u32 s)
    {
        std::vector<u32>& open = open_[s];
        if (open.empty()) return;
        const Shape& shape = shapes_.shapes[s];
        const bool face = shape.op == ShapeOp::Component || shape.parent == kNoIndex;
        if (shape.op != ShapeOp::Root && open.size() > 1) {
            std::reverse(open.begin(), open.end());
            mergeCells(s, open, face);
            std::reverse(open.begin(), open.end());
        }
        if (!face) {
            std::vector<u32>& above = open_[shape.parent];
            above.insert(above.end(), open.begin(), open.end());
        }
        open = {};
    }

    void mergeCells(u32 s, std::vector<u32>& open, bool face)
    {
        std::vector<PlaneItem> planes;
        for (const u32 c : open) {
            const PatchCell& cell = out_.cells[c];
            planes.push_back({cell.normal, cell.point, false, cell.covered ? 1u : 0u});
        }
        bool changed = false;
        for (std::vector<u32>& group : groupByPlane(planes)) {
            if (group.size() == 1) continue;
            for (u32& member : group) member = open[member];
            changed |= mergePlane(s, group, face);
        }
        if (changed) std::erase_if(open, [&](u32 c) { return !out_.cells[c].alive; });
    }

    bool mergePlane(u32 s, std::vector<u32>& group, bool face)
    {
        const PlaneFrame frame = planeFrame(out_.cells[group[0]].normal);
        const glm::dvec3 origin = out_.cells[group[0]].point;
        boxes_.clear();
        for (const u32 c : group) boxes_.push_back(boxOf(c, frame, origin));
        for (size_t i = 0; i < group.size(); ++i) {
            const glm::dvec2 size = boxes_[i].size();
            PatchCell& cell = out_.cells[group[i]];
            cell.sliver = cell.area < kSliverArea || std::min(size.x, size.y) < kSliverWidth;
        }
        const size_t before = group.size();
        for (u32 pass = 0; pass < kMostPasses && mergePass(s, group, face); ++pass) {
        }
        return group.size() < before;
    }

    Box boxOf(u32 c, const PlaneFrame& frame, const glm::dvec3& origin) const
    {
        Box box;
        for (u32 p = out_.cells[c].firstPiece; p != kNoIndex; p = out_.pieces[p].next) {
            const PatchPiece& piece = out_.pieces[p];
            for (u32 r = piece.polygonBegin; r < piece.polygonBegin + piece.polygonCount; ++r)
                for (const glm::dvec3& q : out_.polygon(shapes_, out_.polygonRefs[r]).outer)
                    box.add({glm::dot(q - origin, frame.u), glm::dot(q - origin, frame.v)});
        }
        return box;
    }

    bool mergePass(u32 s, std::vector<u32>& group, bool face)
    {
        size_t kept = 0;
        for (size_t i = 0; i < group.size(); ++i) {
            size_t with = kept;
            const size_t oldest = kept > kLookBack ? kept - kLookBack : 0;
            double longest = -1.0;
            for (size_t k = kept; k-- > oldest;) {
                if (!mayMerge(group[k], boxes_[k], group[i], boxes_[i], face)) continue;
                const double side = commonSide(boxes_[k], boxes_[i]);
                if (side <= longest) continue;
                with = k;
                longest = side;
                if (!out_.cells[group[i]].sliver) break; // Only slivers choose.
            }
            if (with < kept) {
                merge(s, group[with], group[i]);
                boxes_[with] = unionOf(boxes_[with], boxes_[i]);
            } else {
                group[kept] = group[i];
                boxes_[kept++] = boxes_[i];
            }
        }
        const bool merged = kept < group.size();
        group.resize(kept);
        boxes_.resize(kept);
        return merged;
    }

    u32 surfaceOf(u32 c) const { return shapes_.shapes[out_.pieces[out_.cells[c].firstPiece].shape].surface; }

    bool mayMerge(u32 a, const Box& boxA, u32 b, const Box& boxB, bool face) const
    {
        if (!touch(boxA, boxB)) return false;
        const glm::dvec2 size = unionOf(boxA, boxB).size();
        // Two that lie on each other stay apart, so that the ledger of their node shows it.
        if (out_.cells[a].area + out_.cells[b].area > size.x * size.y * (1.0 + kAreaSlack) + kAreaSlack) return false;
        const u32 openings = out_.cells[a].openings + out_.cells[b].openings;
        // Walls take slivers at once; openings only those that no wall of the face has taken.
        if ((out_.cells[a].sliver || out_.cells[b].sliver) && (openings == 0 || face)) {
            // A ledge along the whole facade is not one of its bays.
            const glm::dvec2 own = (out_.cells[a].area >= out_.cells[b].area ? boxA : boxB).size();
            const double most = std::max(options_.mergeSize, kSliverGrowth) + kSizeSlack;
            return !glm::any(glm::greaterThan(size - own, glm::dvec2(most)));
        }
        // A side that is longer already may stay so if the two go well together: strips of a wall, not a comb.
        const glm::dvec2 longest = glm::max(glm::max(boxA.size(), boxB.size()), glm::dvec2(options_.mergeSize));
        if (glm::any(glm::greaterThan(size, longest + kSizeSlack))) return false;
        const bool fits = std::max(size.x, size.y) <= options_.mergeSize + kSizeSlack;
        if (!fits && out_.cells[a].area + out_.cells[b].area < kWellFilled * size.x * size.y) return false;
        if (openings == 0) return surfaceOf(a) == surfaceOf(b);
        return openings == 1 && options_.patch == PatchMode::Bay;
    }

    void merge(u32 s, u32 into, u32 from)
    {
        PatchCell &a = out_.cells[into], &b = out_.cells[from];
        ++out_.mergedCount;
        if (a.sliver || b.sliver) ++out_.sliverCount;
        const bool keepsPlane = a.area >= b.area;
        if (!keepsPlane) {
            a.normal = b.normal;
            a.point = b.point;
        }
        // The larger one's pieces come first: they say which surface the cell has.
        const u32 first = keepsPlane ? a.firstPiece : b.firstPiece, last = keepsPlane ? b.lastPiece : a.lastPiece;
        out_.pieces[keepsPlane ? a.lastPiece : b.lastPiece].next = keepsPlane ? b.firstPiece : a.firstPiece;
        a.firstPiece = first;
        a.lastPiece = last;
        a.area += b.area;
        a.openings += b.openings;
        a.sliver = a.sliver && b.sliver;
        a.owner = s;
        b.alive = false;
    }

    const ShapeTree& shapes_;
    const NodeOptions& options_;
    PatchCells out_;
    std::vector<std::vector<u32>> open_; // per shape: cells that may still merge, last one first
    std::vector<Box> boxes_;             // of the group at hand
    u32 ordinal_ = 0;
};

} // namespace

PatchCells makeCells(const ShapeTree& shapes, const NodeOptions& options)
{
    return CellMaker(shapes, options).run();
}

} // namespace helio
