// SPDX-License-Identifier: Apache-2.0
#include "tests/cities/tree_audit.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <mutex>

#include "city/base/check.h"
#include "city/base/parallel.h"
#include "city/light/cosine_directions.h"
#include "city/light/sequence.h"
#include "city/light/visibility.h"

namespace helio {
namespace {

constexpr size_t kMostExamples = 8;
constexpr u32 kRays = 24;
constexpr double kLevel = 0.95; // |normal.z| of a level face
constexpr double kLift = 1e-3;  // m: between faces that meet at an acute angle there is little room

bool isFinite(const glm::dvec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double outlineArea(const NodeTree& tree, u32 node)
{
    glm::dvec3 sum(0.0);
    for (const Ring3& ring : tree.outlineOf(node)) sum += vectorArea(ring);
    return glm::length(sum);
}

/// The patches of one building alone, as a tree that rays can be shot at.
NodeTree partOf(const NodeTree& tree, std::span<const u32> patches)
{
    NodeTree part;
    for (const u32 patch : patches) {
        Node node = tree.nodes[patch];
        const std::span<const Ring3> rings = tree.outlineOf(patch);
        part.ringIsHole.insert(part.ringIsHole.end(), tree.ringIsHole.begin() + node.ringBegin,
                               tree.ringIsHole.begin() + node.ringBegin + node.ringCount);
        node.parent = kNoIndex;
        node.ringBegin = u32(part.rings.size());
        part.rings.insert(part.rings.end(), rings.begin(), rings.end());
        part.patches.push_back(tree.patches[patch]);
        part.nodes.push_back(node);
    }
    return part;
}

bool facesInwards(const NodeTree& part, const Visibility& visibility, u32 patch)
{
    const glm::dvec3& normal = part.nodes[patch].normal;
    const PlaneFrame frame = planeFrame(normal);
    u32 backs = 0, rays = 0;
    for (u32 k = 0; k < kRays; ++k) {
        const std::array<double, 4> x = shiftedSobol4(k, {});
        glm::dvec3 direction = cosineDirection(frame, x[0], x[1]);
        if (std::abs(normal.z) < kLevel) {
            direction.z *= 0.1;
            direction = glm::normalize(direction);
            if (glm::dot(direction, normal) <= 0.0) continue;
        }
        ++rays;
        const glm::dvec3 from = visibility.pointOnPatch(patch, x[2], x[3]) + kLift * normal;
        const RayHit hit = visibility.trace(from, normal, direction);
        if (hit.patch != kNoIndex && !hit.front) ++backs;
    }
    return 2 * backs > rays;
}

class Auditor
{
public:
    explicit Auditor(const NodeTreeBuild& build) : build_(build), tree_(build.tree) {}

    TreeAudit run(const ShapeTree& shapes, bool inwards, u32 jobs)
    {
        for (u32 i = 0; i < tree_.nodeCount(); ++i) checkNode(i);
        checkLedger(shapes);
        if (inwards) checkInwards(jobs);
        return std::move(audit_);
    }

private:
    void fault(u64& count, const char* what, u32 node)
    {
        ++count;
        if (audit_.examples.size() >= kMostExamples) return;
        const Node& n = tree_.nodes[node];
        const std::string building = n.building < tree_.buildingIds.size() ? tree_.buildingIds[n.building] : "ground";
        audit_.examples.push_back(concat(what, ": node ", node, " '", tree_.names[n.name], "' of ", building, ", area ",
                                         n.area, ", at ", n.centroid.x, " ", n.centroid.y, " ", n.centroid.z,
                                         ", normal ", n.normal.x, " ", n.normal.y, " ", n.normal.z));
    }

    void checkNode(u32 i)
    {
        const Node& node = tree_.nodes[i];
        bool finite = std::isfinite(node.area) && isFinite(node.centroid) && isFinite(node.normal);
        for (const Ring3& ring : tree_.outlineOf(i))
            for (const glm::dvec3& corner : ring) finite = finite && isFinite(corner);
        if (!finite) return fault(audit_.notFinite, "not finite", i);
        if (!(node.area > 0.0)) fault(audit_.noArea, "no area", i);
        if (node.kind != NodeKind::Cluster && std::abs(glm::length(node.normal) - 1.0) > 1e-9)
            fault(audit_.badNormal, "normal", i);
        if (node.parent != kNoIndex && (node.parent <= i || tree_.nodes[node.parent].height <= node.height))
            fault(audit_.badLink, "parent", i);
        if (tree_.isLeaf(i)) {
            if (std::abs(outlineArea(tree_, i) / node.area - 1.0) > 1e-5) fault(audit_.badOutline, "outline", i);
            return;
        }
        double sum = 0.0;
        bool some = false, all = true;
        for (const u32 child : tree_.childrenOf(i)) {
            if (tree_.nodes[child].parent != i) fault(audit_.badLink, "child", child);
            sum += tree_.nodes[child].area;
            some = some || tree_.nodes[child].covered;
            all = all && tree_.nodes[child].covered;
        }
        if (std::abs(sum / node.area - 1.0) > 1e-9) fault(audit_.badSum, "sum of children", i);
        if (node.kind != NodeKind::Cluster && some && !all) fault(audit_.mixedCovered, "covered and free", i);
    }

    void checkLedger(const ShapeTree& shapes)
    {
        double derived = 0.0, patches = 0.0;
        for (const Shape& shape : shapes.shapes)
            for (u32 p = shape.polygonBegin; p < shape.polygonBegin + shape.polygonCount; ++p)
                if (const double a = area(shapes.polygons[p]); a >= 1e-8) derived += a;
        glm::dvec4 light(0.0), drawn(0.0);
        for (const Patch& patch : tree_.patches) {
            patches += patch.area;
            light += patch.area * patch.rho;
        }
        for (const DrawnPiece& piece : build_.pieces) {
            glm::dvec3 sum(0.0);
            for (u32 r = piece.ringBegin; r < piece.ringBegin + piece.ringCount; ++r) sum += vectorArea(tree_.rings[r]);
            drawn += glm::length(sum) * piece.rho;
        }
        if (derived > 0.0) audit_.areaLedger = std::abs(patches / derived - 1.0);
        for (int c = 0; c < 4; ++c)
            if (drawn[c] > 0.0) audit_.rhoLedger = std::max(audit_.rhoLedger, std::abs(light[c] / drawn[c] - 1.0));
    }

    void checkInwards(u32 jobs)
    {
        std::vector<std::vector<u32>> patchesOf(tree_.buildingIds.size());
        for (u32 i = 0; i < tree_.patchCount(); ++i)
            if (const u32 building = tree_.patches[i].building; building != kNoIndex) patchesOf[building].push_back(i);
        std::vector<u32> inwards;
        std::mutex mutex;
        parallelFor(u32(patchesOf.size()), 16, jobs, [&](u32 begin, u32 end) {
            for (u32 b = begin; b < end; ++b) {
                if (patchesOf[b].empty()) continue;
                const NodeTree part = partOf(tree_, patchesOf[b]);
                const Visibility visibility(part);
                for (u32 k = 0; k < part.patchCount(); ++k) {
                    if (part.patches[k].covered || !facesInwards(part, visibility, k)) continue;
                    const std::lock_guard lock(mutex);
                    inwards.push_back(patchesOf[b][k]);
                }
            }
        });
        std::sort(inwards.begin(), inwards.end());
        for (const u32 patch : inwards) {
            fault(audit_.facesInwards, "faces its own building", patch);
            ++audit_.inwardsByName[tree_.names[tree_.nodes[patch].name]];
        }
    }

    const NodeTreeBuild& build_;
    const NodeTree& tree_;
    TreeAudit audit_;
};

} // namespace

bool TreeAudit::good() const
{
    return notFinite + noArea + badNormal + badOutline + badSum + badLink + mixedCovered + facesInwards == 0 &&
           areaLedger <= 1e-5 && rhoLedger <= 1e-5;
}

TreeAudit auditTree(const NodeTreeBuild& build, const ShapeTree& shapes, bool inwards, u32 jobs)
{
    return Auditor(build).run(shapes, inwards, jobs);
}

u64 bytesOf(const NodeTreeBuild& build)
{
    const NodeTree& tree = build.tree;
    u64 bytes = tree.patches.capacity() * sizeof(Patch) + tree.nodes.capacity() * sizeof(Node) +
                tree.children.capacity() * sizeof(u32) + tree.rings.capacity() * sizeof(Ring3) +
                tree.ringIsHole.capacity() + build.pieces.capacity() * sizeof(DrawnPiece) +
                build.instances.capacity() * sizeof(AssetInstance);
    for (const Ring3& ring : tree.rings) bytes += ring.capacity() * sizeof(glm::dvec3);
    return bytes;
}

} // namespace helio
