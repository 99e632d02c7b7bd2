// SPDX-License-Identifier: Apache-2.0
#include "tests/support/tile_builder.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace helio {

namespace {

u32 packNormal(glm::vec3 n)
{
    const auto part = [](float x) { return u32(i32(std::lround(x * 511.0f))) & 1023u; };
    return part(n.x) | part(n.y) << 10 | part(n.z) << 20;
}

u32 packAlbedo(glm::vec4 rho)
{
    const auto part = [](float x) { return u32(std::lround(x * 255.0f)); };
    return part(rho.r) | part(rho.g) << 8 | part(rho.b) << 16 | 255u << 24;
}

} // namespace

u32 TileBuilder::patch(glm::vec3 normal, float area, glm::vec4 rho, glm::vec4 emission)
{
    HELIO_CHECK(groups.empty(), "patches come before groups");
    patches.push_back({normal, area, rho, emission, 0, u32(patches.size()), gpu::kNone, 0});
    return u32(patches.size() - 1);
}

void TileBuilder::triangles(const std::array<glm::vec3, 4>& corners, glm::vec3 normal, glm::vec4 rho, u32 patchId)
{
    const u32 first = u32(vertices_.size());
    for (const glm::vec3 corner : corners) vertices_.push_back({corner, patchId, packNormal(normal), packAlbedo(rho)});
    for (const u32 k : {0u, 1u, 2u, 0u, 2u, 3u}) indices_.push_back(first + k);
}

u32 TileBuilder::quad(std::array<glm::vec3, 4> c, glm::vec4 rho, glm::vec4 emission)
{
    const glm::vec3 cross = glm::cross(c[2] - c[0], c[3] - c[1]);
    const u32 id = patch(glm::normalize(cross), 0.5f * glm::length(cross), rho, emission);
    triangles(c, patches[id].normal, rho, id);
    return id;
}

namespace {

/// Sides of a box, outwards: -x, +x, -y, +y, -z, +z.
std::array<std::array<glm::vec3, 4>, 6> sidesOf(glm::vec3 a, glm::vec3 b)
{
    return {{{{{a.x, b.y, a.z}, {a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}}},
             {{{b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z}}},
             {{{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}}},
             {{{b.x, b.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}}},
             {{{a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, a.y, a.z}, {a.x, a.y, a.z}}},
             {{{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}}}}};
}

} // namespace

u32 TileBuilder::box(glm::vec3 a, glm::vec3 b, glm::vec4 rho, glm::vec4 emission, bool inwards)
{
    const u32 first = u32(patches.size());
    for (const auto& c : sidesOf(a, b)) quad(inwards ? std::array{c[3], c[2], c[1], c[0]} : c, rho, emission);
    return first;
}

void TileBuilder::asset(u32 patchId, std::array<glm::vec3, 4> corners, std::array<glm::vec4, 3> rows)
{
    assetQuad(patchId, corners);
    assetSizes_.push_back(6);
    instances_.push_back({{rows[0], rows[1], rows[2]}, patchId, 0, 0, 0});
}

void TileBuilder::assetBox(u32 patchId, glm::vec3 lo, glm::vec3 hi, std::array<glm::vec4, 3> rows)
{
    for (const auto& side : sidesOf(lo, hi)) assetQuad(patchId, side);
    assetSizes_.push_back(36);
    instances_.push_back({{rows[0], rows[1], rows[2]}, patchId, 0, 0, 0});
}

void TileBuilder::assetQuad(u32 patchId, const std::array<glm::vec3, 4>& corners)
{
    const glm::vec3 normal = glm::normalize(glm::cross(corners[2] - corners[0], corners[3] - corners[1]));
    const u32 first = u32(assetVertices_.size());
    for (const glm::vec3 corner : corners)
        assetVertices_.push_back({corner, 0, packNormal(normal), packAlbedo(patches[patchId].rho)});
    for (const u32 k : {0u, 1u, 2u, 0u, 2u, 3u}) assetIndices_.push_back(first + k);
}

