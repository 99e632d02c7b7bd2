// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/format/pack.h"

namespace helio {

/// Everything that a pack holds, owned. Members as in TileView, in the same order.
struct PackContent
{
    PackIndex index;
    std::vector<gpu::PatchRecord> patches;
    std::vector<gpu::NodeRecord> nodes;
    std::vector<gpu::NodeInfoRecord> nodeInfos;
    std::vector<u32> children;
    std::vector<u32> outlineRows, outlineRings;
    std::vector<glm::vec3> outlinePoints, outlineRests;
    std::vector<u32> linkRows, linkColumns;
    std::vector<float> linkFactors, linkMoments;
    std::vector<gpu::SkyPatchRecord> skyPatches;
    std::vector<u32> skyRows, skyColumns;
    std::vector<float> skyFactors;
    std::vector<gpu::VertexRecord> vertices;
    std::vector<u32> indices;
    std::vector<gpu::InstanceRecord> instances;
    std::vector<gpu::DrawRecord> draws;
    std::string nodeNames, surfaceNames, buildingIds; ///< '\n'-terminated names
    std::vector<gpu::ChildSlopeRecord> childSlopes;
    std::vector<u32> skyOffsets;
    std::vector<float> patchErrors;

    /// Spans of the vectors, valid until one of them changes.
    TileView view() const
    {
        return {.patches = patches,
                .nodes = nodes,
                .nodeInfos = nodeInfos,
                .children = children,
                .outlineRows = outlineRows,
                .outlineRings = outlineRings,
                .outlinePoints = outlinePoints,
                .outlineRests = outlineRests,
                .linkRows = linkRows,
                .linkColumns = linkColumns,
                .linkFactors = linkFactors,
                .linkMoments = linkMoments,
                .skyPatches = skyPatches,
                .skyRows = skyRows,
                .skyColumns = skyColumns,
                .skyFactors = skyFactors,
                .vertices = vertices,
                .indices = indices,
                .instances = instances,
                .draws = draws,
                .nodeNames = nodeNames,
                .surfaceNames = surfaceNames,
                .buildingIds = buildingIds,
                .childSlopes = childSlopes,
                .skyOffsets = skyOffsets,
                .patchErrors = patchErrors};
    }
};

} // namespace helio
