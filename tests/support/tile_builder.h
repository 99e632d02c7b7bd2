// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <vector>

#include "city/format/pack.h"

namespace helio {

/// Makes a tile by hand: quads first, then groups from the leaves up, links and sky in any order, then view().
class TileBuilder
{
public:
    /// A planar quad, corners counter-clockwise from its lit side; one patch. Returns its id.
    u32 quad(std::array<glm::vec3, 4> corners, glm::vec4 rho, glm::vec4 emission = glm::vec4(0.0f));
    /// A patch that is not drawn.
    u32 patch(glm::vec3 normal, float area, glm::vec4 rho, glm::vec4 emission = glm::vec4(0.0f));
    /// The six outer sides of a box (or, inwards, the six inner ones); returns the first of six ids: -x, +x, -y, +y,
    /// -z, +z.
    u32 box(glm::vec3 lo, glm::vec3 hi, glm::vec4 rho, glm::vec4 emission = glm::vec4(0.0f), bool inwards = false);
    /// Draws one more quad of local corners with an instance's transform, as an asset of a patch.
    void asset(u32 patchId, std::array<glm::vec3, 4> corners, std::array<glm::vec4, 3> worldFromLocal);
    /// Draws the six sides of a box, outwards, as one asset.
    void assetBox(u32 patchId, glm::vec3 lo, glm::vec3 hi, std::array<glm::vec4, 3> worldFromLocal);
    /// An inner node; all patches must exist. Children are ids of patches and earlier groups. slopes: what each child
    /// adds to the node's slopes; none = nothing.
    u32 group(const std::vector<u32>& children, const std::vector<gpu::ChildSlopeRecord>& slopes = {});
    void link(u32 receiver, u32 sender, float factor, glm::vec2 moment = glm::vec2(0.0f));
    void sky(u32 patchId, float factor);
    /// Ground beyond the scene, of which a patch sees this fraction; one reflectance for all.
    void farGround(u32 patchId, float factor, glm::vec4 rho);

    /// The tile; stays valid until the builder changes or dies.
    TileView view();

    std::vector<gpu::PatchRecord> patches;
    std::vector<gpu::NodeRecord> groups;
    bool linear = false; ///< the view has the links' moments and the children's slopes

private:
    void assetQuad(u32 patchId, const std::array<glm::vec3, 4>& corners);
    void triangles(const std::array<glm::vec3, 4>& corners, glm::vec3 normal, glm::vec4 rho, u32 patchId);

    std::vector<u32> children_;
    std::vector<gpu::VertexRecord> vertices_, assetVertices_;
    std::vector<u32> indices_, assetIndices_;
    std::vector<gpu::InstanceRecord> instances_, allInstances_;
    std::vector<u32> assetSizes_; // indices, an instance
    struct Link
    {
        u32 column;
        float factor;
        glm::vec2 moment;
    };
    std::vector<gpu::ChildSlopeRecord> childSlopes_;
    std::map<u32, std::vector<Link>> links_;
    std::map<u32, float> sky_, below_;
    glm::vec4 farGroundRho_{0.0f};

    std::vector<gpu::NodeRecord> nodes_;
    std::vector<u32> linkRows_, linkColumns_, skyRows_, skyColumns_, allIndices_;
    std::vector<float> linkFactors_, linkMoments_, skyFactors_;
    std::vector<gpu::SkyPatchRecord> skyPatches_;
    std::vector<gpu::VertexRecord> allVertices_;
    std::vector<gpu::DrawRecord> draws_;
};

} // namespace helio
