// SPDX-License-Identifier: Apache-2.0
#include "city/pack/content_builder.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "city/model/triangulate.h"
#include "city/pack/reveal.h"
#include "city/pack/trim_mesh.h"
#include "city/pack/vertex_pack.h"

namespace helio {
namespace {

std::string joinNames(const std::vector<std::string>& names)
{
    std::string text;
    for (std::string name : names) {
        std::replace(name.begin(), name.end(), '\n', ' ');
        text += name;
        text += '\n';
    }
    return text;
}

/// What rounding to float takes from a coordinate. volatile: g++ 12 at -O2 drops the rounding of two such differences
/// side by side (double to float and back, vectorised) and gives 0.
float roundingRest(double x)
{
    const volatile float rounded = float(x);
    return float(x - double(rounded));
}

class ContentBuilder
{
public:
    ContentBuilder(const NodeTreeBuild& build, std::span<const AssetMesh> assets)
        : build_(build), tree_(build.tree), assets_(assets)
    {
    }

    /// Counted before any table is filled, so that no number wraps and no memory is spent in vain.
    Status checkSize(const ContentLimits& limits) const
    {
        size_t corners = 0, vertices = 0, indices = 0;
        const auto cornersOf = [&](u32 ringBegin, u32 ringCount) {
            size_t sum = 0;
            for (u32 r = ringBegin; r < ringBegin + ringCount; ++r) sum += tree_.rings[r].size();
            return sum;
        };
        for (const Node& node : tree_.nodes) corners += cornersOf(node.ringBegin, node.ringCount);
        for (const DrawnPiece& piece : build_.pieces) {
            if (piece.asset != kNoIndex) continue;
            const size_t own = cornersOf(piece.ringBegin, piece.ringCount);
            vertices += own;
            // n + 2h - 2 triangles fill a polygon of n corners in all and h holes.
            indices += 3 * (own + 2 * piece.ringCount);
        }
        u32 instanced = kNoIndex;
        for (const AssetInstance& instance : build_.instances) {
            if (revealDepth(instance) > 0.0) {
                const DrawnPiece& piece = build_.pieces[instance.piece];
                const size_t edges = cornersOf(piece.ringBegin, piece.ringCount);
                vertices += 5 * edges;
                indices += 9 * edges;
            }
            const AssetMesh& mesh = assets_[instance.asset];
            if (instance.trimCount > 0) {
                // A plane turns a triangle into a polygon of one corner more.
                vertices += (3 + instance.trimCount) * (mesh.indices.size() / 3);
                indices += 3 * (1 + instance.trimCount) * (mesh.indices.size() / 3);
            } else if (instance.asset != instanced) {
                instanced = instance.asset;
                vertices += mesh.positions.size();
                indices += mesh.indices.size();
            }
        }
        const auto tooMany = [](const char* what, size_t count, size_t most) {
            return Error{concat("the city has too many ", what, " for one tile: ", count, " of at most ", most,
                                "; bake a smaller part, or with a coarser LOD")};
        };
        if (corners > limits.corners) return tooMany("corners", corners, limits.corners);
        if (vertices > limits.vertices) return tooMany("vertices", vertices, limits.vertices);
        if (indices > limits.indices) return tooMany("indices", indices, limits.indices);
        return Nothing{};
    }

    PackContent build(LightBake light)
    {
        addPatches();
        addNodes();
        addOutlines();
        c_.linkRows = std::move(light.links.rowBegin);
        c_.linkColumns = std::move(light.links.column);
        c_.linkFactors = std::move(light.links.factor);
        for (const glm::vec2& moment : light.links.moment)
            c_.linkMoments.insert(c_.linkMoments.end(), {moment.x, moment.y});
        c_.childSlopes = std::move(light.links.childSlopes);
        c_.skyPatches = std::move(light.sky.skyPatches);
        c_.skyRows = std::move(light.sky.rowBegin);
        c_.skyColumns = std::move(light.sky.column);
        c_.skyFactors = std::move(light.sky.factor);
        c_.skyOffsets = std::move(light.sky.offset);
        c_.patchErrors = std::move(light.stats.predicted.ofPatch);
        addStaticMesh();
        addAssets();
        c_.nodeNames = joinNames(tree_.names);
        c_.surfaceNames = joinNames(tree_.surfaceNames);
        c_.buildingIds = joinNames(tree_.buildingIds);
        return std::move(c_);
    }

private:
    void addPatches()
    {
        c_.patches.reserve(tree_.patchCount());
        for (u32 i = 0; i < tree_.patchCount(); ++i) {
            const Patch& p = tree_.patches[i];
            c_.patches.push_back({.normal = tree_.nodes[i].normal,
                                  .area = float(p.area),
                                  .rho = p.rho,
                                  .emission = p.emission,
                                  .building = p.building,
                                  .sourceFace = p.sourceFace,
                                  .surface = p.surface,
                                  .flags = 0});
        }
    }

