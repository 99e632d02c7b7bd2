// SPDX-License-Identifier: Apache-2.0
// Records of the pack, as the baker writes them and the shaders read them.
#ifndef HELIO_RECORDS_H
#define HELIO_RECORDS_H
#include "interop.h"

HELIO_SHARED_BEGIN

HELIO_CONSTANT uint kNone = 0xFFFFFFFFu; // "no such element"; background of the sun raster

// A leaf of the light hierarchy. Channels: linear r, g, b, broadband solar.
struct PatchRecord {
    vec3 normal;     // unit, lit side
    float area;      // m2
    vec4 rho;        // reflectance, 0..1
    vec4 emission;   // exitance, W/m2
    uint building;   // kNone = ground
    uint sourceFace; // face of the OBJ it was made from, or kNone
    uint surface;    // index of the material name, or kNone
    uint flags;      // none defined
};
HELIO_SIZE(PatchRecord, 64);

// A node: patch leaves first (node i = patch i), then inner nodes by rising height.
struct NodeRecord {
    uint parent;     // kNone for a root
    uint childBegin; // into the children section
    uint childCount;
    float area;      // m2
};
HELIO_SIZE(NodeRecord, 16);

// What tools and later stages need of a node beyond the solve.
struct NodeInfoRecord {
    vec3 centroid;   // m, tile frame
    uint height;     // 0 = leaf
    vec3 normal;     // zero for a cluster
    uint kind;       // 0 tiling, 1 planar-partial, 2 cluster
    float coverage;  // area / outline area
    uint building;
    uint name;       // rule or terminal name
    uint pad0;
};
HELIO_SIZE(NodeInfoRecord, 48);

// What a child of a planar node adds to the node's slopes, in slope coordinates (city/light/linear_senders.h). Children of
// clusters have zeros.
struct ChildSlopeRecord {
    float offsetX;   // the child's centroid in the parent's coordinates
    float offsetY;
    float xx;        // parent's coordinates of the child's unit vectors: X_parent = offset + (xx xy; yx yy) X_child
    float xy;
    float yx;
    float yy;
};
HELIO_SIZE(ChildSlopeRecord, 24);

// A corner of what is drawn. Patch id on screen = vertex.patchId + instance.patchId.
struct VertexRecord {
    vec3 position;   // m, tile frame; asset units for asset meshes
    uint patchId;    // 0 for asset meshes
    uint normal;     // unit vector, three signed 10-bit components (A2B10G10R10_SNORM)
    uint albedo;     // linear r, g, b, and 255 or, for a pane of glass, 0: 8 bits each (R8G8B8A8_UNORM)
};
HELIO_SIZE(VertexRecord, 24);

struct InstanceRecord {
    vec4 worldFromLocal[3]; // rows of a 3x4 matrix
    uint patchId;           // 0 for the static mesh
    uint pad0;
    uint pad1;
    uint pad2;
};
HELIO_SIZE(InstanceRecord, 64);

// Same members and order as VkDrawIndexedIndirectCommand.
struct DrawRecord {
    uint indexCount;
    uint instanceCount;
    uint firstIndex;
    uint vertexOffset;
    uint firstInstance;
};
HELIO_SIZE(DrawRecord, 20);

// A sender of light from outside the scene: a part of the sky (the uniform sky is one, the upper hemisphere), or the
// ground beyond the scene: the lower hemisphere, after all others.
struct SkyPatchRecord {
    vec3 direction;  // unit, its centre; (0, 0, -1) for the ground beyond
    float solidAngle; // sr
    vec4 rho;         // reflectance of the ground beyond; 0 for the sky
};
HELIO_SIZE(SkyPatchRecord, 32);

HELIO_SHARED_END
#endif
