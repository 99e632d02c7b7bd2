// SPDX-License-Identifier: Apache-2.0
#include "city/format/validate.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace helio {
namespace {

using gpu::kNone;

constexpr float kLargestFactor = 1.0001f; ///< a factor is a fraction; the margin is for sums of floats
constexpr float kTinyDefect = 1e-3f;      ///< relative, for unit vectors and sums of areas in float

bool isFinite(const glm::vec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool isUnit(const glm::vec3& v)
{
    return std::abs(glm::dot(v, v) - 1.0f) < kTinyDefect;
}
bool inUnit(float x)
{
    return x >= 0.0f && x <= kLargestFactor;
}

/// One rule a function. Each returns the first fault that it finds.
class TileChecker
{
public:
    TileChecker(const TileView& tile, const PackIndex& index, const SectionPlaces& places)
        : t_(tile), index_(index), places_(places), nameCount_(countNames(tile.nodeNames)),
          surfaceCount_(countNames(tile.surfaceNames)), buildingCount_(countNames(tile.buildingIds))
    {
    }

    Status run()
    {
        using Rule = Status (TileChecker::*)() const;
        for (const Rule rule :
             {&TileChecker::checkNames, &TileChecker::checkPatches, &TileChecker::checkNodes, &TileChecker::checkFamily,
              &TileChecker::checkOutlines, &TileChecker::checkLinks, &TileChecker::checkSky,
              &TileChecker::checkPatchErrors, &TileChecker::checkMeshes})
            if (Status status = (this->*rule)(); !status) return status;
        return Nothing{};
    }

private:
    static u64 countNames(std::span<const char> names) { return u64(std::count(names.begin(), names.end(), '\n')); }

    template <class T, class... Ts> Error fail(SectionId id, std::span<const T>, u64 element, const Ts&... parts) const
    {
        return Error{concat(places_.describe(id, element * sizeof(T)), ": ", parts..., "; bake the pack again")};
    }

    Status checkNames() const
    {
        for (const auto& [id, names] : {std::pair{SectionId::NodeNames, t_.nodeNames},
                                        {SectionId::SurfaceNames, t_.surfaceNames},
                                        {SectionId::BuildingIds, t_.buildingIds}})
            if (!names.empty() && names.back() != '\n')
                return fail(id, names, names.size() - 1, "the last name does not end");
        return Nothing{};
    }

    Status checkPatches() const
    {
        if (t_.patches.empty()) return fail(SectionId::Patches, t_.patches, 0, "there are no patches");
        if (t_.patches.size() > t_.nodes.size())
            return fail(SectionId::Nodes, t_.nodes, 0, t_.nodes.size(), " nodes for ", t_.patches.size(), " patches");
        for (u64 i = 0; i < t_.patches.size(); ++i) {
            const gpu::PatchRecord& p = t_.patches[i];
            const auto wrong = [&](const auto&... parts) {
                return fail(SectionId::Patches, t_.patches, i, "patch ", i, ": ", parts...);
            };
            if (!(p.area > 0.0f) || !std::isfinite(p.area)) return wrong("area ", p.area, " m2");
            if (!isUnit(p.normal)) return wrong("the normal is no unit vector");
            for (int c = 0; c < 4; ++c) {
                if (!inUnit(p.rho[c])) return wrong("reflectance ", p.rho[c]);
                if (!(p.emission[c] >= 0.0f) || !std::isfinite(p.emission[c]))
                    return wrong("emission ", p.emission[c], " W/m2");
            }
            if (p.building != kNone && p.building >= buildingCount_)
                return wrong("building ", p.building, " of ", buildingCount_);
            if (p.surface != kNone && p.surface >= surfaceCount_)
                return wrong("surface ", p.surface, " of ", surfaceCount_);
            if (p.sourceFace != kNone && p.sourceFace >= index_.sourceFaceCount)
                return wrong("source face ", p.sourceFace, " of ", index_.sourceFaceCount);
        }
        return Nothing{};
    }

    Status checkNodes() const
    {
        if (t_.nodes.size() >= kNone) return fail(SectionId::Nodes, t_.nodes, 0, "more nodes than 32 bits can number");
        if (t_.nodeInfos.size() != t_.nodes.size())
            return fail(SectionId::NodeInfos, t_.nodeInfos, 0, t_.nodeInfos.size(), " records for ", t_.nodes.size(),
                        " nodes");
        for (u64 i = 0; i < t_.nodes.size(); ++i) {
            const gpu::NodeRecord& node = t_.nodes[i];
            const gpu::NodeInfoRecord& info = t_.nodeInfos[i];
            const bool leaf = i < t_.patches.size();
            const auto wrong = [&](const auto&... parts) {
                return fail(SectionId::Nodes, t_.nodes, i, "node ", i, ": ", parts...);
            };
            const auto wrongInfo = [&](const auto&... parts) {
                return fail(SectionId::NodeInfos, t_.nodeInfos, i, "node ", i, ": ", parts...);
            };
            if (!(node.area > 0.0f) || !std::isfinite(node.area)) return wrong("area ", node.area, " m2");
            if (leaf && node.area != t_.patches[i].area) return wrong("its area differs from its patch's");
            if (leaf != (node.childCount == 0))
                return wrong(node.childCount, leaf ? " children of a leaf" : " children of an inner node");
            if (node.childBegin > t_.children.size() || node.childCount > t_.children.size() - node.childBegin)
                return wrong("children ", node.childBegin, " + ", node.childCount, " of ", t_.children.size());
            if (node.parent != kNone && (node.parent <= i || node.parent >= t_.nodes.size()))
                return wrong("parent ", node.parent, " does not come after it among ", t_.nodes.size(), " nodes");
            if (leaf != (info.height == 0))
                return wrongInfo("height ", info.height, leaf ? " of a leaf" : " of an inner node");
            if (i > 0 && info.height < t_.nodeInfos[i - 1].height)
                return wrongInfo("lies lower than the node before it");
            if (info.kind > 2) return wrongInfo("kind ", info.kind);
            if (!isFinite(info.centroid)) return wrongInfo("the centroid is not finite");
            if (!isUnit(info.normal) && (info.kind != 2 || info.normal != glm::vec3(0.0f)))
                return wrongInfo("the normal is no unit vector");
            if (!(info.coverage >= 0.0f) || !std::isfinite(info.coverage)) return wrongInfo("coverage ", info.coverage);
            if (info.building != kNone && info.building >= buildingCount_)
                return wrongInfo("building ", info.building, " of ", buildingCount_);
            if (info.name >= nameCount_) return wrongInfo("name ", info.name, " of ", nameCount_);
        }
        return Nothing{};
    }

    /// Every node but the roots is the child of its parent, exactly once; heights and areas follow from the children.
    Status checkFamily() const
    {
        std::vector<bool> seen(t_.nodes.size(), false);
        for (u64 i = t_.patches.size(); i < t_.nodes.size(); ++i) {
            const gpu::NodeRecord& node = t_.nodes[i];
            u32 height = 0;
            double area = 0.0;
            for (u64 k = node.childBegin; k < u64(node.childBegin) + node.childCount; ++k) {
                const u32 child = t_.children[k];
                const auto wrong = [&](const auto&... parts) {
                    return fail(SectionId::Children, t_.children, k, "child ", child, " of node ", i, ": ", parts...);
                };
                if (child >= t_.nodes.size()) return wrong("there are ", t_.nodes.size(), " nodes");
                if (t_.nodes[child].parent != i) return wrong("its parent is ", t_.nodes[child].parent);
                if (seen[child]) return wrong("it is listed twice");
                seen[child] = true;
                height = std::max(height, t_.nodeInfos[child].height + 1);
                area += double(t_.nodes[child].area);
            }
            if (t_.nodeInfos[i].height != height)
                return fail(SectionId::NodeInfos, t_.nodeInfos, i, "node ", i, ": height ", t_.nodeInfos[i].height,
                            ", its children say ", height);
            if (std::abs(area - double(node.area)) > double(kTinyDefect) * area)
                return fail(SectionId::Nodes, t_.nodes, i, "node ", i, ": area ", node.area, " m2, its children's is ",
                            area);
        }
        for (u64 i = 0; i < t_.nodes.size(); ++i)
            if (!seen[i] && t_.nodes[i].parent != kNone)
                return fail(SectionId::Nodes, t_.nodes, i, "node ", i, ": its parent ", t_.nodes[i].parent,
                            " does not list it");
        return Nothing{};
    }

    Status checkRows(SectionId id, std::span<const u32> rows, u64 rowCount, u64 elementCount) const
    {
        if (rows.size() != rowCount + 1) return fail(id, rows, 0, rows.size(), " offsets for ", rowCount, " rows");
        if (rows.front() != 0) return fail(id, rows, 0, "the first row starts at ", rows.front());
        for (u64 i = 1; i < rows.size(); ++i)
            if (rows[i] < rows[i - 1]) return fail(id, rows, i, "row ", i, " starts before row ", i - 1);
        if (rows.back() != elementCount)
            return fail(id, rows, rowCount, "the rows end at ", rows.back(), " of ", elementCount);
        return Nothing{};
    }

    Status checkOutlines() const
    {
        const std::span<const u32> rings = t_.outlineRings;
        if (rings.empty()) return fail(SectionId::OutlineRings, rings, 0, "the last entry is missing");
        if (Status status = checkRows(SectionId::OutlineRows, t_.outlineRows, t_.nodes.size(), rings.size() - 1);
            !status)
            return status;
        if (rings.front() >> 1 != 0)
            return fail(SectionId::OutlineRings, rings, 0, "the first ring starts at ", rings.front() >> 1);
        for (u64 i = 1; i < rings.size(); ++i)
            if ((rings[i] >> 1) < (rings[i - 1] >> 1) + 3)
                return fail(SectionId::OutlineRings, rings, i, "ring ", i - 1, " has less than 3 corners");
        if (rings.back() != t_.outlinePoints.size() << 1)
            return fail(SectionId::OutlineRings, rings, rings.size() - 1, "the rings do not end with the ",
                        t_.outlinePoints.size(), " points");
        if (t_.outlineRests.size() != t_.outlinePoints.size())
            return fail(SectionId::OutlineRests, t_.outlineRests, 0, t_.outlineRests.size(), " rests of ",
                        t_.outlinePoints.size(), " points");
        for (u64 i = 0; i < t_.outlinePoints.size(); ++i) {
            if (!isFinite(t_.outlinePoints[i]))
                return fail(SectionId::OutlinePoints, t_.outlinePoints, i, "a corner is not finite");
            if (!isFinite(t_.outlineRests[i]))
                return fail(SectionId::OutlineRests, t_.outlineRests, i, "a corner is not finite");
        }
        for (u64 i = 0; i < t_.patches.size(); ++i)
            if (t_.outlineRows[i] == t_.outlineRows[i + 1] || (rings[t_.outlineRows[i]] & 1) != 0)
                return fail(SectionId::OutlineRows, t_.outlineRows, i, "patch ", i, " has no outline");
        return Nothing{};
    }

    /// Columns of a row rise and stay below `columnCount`; factors are fractions.
    Status checkMatrix(SectionId columnId, std::span<const u32> rows, std::span<const u32> columns, u64 columnCount,
                       SectionId factorId, std::span<const float> factors) const
    {
        if (factors.size() != columns.size())
            return fail(factorId, factors, 0, factors.size(), " factors for ", columns.size(), " columns");
        for (u64 i = 0; i + 1 < rows.size(); ++i)
            for (u64 k = rows[i]; k < rows[i + 1]; ++k) {
                if (columns[k] >= columnCount)
                    return fail(columnId, columns, k, "row ", i, " refers to column ", columns[k], " of ", columnCount);
                if (k > rows[i] && columns[k] <= columns[k - 1])
                    return fail(columnId, columns, k, "the columns of row ", i, " do not rise");
                if (!inUnit(factors[k])) return fail(factorId, factors, k, "factor ", factors[k], " in row ", i);
            }
        return Nothing{};
    }

    Status checkLinks() const
    {
        if (Status status = checkRows(SectionId::LinkRows, t_.linkRows, t_.nodes.size(), t_.linkColumns.size());
            !status)
            return status;
        if (Status status = checkMatrix(SectionId::LinkColumns, t_.linkRows, t_.linkColumns, t_.nodes.size(),
                                        SectionId::LinkFactors, t_.linkFactors);
            !status)
            return status;
        if (!t_.linkMoments.empty() && t_.linkMoments.size() != 2 * t_.linkColumns.size())
            return fail(SectionId::LinkMoments, t_.linkMoments, 0, t_.linkMoments.size(), " moments for ",
                        t_.linkColumns.size(), " links");
        for (u64 i = 0; i < t_.linkMoments.size(); ++i)
            if (!std::isfinite(t_.linkMoments[i]))
                return fail(SectionId::LinkMoments, t_.linkMoments, i, "a moment is not finite");
        const u64 slopes = t_.linkMoments.empty() ? 0 : t_.children.size();
        if (t_.childSlopes.size() != slopes)
            return fail(SectionId::ChildSlopes, t_.childSlopes, 0, t_.childSlopes.size(), " child slopes instead of ",
                        slopes, " (one a child where links have moments)");
        for (u64 i = 0; i < t_.childSlopes.size(); ++i)
            for (const float value : {t_.childSlopes[i].offsetX, t_.childSlopes[i].offsetY, t_.childSlopes[i].xx,
                                      t_.childSlopes[i].xy, t_.childSlopes[i].yx, t_.childSlopes[i].yy})
                if (!std::isfinite(value))
                    return fail(SectionId::ChildSlopes, t_.childSlopes, i, "a slope is not finite");
        return Nothing{};
    }

    Status checkSky() const
    {
        for (u64 i = 0; i < t_.skyPatches.size(); ++i) {
            const gpu::SkyPatchRecord& sky = t_.skyPatches[i];
            if (!isUnit(sky.direction) || !(sky.solidAngle > 0.0f && sky.solidAngle < 12.57f))
                return fail(SectionId::SkyPatches, t_.skyPatches, i, "sky patch ", i,
                            " has no direction or a solid angle outside 0..4 pi");
            const bool ground = sky.direction.z < 0.0f;
            if (ground && i + 1 < t_.skyPatches.size())
                return fail(SectionId::SkyPatches, t_.skyPatches, i, "sky patch ", i,
                            " lies below the horizon and is not the last");
            for (int c = 0; c < 4; ++c)
                if (ground ? !inUnit(sky.rho[c]) : sky.rho[c] != 0.0f)
                    return fail(SectionId::SkyPatches, t_.skyPatches, i, "sky patch ", i, ": reflectance ", sky.rho[c]);
        }
        if (!t_.skyOffsets.empty() && t_.skyOffsets.size() != t_.skyColumns.size())
            return fail(SectionId::SkyOffsets, t_.skyOffsets, 0, t_.skyOffsets.size(), " offsets for ",
                        t_.skyColumns.size(), " sky links");
        if (Status status = checkRows(SectionId::SkyRows, t_.skyRows, t_.patches.size(), t_.skyColumns.size()); !status)
            return status;
        return checkMatrix(SectionId::SkyColumns, t_.skyRows, t_.skyColumns, t_.skyPatches.size(),
                           SectionId::SkyFactors, t_.skyFactors);
    }

    Status checkPatchErrors() const
    {
        if (!t_.patchErrors.empty() && t_.patchErrors.size() != t_.patches.size())
            return fail(SectionId::PatchErrors, t_.patchErrors, 0, t_.patchErrors.size(), " errors for ",
                        t_.patches.size(), " patches");
        for (u64 i = 0; i < t_.patchErrors.size(); ++i)
            if (!(std::isfinite(t_.patchErrors[i]) && t_.patchErrors[i] >= 0.0f))
                return fail(SectionId::PatchErrors, t_.patchErrors, i, "error ", t_.patchErrors[i], " of patch ", i);
        return Nothing{};
    }

    Status checkMeshes() const
    {
        for (u64 i = 0; i < t_.vertices.size(); ++i)
            if (!isFinite(t_.vertices[i].position))
                return fail(SectionId::Vertices, t_.vertices, i, "vertex ", i, " is not finite");
        if (t_.instances.empty())
            return fail(SectionId::Instances, t_.instances, 0, "the static mesh's instance is missing");
        for (u64 i = 0; i < t_.instances.size(); ++i)
            for (const glm::vec4& row : t_.instances[i].worldFromLocal)
                for (int c = 0; c < 4; ++c)
                    if (!std::isfinite(row[c]))
                        return fail(SectionId::Instances, t_.instances, i, "the matrix of instance ", i,
                                    " is not finite");
        for (u64 i = 0; i < t_.draws.size(); ++i)
            if (Status status = checkDraw(i); !status) return status;
        return Nothing{};
    }

    Status checkDraw(u64 i) const
    {
        const gpu::DrawRecord& draw = t_.draws[i];
        const auto wrong = [&](const auto&... parts) {
            return fail(SectionId::Draws, t_.draws, i, "draw ", i, ": ", parts...);
        };
        if (draw.indexCount % 3 != 0 || u64(draw.firstIndex) + draw.indexCount > t_.indices.size())
            return wrong("indices ", draw.firstIndex, " + ", draw.indexCount, " of ", t_.indices.size());
        if (u64(draw.firstInstance) + draw.instanceCount > t_.instances.size())
            return wrong("instances ", draw.firstInstance, " + ", draw.instanceCount, " of ", t_.instances.size());
        u64 vertexPatch = 0, instancePatch = 0;
        for (u64 k = draw.firstIndex; k < u64(draw.firstIndex) + draw.indexCount; ++k) {
            const u64 vertex = u64(t_.indices[k]) + draw.vertexOffset;
            if (vertex >= t_.vertices.size())
                return fail(SectionId::Indices, t_.indices, k, "draw ", i, " refers to vertex ", vertex, " of ",
                            t_.vertices.size());
            vertexPatch = std::max<u64>(vertexPatch, t_.vertices[vertex].patchId);
        }
        for (u64 k = draw.firstInstance; k < u64(draw.firstInstance) + draw.instanceCount; ++k)
            instancePatch = std::max<u64>(instancePatch, t_.instances[k].patchId);
        if (draw.indexCount > 0 && draw.instanceCount > 0 && vertexPatch + instancePatch >= t_.patches.size())
            return wrong("patch ", vertexPatch + instancePatch, " of ", t_.patches.size());
        return Nothing{};
    }

    const TileView& t_;
    const PackIndex& index_;
    const SectionPlaces& places_;
    u64 nameCount_, surfaceCount_, buildingCount_;
};

} // namespace

Status validateTile(const TileView& tile, const PackIndex& index, const SectionPlaces& places)
{
    return TileChecker(tile, index, places).run();
}

} // namespace helio