    void addNodes()
    {
        c_.nodes.reserve(tree_.nodeCount());
        c_.nodeInfos.reserve(tree_.nodeCount());
        for (const Node& n : tree_.nodes) {
            c_.nodes.push_back({n.parent, n.childCount > 0 ? n.childBegin : 0, n.childCount, float(n.area)});
            c_.nodeInfos.push_back({.centroid = n.centroid,
                                    .height = n.height,
                                    .normal = n.normal,
                                    .kind = u32(n.kind),
                                    .coverage = float(n.coverage),
                                    .building = n.building,
                                    .name = n.name,
                                    .pad0 = 0});
        }
        c_.children = tree_.children;
    }

    void addOutlines()
    {
        c_.outlineRows.push_back(0);
        for (u32 i = 0; i < tree_.nodeCount(); ++i) {
            const u32 first = tree_.nodes[i].ringBegin;
            for (u32 r = first; r < first + tree_.nodes[i].ringCount; ++r) {
                c_.outlineRings.push_back(u32(c_.outlinePoints.size()) << 1 | u32(tree_.ringIsHole[r] != 0));
                for (const glm::dvec3& q : tree_.rings[r]) {
                    const glm::vec3 rounded(q);
                    c_.outlinePoints.push_back(rounded);
                    c_.outlineRests.push_back({roundingRest(q.x), roundingRest(q.y), roundingRest(q.z)});
                }
            }
            c_.outlineRows.push_back(u32(c_.outlineRings.size()));
        }
        c_.outlineRings.push_back(u32(c_.outlinePoints.size()) << 1);
    }

    void include(const glm::vec3& point)
    {
        c_.index.boundsMin = glm::min(c_.index.boundsMin, point);
        c_.index.boundsMax = glm::max(c_.index.boundsMax, point);
    }

    void addPolygon(const DrawnPiece& piece, const Polygon3& polygon, const glm::dvec3& facing)
    {
        const u32 base = u32(c_.vertices.size()), patch = piece.patch;
        const u32 normal = packNormal(facing), albedo = packAlbedo(glm::dvec3(piece.rho));
        const auto addRing = [&](const Ring3& ring) {
            for (const glm::dvec3& q : ring) {
                c_.vertices.push_back({q, patch, normal, albedo});
                include(c_.vertices.back().position);
            }
        };
        addRing(polygon.outer);
        for (const Ring3& hole : polygon.holes) addRing(hole);
        for (const std::array<u32, 3>& triangle : triangulate(polygon))
            for (const u32 corner : triangle) c_.indices.push_back(base + corner);
    }

    void addStaticMesh()
    {
        c_.index.boundsMin = glm::vec3(std::numeric_limits<float>::max());
        c_.index.boundsMax = -c_.index.boundsMin;
        for (const DrawnPiece& piece : build_.pieces) {
            if (piece.asset != kNoIndex) continue;
            const u32 end = piece.ringBegin + piece.ringCount;
            for (u32 r = piece.ringBegin; r < end;) { // An outer ring is followed by its holes.
                Polygon3 polygon{tree_.rings[r++], {}};
                while (r < end && tree_.ringIsHole[r] != 0) polygon.holes.push_back(tree_.rings[r++]);
                addPolygon(piece, polygon, tree_.nodes[piece.patch].normal);
            }
        }
        addReveals();
        addTrimmedAssets();
        c_.instances.push_back({{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}, 0, 0, 0, 0});
        if (!c_.indices.empty()) c_.draws.push_back({u32(c_.indices.size()), 1, 0, 0, 0});
    }

    /// How far an asset that fills its tile reaches behind it, m; 0 for overlays and for assets without depth.
    double revealDepth(const AssetInstance& instance) const
    {
        constexpr double kShallow = 1e-3, kBehind = 0.002; // m: the recess ends behind the asset's own back
        if (instance.piece == kNoIndex) return 0.0;
        const glm::dvec3 &onPlane = tree_.rings[build_.pieces[instance.piece].ringBegin][0],
                         &normal = tree_.nodes[instance.patch].normal;
        double depth = 0.0;
        for (const glm::dvec3& corner : boxCorners(instance))
            depth = std::max(depth, glm::dot(onPlane - corner, normal));
        return depth > kShallow ? depth + kBehind : 0.0;
    }