u32 TileBuilder::group(const std::vector<u32>& members, const std::vector<gpu::ChildSlopeRecord>& slopes)
{
    HELIO_CHECK(slopes.empty() || slopes.size() == members.size(), slopes.size(), " slopes, ", members.size());
    childSlopes_.insert(childSlopes_.end(), slopes.begin(), slopes.end());
    if (slopes.empty()) childSlopes_.resize(childSlopes_.size() + members.size(), gpu::ChildSlopeRecord{});
    const u32 id = u32(patches.size() + groups.size());
    gpu::NodeRecord node{gpu::kNone, u32(children_.size()), u32(members.size()), 0.0f};
    double area = 0.0;
    for (const u32 child : members) {
        HELIO_CHECK(child < id, "child ", child, " of group ", id);
        area += child < patches.size() ? double(patches[child].area) : double(groups[child - patches.size()].area);
        children_.push_back(child);
    }
    node.area = float(area);
    groups.push_back(node);
    return id;
}

void TileBuilder::link(u32 receiver, u32 sender, float factor, glm::vec2 moment)
{
    links_[receiver].push_back({sender, factor, moment});
}
void TileBuilder::sky(u32 patchId, float factor)
{
    sky_[patchId] = factor;
}

void TileBuilder::farGround(u32 patchId, float factor, glm::vec4 rho)
{
    below_[patchId] = factor;
    farGroundRho_ = rho;
}

TileView TileBuilder::view()
{
    nodes_.clear();
    for (const gpu::PatchRecord& p : patches) nodes_.push_back({gpu::kNone, 0, 0, p.area});
    for (const gpu::NodeRecord& g : groups) {
        for (u32 k = 0; k < g.childCount; ++k) nodes_[children_[g.childBegin + k]].parent = u32(nodes_.size());
        nodes_.push_back(g);
    }

    linkRows_ = skyRows_ = {0};
    linkColumns_.clear(), linkFactors_.clear(), linkMoments_.clear(), skyColumns_.clear(), skyFactors_.clear();
    for (u32 i = 0; i < nodes_.size(); ++i) {
        const auto found = links_.find(i);
        if (found != links_.end())
            for (const Link& link : found->second) {
                linkColumns_.push_back(link.column);
                linkFactors_.push_back(link.factor);
                linkMoments_.insert(linkMoments_.end(), {link.moment.x, link.moment.y});
            }
        linkRows_.push_back(u32(linkColumns_.size()));
    }
    for (u32 i = 0; i < patches.size(); ++i) {
        if (sky_.contains(i)) {
            skyColumns_.push_back(0);
            skyFactors_.push_back(sky_[i]);
        }
        if (below_.contains(i)) {
            skyColumns_.push_back(1);
            skyFactors_.push_back(below_[i]);
        }
        skyRows_.push_back(u32(skyColumns_.size()));
    }
    skyPatches_ = {{{0, 0, 1}, 6.2831853f, {}}};
    if (!below_.empty()) skyPatches_.push_back({{0, 0, -1}, 6.2831853f, farGroundRho_});

    allVertices_ = vertices_;
    allVertices_.insert(allVertices_.end(), assetVertices_.begin(), assetVertices_.end());
    allIndices_ = indices_;
    allIndices_.insert(allIndices_.end(), assetIndices_.begin(), assetIndices_.end());
    allInstances_ = {{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}, 0, 0, 0, 0}};
    allInstances_.insert(allInstances_.end(), instances_.begin(), instances_.end());
    draws_.clear();
    if (!indices_.empty()) draws_.push_back({u32(indices_.size()), 1, 0, 0, 0});
    u32 firstIndex = u32(indices_.size());
    for (u32 k = 1; k < allInstances_.size(); firstIndex += assetSizes_[k - 1], ++k)
        draws_.push_back({assetSizes_[k - 1], 1, firstIndex, u32(vertices_.size()), k});

    TileView tile;
    tile.patches = patches;
    tile.nodes = nodes_;
    tile.children = children_;
    tile.linkRows = linkRows_;
    tile.linkColumns = linkColumns_;
    tile.linkFactors = linkFactors_;
    if (linear) {
        tile.linkMoments = linkMoments_;
        tile.childSlopes = childSlopes_;
    }
    tile.skyPatches = skyPatches_;
    tile.skyRows = skyRows_;
    tile.skyColumns = skyColumns_;
    tile.skyFactors = skyFactors_;
    tile.vertices = allVertices_;
    tile.indices = allIndices_;
    tile.instances = allInstances_;
    tile.draws = draws_;
    return tile;
}

} // namespace helio
