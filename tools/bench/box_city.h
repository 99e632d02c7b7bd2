// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "city/format/pack.h"

namespace helio {

/// A made-up city for the raster stages: closed boxes on a plain, their walls tiled by 4 x 3.2 m patches, each with a
/// closed window box before it (14 triangles). Patches have no links and no sky.
class BoxCity
{
public:
    /// At least `triangles` triangles.
    explicit BoxCity(u32 triangles);
    TileView view() const;

private:
    void quad(const glm::vec3 (&corners)[4], u32 patch);
    void wall(glm::vec3 foot, glm::vec3 along, glm::vec3 outwards, u32 columns, u32 storeys);
    u32 patch(glm::vec3 normal, float area);
    void building(glm::vec3 foot, float turn, u32 width, u32 depth, u32 storeys);

    std::vector<gpu::PatchRecord> patches_;
    std::vector<gpu::NodeRecord> nodes_;
    std::vector<u32> none_{0}, rows_, skyRows_;
    std::vector<gpu::VertexRecord> vertices_;
    std::vector<u32> indices_;
    std::vector<gpu::InstanceRecord> instances_;
    std::vector<gpu::DrawRecord> draws_;
    std::vector<gpu::SkyPatchRecord> sky_;
};

} // namespace helio
