// SPDX-License-Identifier: Apache-2.0
// Uses every shared record that no shader of the program names, and all of the pack, so that the layout test finds their
// offsets in built SPIR-V.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/records.h"
#include "shaders/shared/solve.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 1) readonly buffer Nodes { NodeRecord nodes[]; };
layout(scalar, binding = 2) readonly buffer NodeInfos { NodeInfoRecord nodeInfos[]; };
layout(scalar, binding = 3) readonly buffer Vertices { VertexRecord vertices[]; };
layout(scalar, binding = 4) readonly buffer Instances { InstanceRecord instances[]; };
layout(scalar, binding = 5) readonly buffer Draws { DrawRecord draws[]; };
layout(scalar, binding = 6) readonly buffer SkyPatches { SkyPatchRecord skyPatches[]; };
layout(scalar, binding = 7) writeonly buffer Sums { float sums[]; };
layout(scalar, binding = 8) readonly buffer Singles { LinkSingleRecord singles[]; };
layout(scalar, binding = 9) readonly buffer Quads { LinkQuadRecord quads[]; };
layout(scalar, binding = 10) readonly buffer Moments { MomentQuadRecord moments[]; };
layout(scalar, binding = 11) readonly buffer Strips { StripRecord strips[]; };
layout(scalar, binding = 12) readonly buffer Rows { RowRecord rows[]; };
layout(scalar, binding = 13) readonly buffer Children { ChildRecord children[]; };
layout(scalar, binding = 14) readonly buffer Patches { PatchRecord patches[]; };
layout(scalar, binding = 15) readonly buffer Slopes { ChildSlopeRecord slopes[]; };
layout(scalar, binding = 16) readonly buffer Residuals { ResidualRecord residuals[]; };
layout(scalar, binding = 17) readonly buffer Weights { CornerWeightRecord weights[]; };
layout(push_constant, scalar) uniform Params { uint count; };

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    sums[i] = patches[i].area + nodes[i].area + nodeInfos[i].coverage + vertices[i].position.z +
              instances[i].worldFromLocal[2].w + float(draws[i].firstInstance) + skyPatches[i].solidAngle +
              singles[i].momentY + float(quads[i].link3 + moments[i].moments23 + strips[i].singleRecords + rows[i].parent) +
              children[i].offsetY + slopes[i].yy + residuals[i].largest.w + weights[i].weight;
}