    /// Closes the wall behind assets that fill their tile: nobody looks, and no sun shines, past their frames.
    void addReveals()
    {
        for (const AssetInstance& instance : build_.instances) {
            const double depth = revealDepth(instance);
            if (depth == 0.0) continue;
            const DrawnPiece& piece = build_.pieces[instance.piece];
            for (const Polygon3& face : revealOf(tree_.rings[piece.ringBegin], tree_.nodes[piece.patch].normal, depth))
                addPolygon(piece, face, unitNormal(face));
        }
    }

    /// Cut assets have a shape of their own each, so they are part of the static mesh.
    void addTrimmedAssets()
    {
        for (const AssetInstance& instance : build_.instances) {
            if (instance.trimCount == 0) continue;
            const TrimmedMesh mesh =
                trimMesh(assets_[instance.asset], instance.worldFromAsset,
                         std::span(build_.trimPlanes).subspan(instance.trimBegin, instance.trimCount));
            const u32 base = u32(c_.vertices.size());
            for (const TrimmedVertex& v : mesh.vertices) {
                c_.vertices.push_back(
                    {v.position, instance.patch, packNormal(v.normal), packAlbedo(v.albedo, v.glass)});
                include(c_.vertices.back().position);
            }
            for (const u32 index : mesh.indices) c_.indices.push_back(base + index);
        }
    }

    std::array<glm::dvec3, 8> boxCorners(const AssetInstance& instance) const
    {
        const AssetMesh& mesh = assets_[instance.asset];
        std::array<glm::dvec3, 8> corners;
        for (u32 k = 0; k < 8; ++k) {
            const glm::dvec3 local((k & 1) != 0 ? mesh.boxMax.x : mesh.boxMin.x,
                                   (k & 2) != 0 ? mesh.boxMax.y : mesh.boxMin.y,
                                   (k & 4) != 0 ? mesh.boxMax.z : mesh.boxMin.z);
            corners[k] = instance.worldFromAsset * glm::dvec4(local, 1.0);
        }
        return corners;
    }

    void addAssets()
    {
        for (size_t i = 0; i < build_.instances.size();) {
            const u32 asset = build_.instances[i].asset;
            const u32 firstInstance = u32(c_.instances.size());
            for (; i < build_.instances.size() && build_.instances[i].asset == asset; ++i)
                if (build_.instances[i].trimCount == 0) addInstance(build_.instances[i]);
            if (c_.instances.size() == firstInstance) continue;
            addMesh(assets_[asset], firstInstance, u32(c_.instances.size()) - firstInstance);
        }
    }

    void addInstance(const AssetInstance& instance)
    {
        const glm::dmat4x3& m = instance.worldFromAsset;
        gpu::InstanceRecord record{};
        for (int row = 0; row < 3; ++row)
            record.worldFromLocal[row] = glm::dvec4(m[0][row], m[1][row], m[2][row], m[3][row]);
        record.patchId = instance.patch;
        c_.instances.push_back(record);
        for (const glm::dvec3& corner : boxCorners(instance)) include(corner);
    }

    void addMesh(const AssetMesh& mesh, u32 firstInstance, u32 instanceCount)
    {
        c_.draws.push_back(
            {u32(mesh.indices.size()), instanceCount, u32(c_.indices.size()), u32(c_.vertices.size()), firstInstance});
        for (size_t v = 0; v < mesh.positions.size(); ++v)
            c_.vertices.push_back(
                {mesh.positions[v], 0, packNormal(mesh.normals[v]), packAlbedo(mesh.albedos[v], mesh.isGlass[v])});
        c_.indices.insert(c_.indices.end(), mesh.indices.begin(), mesh.indices.end());
    }

    const NodeTreeBuild& build_;
    const NodeTree& tree_;
    std::span<const AssetMesh> assets_;
    PackContent c_;
};

} // namespace

Result<PackContent> buildContent(const NodeTreeBuild& build, std::span<const AssetMesh> assets, LightBake light,
                                 const ContentLimits& limits)
{
    ContentBuilder builder(build, assets);
    if (Status fits = builder.checkSize(limits); !fits) return fits.error();
    return builder.build(std::move(light));
}

} // namespace helio
